#!/usr/bin/env bash
# For bash to source: long work in parts, of which those that have passed need not run again.
#
#   begin_parts FOLDER [--resume] [--list] [PART …]   where the logs are; which parts are meant
#   alone NAME COMMAND …                              a part that has the machine for itself
#   aside NAME COMMAND …                              one that may run beside others, as many as there are cores
#   also[NAME]="PATHS"                                files that a part rests on beside the code
#   end_parts                                         waits for all; ends with 1 where one failed, 2 where a word names none
#
# A part's log is FOLDER/NAME.log; scripts/long.sh says what its last line is.

begin_parts() {
  folder=$1 resume=false list=false chosen=() known=() failed=() running=()
  shift
  while [ $# -gt 0 ]; do
    case $1 in
      --resume) resume=true ;;
      --list) list=true ;;
      -*) echo "${0##*/}: unknown option $1; see --help" >&2; exit 2 ;;
      *) chosen+=("$1") ;;
    esac
    shift
  done
  mkdir -p "$folder"
  trap 'trap - INT TERM; echo "${0##*/}: stopped; --resume goes on" >&2; kill -TERM 0' INT TERM
}

# All but pages and results: a table of what passed is committed, and what passed counts on.
code=(. ':!docs' ':!perf' ':(exclude,glob)*.md')
# The pages whose words are tried, for `also`.
pages="README.md docs :!docs/guarantees.md :!docs/pictures"
declare -A also=()
same_code() {  # a commit, and files more: whether code and files are now as they were at that commit
  [ -z "$(git status --porcelain -- "${code[@]}")" ] || return 1
  git diff --quiet "$1" HEAD -- "${code[@]}" 2>/dev/null || return 1
  [ $# -eq 1 ] || git diff --quiet "$1" -- "${@:2}"
}
passed() {  # and at a commit since which no code changed
  [ -e "$folder/$1.log" ] || return 1
  local at
  at=$(tail -n 1 "$folder/$1.log" | sed -n 's/^passed at \([0-9a-f]*\) on .*/\1/p')
  # shellcheck disable=SC2086  # paths are words
  [ -n "$at" ] && same_code "$at" ${also[$1]:-}
}

is_chosen() {
  [ ${#chosen[@]} -gt 0 ] || return 0
  local word
  for word in "${chosen[@]}"; do [[ $1 != "$word"* ]] || return 0; done
  return 1
}

perform() {  # a part's name, and its command
  set +e
  local name=$1 log=$folder/$1.log begun=$SECONDS status verdict commit rests=${also[$1]:-} changes=''
  shift
  commit=$(git rev-parse --short=12 HEAD)
  # shellcheck disable=SC2086  # paths are words
  same_code "$commit" $rests || changes=' with changes'
  rm -f "$folder/$name.jsonl"
  (set -euo pipefail; IST_STABILITY=$folder/$name.jsonl "$@") >"$log" 2>&1
  status=$?
  # shellcheck disable=SC2086
  same_code "$commit" $rests || changes=' with changes'
  case $status in
    0) verdict=passed ;;
    77) verdict=skipped ;;
    *) verdict=failed ;;
  esac
  echo "$verdict at $commit$changes on $(date -u +%Y-%m-%d) in $((SECONDS - begun)) s" >>"$log"
  [ "$verdict" = passed ] || [ "$verdict $(printenv IST_REQUIRE_ALL)" = "skipped " ]
}

settle() {  # waits until no more than N parts run
  while [ ${#running[@]} -gt "$1" ]; do
    local name=${running[0]%% *}
    wait "${running[0]#* }" || failed+=("$name")
    echo "== $name: $(tail -n 1 "$folder/$name.log") (after $SECONDS s)"
    running=("${running[@]:1}")
  done
}

begin() {  # how many parts may run beside it; its name; its command
  local beside=$1 name=$2
  shift 2
  known+=("$name")
  is_chosen "$name" || return 0
  if $list; then
    if [ ! -e "$folder/$name.log" ]; then
      echo "$name: never begun"
    else
      echo "$name: $(passed "$name" && echo counts || echo not) at this commit: $(tail -n 1 "$folder/$name.log" | cut -c1-100)"
    fi
  elif $resume && passed "$name"; then
    echo "== $name: passed before"
  else
    settle "$beside"
    perform "$name" "$@" &
    running+=("$name $!")
    [ "$beside" != 0 ] || settle 0
  fi
}
alone() { begin 0 "$@"; }
aside() { begin $((jobs - 1)) "$@"; }

end_parts() {
  settle 0
  local word
  for word in "${chosen[@]}"; do
    printf '%s\n' "${known[@]}" | grep -q "^$word" || { echo "${0##*/}: no part begins with $word: there are ${known[*]}" >&2; exit 2; }
  done
  [ ${#failed[@]} = 0 ] || { echo "${0##*/}: failed: ${failed[*]}; see $folder" >&2; exit 1; }
}
