# c_mirrors.py writes the files that mirror the C headers whenever CMake runs. CMake runs again after a header changes.
find_program(IST_PYTHON3 python3)
mark_as_advanced(IST_PYTHON3)

#   ist_mirror(KIND FILE)   KIND is python, layout or calls
function(ist_mirror kind file)
  if(NOT IST_PYTHON3)
    message(FATAL_ERROR "python3 is missing, and ${file} is made by it: install python3")
  endif()
  set(capi ${CMAKE_CURRENT_FUNCTION_LIST_DIR})
  execute_process(COMMAND ${IST_PYTHON3} -B ${capi}/c_mirrors.py ${kind} ${file} COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB headers ${capi}/include/ist/capi/ist_*.h)
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${capi}/c_mirrors.py ${headers})
endfunction()

# Python imports the package from the sources, so the file lies there. An sdist has no such folder.
if(PROJECT_IS_TOP_LEVEL AND IST_PYTHON3 AND EXISTS ${PROJECT_SOURCE_DIR}/src/python/ist)
  ist_mirror(python ${PROJECT_SOURCE_DIR}/src/python/ist/_c.py)
endif()
