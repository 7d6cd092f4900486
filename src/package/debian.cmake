# `cpack` makes five packages, each of one component.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ist)
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_DEBIAN_PACKAGE_HOMEPAGE "${IST_HOMEPAGE}")
set(CPACK_COMPONENTS_ALL runtime development python)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS  # whatever the umask
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
# Dependencies are derived from the libraries that the files need.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_CURRENT_BINARY_DIR})  # of libist, for the others
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
# A program is bound to one minor version (ist.map.in).
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")

# Of what is built, which may not be of the machine that builds.
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE amd64)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()

# Compressed pages, changelogs and overrides for lintian.
configure_file(debian_files.cmake.in debian_files.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_BINARY_DIR}/debian_files.cmake)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each description begins with its own
function(ist_describe component kind text)
  set(CPACK_COMPONENT_${component}_DESCRIPTION "contacts, depths and distances of triangle meshes - ${kind}
The Implicit Sphere Tree answers where two rigid triangle meshes touch, how
deep they are in each other and how far apart, thousands of times a second:
as certified intervals, and with the same bits on every processor. It was
made for haptic planning of jaw surgery. Research software, not a medical
device.

${text}" PARENT_SCOPE)
endfunction()

set(runtime libist${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${runtime})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
# CPack 3.25 would write scripts that call ldconfig, for which Debian has a trigger. It writes none that are
# listed here, and passes over a listed file that is not there, with a warning.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_SOURCE_DIR}/triggers none-as-ldconfig-has-a-trigger/postinst
    none-as-ldconfig-has-a-trigger/postrm)
ist_describe(RUNTIME "library" "This package has the shared libraries.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libist-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${runtime} (= ${PROJECT_VERSION}), libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS ist)  # has the documents
ist_describe(DEVELOPMENT "development files" "This package has the headers, for CMake and pkg-config.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-ist)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)  # ctypes names the library
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${runtime} (= ${PROJECT_VERSION}), python3 (>= 3.9), python3-numpy (>= 1:1.21)")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS ist)  # has the documents
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/src/python/debian/postinst
    ${PROJECT_SOURCE_DIR}/src/python/debian/prerm)
ist_describe(PYTHON "Python 3 package" "This package has the modules for Python, which take and give numpy arrays.")

if(TARGET ist_cli)
  list(APPEND CPACK_COMPONENTS_ALL command)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME ist)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS libist-dev)  # has the headers that the documents show
  ist_describe(COMMAND "command" "This package has the command ist, documents, example programs and scenes.")
endif()
if(TARGET ist-import)
  list(APPEND CPACK_COMPONENTS_ALL import)
  set(CPACK_DEBIAN_IMPORT_PACKAGE_NAME ist-import)
  set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "ist-import (= ${PROJECT_VERSION})")
  ist_describe(IMPORT "importer" "This package has the program that libist starts to read glTF, 3MF and what
assimp knows.")
endif()
include(CPack)
