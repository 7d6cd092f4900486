#!/usr/bin/env bash
# Counts the instructions of ticks with callgrind: a scene with all six effects loses one after the
# other, beside a program without a scene that builds the remaining ones by hand. An unnamed effect
# costs nothing, so both must give the same count and the same bits, and each removed effect must
# save instructions; otherwise this fails.
#
#   scripts/tick_instructions.sh [TICKS]    by default 300
set -euo pipefail
cd "$(dirname "$0")/.."
ticks=300
case ${1:-} in
  "") ;;
  -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *[!0-9]*) echo "tick_instructions: '$1' is no number of ticks; see --help" >&2; exit 2 ;;
  *) ticks=$1 ;;
esac
scripts/setup.sh --bench --package >&2
cmake --preset bench >/dev/null
cmake --build --preset bench --target tick_instructions | tail -n 1 >&2

source scripts/machine.sh
mkdir -p "$results"
/usr/bin/python3 scripts/tick_instructions.py build/bench/bench/tick_instructions "$ticks" \
  "$results/tick_instructions.json" "${context[@]}"
