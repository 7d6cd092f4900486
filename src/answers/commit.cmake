# cmake -D OUTPUT=FILE -P commit.cmake
# Writes the commit of the sources as a macro, with + if files are changed. Leaves the file as it is
# if it holds the same commit, so that nothing is compiled again without a reason.
include(${CMAKE_CURRENT_LIST_DIR}/../package/commit.cmake)
ist_commit(commit seconds)
file(CONFIGURE OUTPUT "${OUTPUT}"
     CONTENT "#pragma once\n\n#define IST_COMMIT \"${commit}\"\n")
