#!/usr/bin/env bash
# Runs the benchmarks and keeps their raw results in perf/results/<machine>/, one JSON file a program.
#
#   scripts/bench.sh                    all programs; peers_bench where its peers are installed
#   scripts/bench.sh build_bench …      some; further arguments after -- go to each program
#   scripts/bench.sh peers_bench        beside other libraries, which it installs
set -euo pipefail
cd "$(dirname "$0")/.."
programs=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do programs+=("$1"); shift; done
[ $# -eq 0 ] || shift

needs=--bench
case " ${programs[*]} " in *" peers_bench "*) needs=--peers ;; esac
scripts/setup.sh $needs >&2
cmake --preset bench | grep '^-- Peers' >&2 || true
cmake --build --preset bench | tail -n 1 >&2
if [ ${#programs[@]} -eq 0 ]; then
  programs=(build_bench contact_bench deadline_bench haptics_bench kernel_bench load_bench query_bench reference_bench)
  if cmake --build --preset bench --target help | grep '^peers_bench:' >/dev/null; then
    programs+=(peers_bench)
  fi
fi

machine=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1 | tr -cs 'A-Za-z0-9' '-' | sed 's/-$//')
results=perf/results/$machine-$(nproc)
mkdir -p "$results"
for program in "${programs[@]}"; do
  build/bench/bench/"$program" --benchmark_out="$results/$program.json" --benchmark_out_format=json \
    --benchmark_context=commit="$(git rev-parse --short HEAD 2>/dev/null || echo none)" \
    --benchmark_context=compiler="$(g++ --version | head -n 1)" "$@"
done
