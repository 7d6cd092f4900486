# Which commit the sources are of. In a checkout git knows, and in an archive of a commit commit.txt, into which
# `git archive` has written it; git would name another project's commit where an archive is unpacked inside that.
#
#   cmake -P commit.cmake      prints the seconds since 1970
set(IST_COMMIT_FILE ${CMAKE_CURRENT_LIST_DIR}/commit.txt)
get_filename_component(IST_COMMIT_SOURCE ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)

# Sets `commit` to eight digits, with + where files are changed, or to "unknown"; `seconds` to the time of the commit,
# since 1970, or of CHANGELOG.md where none is known. SOURCE_DATE_EPOCH of the environment goes before both.
function(ist_commit commit seconds)
  file(STRINGS ${IST_COMMIT_FILE} lines)
  list(GET lines 0 name)
  list(GET lines 1 time)
  if(name MATCHES "^[0-9a-f]+$")
    string(SUBSTRING ${name} 0 8 name)
  else()
    execute_process(COMMAND git -C ${IST_COMMIT_SOURCE} describe --always --dirty=+ --abbrev=8 --exclude=*
                    OUTPUT_VARIABLE name OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(failed)
      set(name unknown)
      file(TIMESTAMP ${IST_COMMIT_SOURCE}/CHANGELOG.md time %s UTC)
    else()
      execute_process(COMMAND git -C ${IST_COMMIT_SOURCE} log -1 --format=%ct
                      OUTPUT_VARIABLE time OUTPUT_STRIP_TRAILING_WHITESPACE)
    endif()
  endif()
  if(NOT "$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
    set(time $ENV{SOURCE_DATE_EPOCH})
  endif()
  set(${commit} ${name} PARENT_SCOPE)
  set(${seconds} ${time} PARENT_SCOPE)
endfunction()

# Sets `result` to seconds since 1970 in a format of string(TIMESTAMP), in UTC.
function(ist_format_time seconds format result)
  set(before "$ENV{SOURCE_DATE_EPOCH}")
  set(ENV{SOURCE_DATE_EPOCH} ${seconds})
  string(TIMESTAMP text ${format} UTC)
  set(ENV{SOURCE_DATE_EPOCH} ${before})
  set(${result} ${text} PARENT_SCOPE)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  ist_commit(commit seconds)
  execute_process(COMMAND ${CMAKE_COMMAND} -E echo ${seconds})
endif()
