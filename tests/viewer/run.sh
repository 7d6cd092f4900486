#!/usr/bin/env bash
# Runs tests of the page by node.
#
#   run.sh engine|page|sources [--passes=N] TEST.mjs ...
#
# With --passes it fails too where others than N tests pass: a pattern of names that no test has any more.
# Ends with 77, which ctest takes for skipped, where the engine or the page is not built, and with 1
# where IST_REQUIRE_ALL=1.
set -euo pipefail
needs=$1
shift
passes=
case ${1:-} in
  --passes=*) passes=${1#*=}; shift ;;
esac
missing() {
  echo "$1: run scripts/viewer.sh"
  [ "${IST_REQUIRE_ALL:-}" != 1 ] || exit 1
  exit 77
}
command -v node >/dev/null || missing "node is not installed"
[ "$needs" = sources ] || [ -e "$IST_ENGINE/engine.wasm" ] || missing "$IST_ENGINE/engine.wasm is not there"
[ "$needs" != page ] || [ -e "$IST_PAGE" ] || missing "$IST_PAGE is not there"
[ "$needs" != page ] || command -v chromium >/dev/null || missing "chromium is not installed"
[ -n "$passes" ] || exec node --test "$@"
output=$(mktemp)
trap 'rm -f "$output"' EXIT
node --test "$@" | tee "$output"
grep -qE "^(#|ℹ) pass $passes\$" "$output" || { echo "run: $passes tests are to pass, by: $*"; exit 1; }
