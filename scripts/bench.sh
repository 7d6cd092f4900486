#!/usr/bin/env bash
# Runs the benchmarks and keeps their raw results in perf/results/<machine>/, one JSON file a program.
#
#   scripts/bench.sh                    all programs; peers_bench with the peers that are installed
#   scripts/bench.sh build_bench …      some; further arguments after -- go to each program
#   scripts/bench.sh peers_bench        beside other libraries, which it installs
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
  -- | "" | [!-]*) ;;
  *) echo "bench: unknown option $1; see --help" >&2; exit 2 ;;
esac
programs=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do programs+=("$1"); shift; done
[ $# -eq 0 ] || shift

needs=--bench
case " ${programs[*]} " in *" peers_bench "*) needs=--peers ;; esac
scripts/setup.sh $needs >&2
cmake --preset bench | grep '^-- Peers' >&2 || true
cmake --build --preset bench | tail -n 1 >&2
if [ ${#programs[@]} -eq 0 ]; then
  for program in build/bench/bench/*_bench; do programs+=("${program##*/}"); done
fi

source scripts/machine.sh
mkdir -p "$results"
unset IST_QUICK
for program in "${programs[@]}"; do
  begin=$SECONDS
  before=$(build/bench/bench/fixed_loop)
  build/bench/bench/"$program" --benchmark_out="$results/$program.part" --benchmark_out_format=json "$@"
  PYTHONPATH=scripts /usr/bin/python3 -m report.results "$results/$program.part" "${context[@]}" \
    "seconds=$((SECONDS - begin))" "arguments=$*" "loop_before=$before" \
    "loop_after=$(build/bench/bench/fixed_loop)" "load_after=$(cut -d' ' -f1 /proc/loadavg)"
  mv "$results/$program.part" "$results/$program.json"
done
