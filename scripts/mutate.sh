#!/usr/bin/env bash
# Tests the tests: breaks the code in one named way after the other (scripts/mutants), in a copy,
# and runs tests until one fails. A mutant that no test kills fails the run. All of them take
# up to three hours on two cores. Writes perf/MUTANTS.md, where a run of some renews their rows.
#
#   scripts/mutate.sh               every mutant
#   scripts/mutate.sh NAME...       those whose names contain one of these words
#   scripts/mutate.sh --missing     those that no test has killed at this commit, as after a run that was cut short
#   scripts/mutate.sh --fast [NAME...]   by the tests of scripts/test.sh alone, which writes nothing
#   scripts/mutate.sh --list        their names, and what each breaks
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  -h | --help) sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 0 ;;
  --list) ;;
  *) scripts/setup.sh --tests --hardware --package ;;
esac
exec python3 scripts/mutate.py "$@"
