# Builds for WebAssembly by Debian's Emscripten, and runs the tests by node.
set(emscripten /usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
find_program(found_node node NO_CACHE)
if(NOT EXISTS ${emscripten} OR NOT found_node)
  message(FATAL_ERROR "Emscripten or node is missing: run scripts/setup.sh --cross")
endif()
# Its libraries are compiled and their folder is locked: nothing is fetched.
include(${emscripten})
# The linker looks for JavaScript where Debian keeps it, with a node from elsewhere too.
set(CMAKE_CXX_LINKER_LAUNCHER env NODE_PATH=/usr/share/nodejs)
