# cmake -D OUTPUT=FILE -P commit.cmake
# Writes the commit of the sources as a macro, with + where files are changed, and its date; only if
# they are others than before, so that nothing is compiled again without a reason.
include(${CMAKE_CURRENT_LIST_DIR}/../package/commit.cmake)
ist_commit(commit seconds)
ist_format_time(${seconds} %Y-%m-%d date)
file(CONFIGURE OUTPUT "${OUTPUT}"
     CONTENT "#pragma once\n\n#define IST_COMMIT \"${commit}\"\n#define IST_DATE \"${date}\"\n")
