# shellcheck shell=bash
# What the doors share. A door is what one kind of user does by the pages alone, in a bare Debian 12 where that can be had: a root
# made by debootstrap, copied for each door. Where it cannot, packages are unpacked in a folder, and this machine's programs
# are used; the first line of the log says so, and why.
#
#   source "$(dirname "$0")/door.sh"
#   door NAME "$@"               takes --without-root, --keep and --help
#   step TITLE COMMAND …         runs on this machine
#   types TITLE TEXT             lets a user type a text, where the door leads to
#   by_page PAGE WORDS           types the block of a page that holds WORDS, and compares what the page shows below it
#   installs TITLE TEXT          types what installs packages; passed over where packages are unpacked
#   lacks TEXT                   ends the door with 77, with 1 where IST_REQUIRE_ALL=1: what it needs is not to be had
#   end_door                     prints the table of all steps and their times
#
# A step that fails ends the door with 1, and its log's end is shown. Logs are build/doors/NAME.log.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source=$(cd "$here/../.." && pwd)
doors=${IST_DOORS:-$source/build/doors}
titles=() seconds=()
# shellcheck source=tests/doors/place.sh
source "$here/place.sh"

door() {
  name=$1 keep=false without_root=
  shift
  local argument
  for argument in "$@"; do
    case $argument in
      --without-root) without_root="--without-root asks for it" ;;
      --keep) keep=true ;;
      -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0 ;;
      *) echo "$name: unknown option $argument; see --help" >&2; exit 2 ;;
    esac
  done
  log=$doors/$name.log work=$doors/$name
  [ -z "${IST_DOOR_INSIDE:-}" ] || { way=root; enter_root; return 0; }
  mkdir -p "$doors"
  [ -n "$without_root" ] || without_root=$(why_no_root)
  [ -n "$without_root" ] || make_root || without_root="debootstrap failed, see $doors/debootstrap.log"
  if [ -n "$without_root" ]; then
    way=unpacked walk=$work/walk
    echo "door $name, in unpacked packages, without a root of its own: $without_root" | tee "$log"
    rm -rf "$work"
    mkdir -p "$walk"
    return 0
  fi
  echo "door $name, in a bare Debian 12 root" | tee "$log"
  # What is mounted is seen by the door alone, and goes with it.
  local status=0
  IST_DOOR_INSIDE=1 unshare --mount bash "$0" "$@" || status=$?
  if [ $status = 0 ] && ! $keep; then rm -rf --one-file-system "${work:?}"; fi
  exit $status
}

now() { echo "${EPOCHREALTIME/,/.}"; }

step() {
  local title=$1 begin status
  shift
  printf '\n== %d. %s\n' $((${#titles[@]} + 1)) "$title" >>"$log"
  begin=$(now)
  set +e
  (set -e; "$@") >>"$log" 2>&1 </dev/null
  status=$?
  set -e
  titles+=("$title")
  seconds+=("$(awk "BEGIN {printf \"%.1f\", $(now) - $begin}")")
  echo "-- ${seconds[-1]} s" >>"$log"
  printf '%9.1f s  %s\n' "${seconds[-1]}" "$title"
  [ $status != 77 ] || not_walked "$(sed -n 's/^lacks: //p' "$log" | tail -n 1)"
  [ $status = 0 ] && return
  {
    echo "door $name: step ${#titles[@]} failed with $status: $title. The end of $log:"
    tail -n 40 "$log"
  } >&2
  table >>"$log"
  exit 1
}

lacks() {
  echo "lacks: $1"
  exit 77
}

not_walked() {
  echo "door $name cannot be walked: it $1" | tee -a "$log" >&2
  table >>"$log"
  [ "${IST_REQUIRE_ALL:-}" = 1 ] && exit 1
  exit 77
}

table() {
  local i
  printf '\n| step of %s (%s) | s |\n|---|---|\n' "$name" "$way"
  for i in "${!titles[@]}"; do echo "| ${titles[i]} | ${seconds[i]} |"; done
  printf '%s\n' "${seconds[@]}" | awk '{sum += $1} END {printf "| all | %.1f |\n", sum}'
}

end_door() {
  table | tee -a "$log"
  echo "door $name: walked; $log has all that was typed and printed"
}

block() { /usr/bin/python3 -B "$here/page_block.py" "$source/$1" "${@:2}"; }

# What stands in the log is what a user types, and what that prints.
typed() {
  printf '%s\n' "$1" | sed 's/^/$ /'
  in_place "$1" | tee "$work/printed"
}
types() { step "$1" typed "$2"; }

typed_by_page() {  # page, words, whether the page shows what it prints
  local text
  text=$(block "$1" block "$2")
  typed "$text"
  ! "$3" || block "$1" compare "$2" "$work/printed"
}
by_page() { step "$1: $2" typed_by_page "$1" "$2" true; }
by_page_alone() { step "$1: $2" typed_by_page "$1" "$2" false; }

written() { block "$1" file "$2" | tee "$walk/$2"; }
writes() { step "$2, as $1 has it" written "$1" "$2"; }

installs() {
  [ "$way" = root ] || { echo "   passed over: $1" | tee -a "$log"; return 0; }
  types "$1" "$2"
}
