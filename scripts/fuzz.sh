#!/usr/bin/env bash
# Builds the fuzzers and runs each for a while on its corpus, under AddressSanitizer and
# UndefinedBehaviorSanitizer. Prints what each came to; any finding fails, and its input is kept.
#
#   scripts/fuzz.sh [TARGET…] [--seconds N]    N seconds each, by default 60
#
# Targets are the folders of tests/fuzz/corpus. What they find out is kept in build/fuzz/corpus and
# begun with the next time; an input that should be replayed in every run goes to tests/fuzz/corpus,
# named OUTCOME.WHAT.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=60
targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds)
      seconds=${2:-}
      [[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "fuzz: --seconds needs a number" >&2; exit 2; }
      shift 2 ;;
    -h | --help) sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "fuzz: unknown option $1; see --help" >&2; exit 2 ;;
    *)
      [ -d "tests/fuzz/corpus/$1" ] || { echo "fuzz: there is no target $1" >&2; exit 2; }
      targets+=("$1")
      shift ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(ls tests/fuzz/corpus)

scripts/setup.sh --fuzz
echo "== preset fuzz"
cmake --preset fuzz >/dev/null
if ! cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}" >build/fuzz.log; then
  cat build/fuzz.log
  exit 1
fi

last() { sed -nE "s/^$1 *(.*)/\1/p" "$2" | tail -n 1; }

failed=0
memory=$(mktemp -d)  # where a write need not wait for a disk, if there is such a place
[ -w /dev/shm ] && { rmdir "$memory"; memory=$(mktemp -d -p /dev/shm); }
trap 'rm -rf "$memory"' EXIT
for target in "${targets[@]}"; do
  kept=build/fuzz/corpus/$target found=build/fuzz/findings log=build/fuzz/$target.log
  mkdir -p "$kept" "$found"
  TMPDIR=$memory UBSAN_OPTIONS=print_stacktrace=1 \
    "build/fuzz/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -max_len=4096 -timeout=10 \
    -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="$found/$target-" \
    "$kept" "tests/fuzz/corpus/$target" >"$log" 2>&1 &
  fuzzer=$!
  for ((second = 0; second < seconds; ++second)); do
    kill -0 $fuzzer 2>/dev/null || break
    sleep 1
    [ ! -t 2 ] || printf '\r\033[K%s: %d of %d s' "$target" $((second + 1)) "$seconds" >&2
  done
  [ ! -t 2 ] || printf '\r\033[K' >&2
  if wait $fuzzer; then
    edges=$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1)
    echo "$target: $(last 'stat::number_of_executed_units:' "$log") executions in $seconds s," \
      "${edges#cov: } edges covered, no finding"
  else
    failed=1
    echo "$target: A FINDING; its input is in $found, the rest in $log:"
    grep -m 1 -A 25 -E 'ERROR: |runtime error: |what\(\): ' "$log" || tail -n 25 "$log"
  fi
done
exit $failed
