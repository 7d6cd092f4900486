#!/usr/bin/env bash
# Sets up, builds, and runs every test: what has threads under ThreadSanitizer, with the library
# compiled file by file, as users do; what reads files and what runs in vectors under AddressSanitizer
# and UndefinedBehaviorSanitizer; golden answers in WebAssembly, by clang and without assertions; then
# all, optimised with assertions, the page in a browser among them.
#
#   scripts/test.sh          all but what takes long, 20 to 50 minutes from nothing built on two cores
#   scripts/test.sh --long   that, and then hours of more: scripts/long.sh, which says what, and takes
#                            the words after --long
#
#   IST_DATA_DIR=FOLDER    where the real meshes are; by default ../shared/data
#   IST_REQUIRE_ALL=1      a test that would be skipped fails; the tools that simulate and synthesise
#                          the circuit, and those that check packages, are installed too
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") ;;
  --long) shift; exec scripts/long.sh "$@" ;;
  -h | --help) sed -n '2,14s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "test: unknown option $1; see --help" >&2; exit 2 ;;
esac
source scripts/run_preset.sh
setup=(--oracles --python --sweep --docs --viewer)
[ "${IST_REQUIRE_ALL:-}" != 1 ] || setup+=(--hardware --package)
scripts/setup.sh "${setup[@]}"

# File by file, since builds of several files as one hide a missing include. The long run tries what users build: the
# same files without ThreadSanitizer.
threaded="base_test thread_ranges_test capi_test loop_test tree_test search_test workers_test coherent_test"
run "thread -DIST_UNITY=OFF" "$threaded" -R "^Threads\.(${threaded// /|})$"
# What reads what a caller gives, and what runs in vectors; all rooms, all policies of random bodies and
# the arithmetic of exact triangles are watched in the long run.
run sanitize "ist_shared capi_test ist_c11_test labels_test mesh_test search_test fuzz_test" -E '_NOT_BUILT|[/_](avx3|sse4|ssse3|scalar)$|/[a-z]+Published(Saved)?$|^(Viewer|Docs)\.|^(House|Figures|Report|MutantsStillApply|BenchCompare|LongRuns|Doors|Release)$|/(Guarantee|AllPairsOf)\.[A-Za-z]*/(simple|table|tight)$|Thread\.|^Python\.(SweepParts|Threads)$|SplintModel|^Platforms$|OfMoreLeavesThan'
# The rooms that the golden answers come from; the long run compiles all rooms, by clang for x86-64 and for ARM64 too.
run "wasm -DIST_WERROR=ON -DIST_WITH_LOOP=OFF" golden_test
part "the page"
scripts/viewer.sh
part "readers of tables"
scripts/sweep_readers.sh
run test all -LE '^long$'
