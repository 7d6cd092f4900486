#!/usr/bin/env bash
# Builds the fuzzers and runs each for a while on its corpus, one on each core, under AddressSanitizer and
# UndefinedBehaviorSanitizer. Prints the executions of each; any finding fails, and its input is kept.
#
#   scripts/fuzz.sh [TARGET…] [--seconds N]    N seconds each, by default 60
#
# Each tests/fuzz/corpus/TARGET.zip is the corpus of a target. The inputs that a fuzzer adds are kept in build/fuzz/corpus;
# the next run begins with them. This command adds an input to the corpus, and every run of the tests replays it:
#   python3 tests/fuzz/add_input.py TARGET OUTCOME.WHAT FILE
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
      [ -f "tests/fuzz/corpus/$1.zip" ] || { echo "fuzz: there is no target $1" >&2; exit 2; }
      targets+=("$1")
      shift ;;
  esac
done
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(basename -s .zip tests/fuzz/corpus/*.zip)

scripts/setup.sh --tests --fuzz
echo "== preset fuzz"
cmake --preset fuzz >/dev/null
if ! cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}" >build/fuzz.log; then
  cat build/fuzz.log
  exit 1
fi

# Files in memory save waits for a disk.
memory=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo /tmp)")
trap 'rm -rf "$memory"' EXIT

fuzz() {  # a target; prints its outcome at once
  local kept=build/fuzz/corpus/$1 log=build/fuzz/$1.log edges executions
  mkdir -p "$kept" build/fuzz/findings
  if TMPDIR=$memory UBSAN_OPTIONS=print_stacktrace=1 \
    "build/fuzz/tests/fuzz/fuzz_$1" -max_total_time="$seconds" -max_len=4096 -timeout=10 \
    -rss_limit_mb=2048 -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$1-" \
    "$kept" "build/fuzz/tests/fuzz/corpus/$1" >"$log" 2>&1; then
    edges=$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1)
    executions=$(sed -nE 's/^stat::number_of_executed_units: *(.*)/\1/p' "$log" | tail -n 1)
    echo "$1: $executions executions in $seconds s, ${edges#cov: } edges covered, no finding"
  else
    echo "$1: A FINDING; its input is in build/fuzz/findings, the rest in $log:
$(grep -m 1 -A 25 -E 'ERROR: |runtime error: |what\(\): ' "$log" || tail -n 25 "$log")"
    return 1
  fi
}
export -f fuzz
export seconds memory
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I TARGET bash -c 'fuzz TARGET' || exit 1
