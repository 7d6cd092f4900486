# Sets up an archive of the library after its sources are known. One set of objects serves the archive and the shared
# library, whose exports IST_API and src/package/ist.map.in select.
function(ist_set_up_library name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  if(NOT EMSCRIPTEN)
    set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                          VISIBILITY_INLINES_HIDDEN ON)
    target_compile_options(${name} PRIVATE -fno-semantic-interposition)
  endif()
  target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:ist_flags> ist_libraries)
  # A third of the compile time. The preset bench does without, and shows that each file includes its dependencies.
  target_precompile_headers(${name} PRIVATE <Eigen/Geometry> <fmt/format.h> <algorithm> <array> <cmath>
                            <optional> <span> <string> <vector>)
  # The tests' builds compile the files of a folder at once: Eigen is most of the compile time of each file. Users'
  # programs and benchmarks are compiled file by file.
  if(IST_UNITY)
    get_target_property(sources ${name} SOURCES)
    foreach(file IN LISTS sources)
      get_filename_component(folder ${file} DIRECTORY)
      string(MAKE_C_IDENTIFIER "${name}_${folder}" group)
      set_source_files_properties(${file} PROPERTIES UNITY_GROUP ${group})
    endforeach()
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
endfunction()
