# cmake -D SOURCE=FOLDER -D OUTPUT=FILE -P commit.cmake
# Writes the commit of the sources as a macro, with + where files are changed; only if it is another
# one than before, so that nothing is compiled again without a reason.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty=+ --abbrev=8 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "#pragma once\n\n#define IST_COMMIT \"${commit}\"\n")
