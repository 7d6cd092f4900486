# cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P commit.cmake
# Writes the commit of the sources as a macro, with + where files are changed, and its date; only if
# they are others than before, so that nothing is compiled again without a reason.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty=+ --abbrev=8 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
  file(TIMESTAMP "${SOURCE}/CHANGELOG.md" date "%Y-%m-%d" UTC)  # an archive of a commit has its time
else()
  execute_process(COMMAND git -C "${SOURCE}" log -1 --format=%cs
                  OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
file(CONFIGURE OUTPUT "${OUTPUT}"
     CONTENT "#pragma once\n\n#define IST_COMMIT \"${commit}\"\n#define IST_DATE \"${date}\"\n")
