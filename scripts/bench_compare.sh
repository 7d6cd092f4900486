#!/usr/bin/env bash
# Tells whether a commit is slower than another. It builds both as the benchmarks are built, runs them in turn, and compares the times.
# A benchmark is slower if its best time in HEAD is worse than its worst in BASE. If nothing changed, that happens to one benchmark in
# 3,400 by chance with seven runs, to one in 20 with three, and to benchmarks that are measured together at once. So ask again before
# you believe one row.
#
#   scripts/bench_compare.sh BASE HEAD    commits; with the same one twice it shows the noise
#     --runs N          of each side, at least 3, by default 7
#     --filter REGEX    benchmarks by name, of all programs, instead of the usual ones
#
# The usual ones are some 45, of building, the fast and the published query, contact points and kernels. Seven runs of both take
# 4 minutes, and building both some more. Raw results stay in build/compare/. The exit code is 0 if no benchmark is slower, 1 if one is,
# and 2 if the commits could not be compared.
#
#   IST_DATA_DIR=FOLDER    the folder of the real meshes; by default ../shared/data
set -eEuo pipefail
cd "$(dirname "$0")/.."
trap 'exit 2' ERR
fail() { echo "bench_compare: $*" >&2; exit 2; }

# The programs, and the benchmarks of each that are compared.
programs=(build_bench query_bench reference_bench contact_bench kernel_bench)
declare -A usual=(
  [build_bench]='^build/(table|slab)/0\.[48]'
  [query_bench]='^query/(0\.8/(table|slab)|0\.4/slab)/best/1/row/'
  [reference_bench]='^reference/0\.8/(table|slab)/on_the_fly/'
  [contact_bench]='^contact_points/0\.8/slab/32/'
  [kernel_bench]='^(advance|measure|write_leaf_pairs)/(avx2|scalar)(/slab/5|/table/5|/both)?$'
)
commits=() runs=7 filter=
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --runs | --filter) [ $# -gt 1 ] || fail "$1 needs a value; see --help" ;;&
    --runs) runs=$2; shift ;;
    --filter) filter=$2; shift ;;
    -*) fail "unknown option $1; see --help" ;;
    *) commits+=("$1") ;;
  esac
  shift
done
[ ${#commits[@]} -eq 2 ] || fail "needs two commits, BASE and HEAD; see --help"
[[ $runs =~ ^[1-9][0-9]?$ ]] && [ "$runs" -ge 3 ] || fail "--runs is from 3 to 99, not '$runs'"
grep -qE -- "$filter" </dev/null 2>/dev/null || [ $? = 1 ] || fail "--filter: '$filter' is no regular expression"
declare -A commit
for i in 0 1; do
  side=$([ $i = 0 ] && echo base || echo head)
  commit[$side]=$(git rev-parse --verify --quiet --end-of-options "${commits[i]}^{commit}") ||
    fail "'${commits[i]}' is no commit of this repository: git log shows them"
done
[ -z "$(git status --porcelain)" ] || echo "bench_compare: changes that no commit holds are not compared" >&2
scripts/setup.sh --bench >&2

mkdir -p build/compare
results=$PWD/build/compare/${commit[base]:0:9}-${commit[head]:0:9}
rm -rf "$results"
mkdir "$results"
trees=$(mktemp -d "$PWD/build/compare/trees.XXXXXX")
clean_up() {
  for side in base head; do
    [ ! -e "$trees/$side" ] || git worktree remove --force "$trees/$side" || true
  done
  rm -rf "$trees"
  git worktree prune
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

unset IST_QUICK
export IST_DATA_DIR=${IST_DATA_DIR:-$PWD/../shared/data}
declare -A here  # the programs that are to run, by side
for side in base head; do
  echo "bench_compare: building $side, ${commit[$side]:0:9}" >&2
  git worktree add --quiet --detach "$trees/$side" "${commit[$side]}" || fail "cannot check out $side"
  targets=()
  for program in "${programs[@]}"; do
    [ ! -e "$trees/$side/bench/$program.cpp" ] || targets+=("$program")
  done
  [ ${#targets[@]} -gt 0 ] || fail "$side has none of: ${programs[*]}"
  (cd "$trees/$side" && cmake --preset bench && cmake --build --preset bench --target "${targets[@]}") \
    >"$results/$side.log" 2>&1 || fail "$side does not build; see $results/$side.log"
  for program in "${targets[@]}"; do
    found=$("$trees/$side/build/bench/bench/$program" --benchmark_list_tests \
      --benchmark_filter="${filter:-${usual[$program]}}" 2>/dev/null) || fail "$side: $program does not run"
    if [ -n "$found" ]; then
      here[$side]+="$program "
    elif [ -z "$filter" ]; then
      echo "bench_compare: $side: $program has none of the benchmarks that are usually compared" >&2
    fi
  done
  [ -n "${here[$side]:-}" ] || fail "$side has no benchmark that is to be compared"
done

began=$SECONDS
for ((run = 1; run <= runs; ++run)); do
  order="base head"
  [ $((run % 2)) = 1 ] || order="head base"
  for side in $order; do
    echo "bench_compare: run $run of $runs, $side, after $((SECONDS - began)) s" >&2
    for program in ${here[$side]}; do
      file=$results/$side-$run-$program
      "$trees/$side/build/bench/bench/$program" --benchmark_filter="${filter:-${usual[$program]}}" \
        --benchmark_min_time=0.2 --benchmark_out="$file.json" --benchmark_out_format=json \
        --benchmark_context=commit="${commit[$side]:0:9}" >"$file.log" 2>&1 || fail "$side: $program failed; see $file.log"
    done
  done
done
slower=0
python3 scripts/bench_compare.py "$results" || slower=$?
exit $slower
