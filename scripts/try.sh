#!/usr/bin/env bash
# Compares the working tree with HEAD, for work on a kernel. It builds both as users do, runs `ist bench` of each in turn, and shows the rows
# that became faster or slower. It takes two minutes once both are built. The first build of HEAD takes some three minutes more.
# A row counts if the medians of all runs of one side lie beyond those of the other side, by 3 % at least.
#
#   scripts/try.sh                 the built-in jaws, in voxels of 0.4 mm
#   scripts/try.sh ARGUMENT …      of `ist bench`: FIXED MOVING, --voxel-size 0.2, …
#
# The exit code is 0 if no row is slower, 1 if one is, lists other pairs or is gone, and 2 if the sides could not be compared.
# scripts/bench_compare.sh compares two commits in more benchmarks.
set -eEuo pipefail
cd "$(dirname "$0")/.."
trap 'exit 2' ERR
fail() { echo "try: $*" >&2; exit 2; }
case ${1:-} in
  -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
paths=(CMakeLists.txt CMakePresets.json src simd)
[ -n "$(git status --porcelain -- "${paths[@]}")" ] || fail "nothing that is compiled differs from HEAD: change something first"
runs=4
arguments=("$@")
[ $# -gt 0 ] || arguments=(--voxel-size 0.4)

made=$PWD/build/try
mkdir -p "$made"
git worktree prune
if [ -e "$made/head" ]; then
  git -C "$made/head" checkout --quiet --detach "$(git rev-parse HEAD)"
else
  git worktree add --quiet --detach "$made/head" HEAD
fi
build() {  # folder, side
  echo "try: building $2" >&2
  (cd "$1" && cmake --preset release && cmake --build --preset release --target ist_cli) >"$made/$2.log" 2>&1 ||
    fail "$2 does not build; see $made/$2.log"
}
build "$made/head" head
build "$PWD" tree
rm -f "$made"/*.jsonl
for ((run = 1; run <= runs; ++run)); do
  order="head tree"
  [ $((run % 2)) = 1 ] || order="tree head"
  for side in $order; do
    echo "try: run $run of $runs, $side" >&2
    program=$made/head/build/release/ist
    [ $side = head ] || program=build/release/ist
    "$program" bench "${arguments[@]}" --json >"$made/$side-$run.jsonl" || fail "ist bench of $side fails"
  done
done
slower=0
python3 scripts/try.py "$made" || slower=$?
exit $slower
