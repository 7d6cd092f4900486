#!/usr/bin/env bash
# Makes perf/STABILITY.md: tries the hard cases many more times than a run of all tests does, and
# shows the worst error of each beside what is guaranteed. Some 20 minutes on two cores.
#
#   scripts/stability_report.sh                10 million queries of real jaws, 20 times the other samples
#   scripts/stability_report.sh --quick        as many as in a run of all tests, written to build/stability
#   scripts/stability_report.sh --out FOLDER   written there instead of perf/
set -euo pipefail
cd "$(dirname "$0")/.."
effort=20 load_effort=1000 folder=perf
case ${1:-} in
  "") ;;
  --quick) effort=1 load_effort=1 folder=build/stability ;;
  --out) folder=${2:?stability_report: --out needs a folder} ;;
  -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "stability_report: unknown option $1; see --help" >&2; exit 2 ;;
esac
scripts/setup.sh --tests --bench >&2
cmake --preset test >/dev/null
programs=(stability_test load_test search_test fuzz_test cli_test)
cmake --build --preset test --target "${programs[@]}" | tail -n 1 >&2

cases=${IST_STABILITY:-$PWD/build/stability.jsonl}
rm -f "$cases"
export IST_STABILITY=$cases IST_DATA_DIR=${IST_DATA_DIR:-$PWD/../shared/data}
failed=0
run() {  # effort, program, filter
  echo "== $2 $3, $1 times the samples" >&2
  IST_EFFORT=$1 build/test/tests/"$2" --gtest_brief=1 --gtest_filter="$3" >&2
}
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
run "$load_effort" load_test '*' &
load=$!
# What breaks its guarantee is shown too.
run "$effort" stability_test '*' || failed=1
run "$effort" search_test 'SharedTreeThread.*' || failed=1
run "$effort" fuzz_test '*' || failed=1
run 1 cli_test 'Faults*:CutFiles*:Interruption*:SweepCommand*' || failed=1
wait $load || failed=1

source scripts/machine.sh
/usr/bin/python3 scripts/stability_report.py "$cases" "$folder" \
  "$model, $(nproc) cores; $compiler; commit $commit" "$commit" "$(date -I)"
results=$folder/results/$machine
mkdir -p "$results"
cp "$cases" "$results/stability.jsonl"
echo "$folder/STABILITY.md" >&2
exit $failed
