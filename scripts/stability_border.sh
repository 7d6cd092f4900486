#!/usr/bin/env bash
# Makes perf/HAPTIC_STABILITY.md and its plot: presses walls with stiffer and stiffer couplings, and
# shows what energy comes back and from which stiffness on, beside the border that the loop computes.
# Nothing is timed. Some two minutes on one core, once built.
#
#   scripts/stability_border.sh
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "stability_border: unknown option $1; see --help" >&2; exit 2 ;;
esac
scripts/setup.sh --bench >&2
cmake --preset bench >/dev/null
cmake --build --preset bench --target stability_border | tail -n 1 >&2

source scripts/machine.sh
mkdir -p "$results"
build/bench/bench/stability_border >build/stability_border.jsonl
mv build/stability_border.jsonl "$results/stability_border.jsonl"
/usr/bin/python3 scripts/stability_border.py "$results/stability_border.jsonl" perf \
  "$model; $compiler; commit $commit" "$commit" "$(date -I)"
echo perf/HAPTIC_STABILITY.md >&2
