#!/usr/bin/env bash
# Counts the instructions of ten fixed queries, and of ticks of two scenes with one fixed body, with
# callgrind, and compares them with those that perf/query_instructions.json keeps: a count that is
# over 1 % more or less fails. Counts do not depend on load, so this notices what no clock would.
#
# Counted is what the tests run on, preset test with its assertions, one worker on AVX2. Where
# compiler or flags are not those of the counts that are kept, or valgrind or AVX2 is missing, nothing
# can be compared: that is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it is 1.
#
#   scripts/query_instructions.sh                    builds, counts and compares, as ctest does
#   scripts/query_instructions.sh --update           keeps the new counts, and tells what has changed
#   scripts/query_instructions.sh --program FILE     counts a program that is built already
set -euo pipefail
cd "$(dirname "$0")/.."
program= update=
while [ $# -gt 0 ]; do
  case $1 in
    --update) update=--update ;;
    --program)
      [ $# -gt 1 ] || { echo "query_instructions: --program needs a file; see --help" >&2; exit 2; }
      program=$2
      shift
      ;;
    -h | --help) sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "query_instructions: unknown option $1; see --help" >&2; exit 2 ;;
  esac
  shift
done
if [ -z "$program" ]; then
  scripts/setup.sh --tests --package >&2
  cmake --preset test >/dev/null
  cmake --build --preset test --target query_instructions | tail -n 1 >&2
  program=build/test/tests/query_instructions
fi
exec python3 scripts/query_instructions.py "$program" perf/query_instructions.json $update
