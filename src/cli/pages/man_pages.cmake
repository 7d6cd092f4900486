# cmake -D HELP2MAN=FILE -D VERSION=1.2.3 -D HELP=FOLDER -D MAN=FOLDER -P man_pages.cmake
# Makes MAN/NAME.1 from each HELP/NAME.txt by help2man. The date is the commit's, so that the same sources give the
# same bytes; SOURCE_DATE_EPOCH goes before it.
include(${CMAKE_CURRENT_LIST_DIR}/../../package/commit.cmake)
ist_commit(commit seconds)
set(ENV{SOURCE_DATE_EPOCH} ${seconds})
file(GLOB texts ${HELP}/*.txt)
foreach(text IN LISTS texts)
  cmake_path(GET text STEM name)
  file(STRINGS ${text} summary LIMIT_COUNT 1 ENCODING UTF-8)
  string(REGEX REPLACE "[.]$" "" summary "${summary}")
  # help2man asks a command for its help: `cat` prints it.
  execute_process(COMMAND ${HELP2MAN} --no-info --locale=C.UTF-8 "--name=${summary}" "--source=ist ${VERSION}"
                          "--version-string=${name} ${VERSION}" "--help-option='${text}'" --output=${MAN}/${name}.1 cat
                  COMMAND_ERROR_IS_FATAL ANY)
endforeach()
