#!/usr/bin/env bash
# Makes the tables of perf/REPORT.md and of the closing in docs/performance.md, and the plots, from
# raw results in perf/results/<machine>/. The text of the pages is written by hand. Without the real
# jaws the pages go to build/report, as with --quick. The script runs the benchmarks that have no
# results of this code, so it goes on after an interruption. Results of an earlier commit count if no
# source of theirs has changed. Results of changes that no commit holds do not count. It takes some
# half an hour on two cores that have nothing else to do, and 5 minutes to build.
#
#   scripts/perf_report.sh            runs what has no results of this code
#   scripts/perf_report.sh --fresh    runs all again
#   scripts/perf_report.sh --fill     makes the tables from the results as they are, and runs nothing
#   scripts/perf_report.sh --quick    shows that all of it runs, in 3 minutes once built: few rounds,
#                                     large voxels; everything goes to build/report instead
#
#   IST_DATA_DIR=FOLDER    where the real jaws are, by default ../shared/data; else the built-in ones
set -euo pipefail
cd "$(dirname "$0")/.."
options=()
for argument in "$@"; do
  case $argument in
    --quick | --fresh | --fill) options+=("$argument") ;;
    -h | --help) sed -n '2,16s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "perf_report: unknown option $argument; see --help" >&2; exit 2 ;;
  esac
done
if [[ " ${options[*]} " != *" --fill "* ]]; then
  scripts/setup.sh --peers >&2
  cmake --preset bench | grep '^-- Peers' >&2 || true
  echo "perf_report: building" >&2
  cmake --build --preset bench >build/bench.log || { cat build/bench.log >&2; exit 1; }
fi
source scripts/machine.sh
PYTHONPATH=scripts exec /usr/bin/python3 -m report "${options[@]}" "$results" "${context[@]}"
