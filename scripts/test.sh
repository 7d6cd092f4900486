#!/usr/bin/env bash
# Sets up, builds as users do, and runs every test: what users build, with its own tests; what has
# threads under ThreadSanitizer; what reads files and what runs in vectors under AddressSanitizer and
# UndefinedBehaviorSanitizer; golden answers by clang, for ARM64 and in WebAssembly; then all,
# optimised with assertions, the page in a browser among them.
#
#   scripts/test.sh          all but what takes long, 30 to 60 minutes from nothing built on two cores
#   scripts/test.sh --long   then the packages and the circuit's synthesis, golden answers by more
#                            compilers and optimisations, a program built for ARM64 from the package,
#                            every room and test under the sanitizers, hard cases with 20 times the
#                            samples, ten million queries of real jaws, an hour of simulated pressing,
#                            threads for longer, CloudCompare's distances, the add-on in Blender, the four
#                            doors of tests/doors in a bare Debian, and each fuzzer for a minute; three
#                            hours more
#
#   IST_DATA_DIR=FOLDER    where the real meshes are; by default ../shared/data
#   IST_REQUIRE_ALL=1      a test that would be skipped fails; the tools that simulate and synthesise
#                          the circuit, and those that check packages, are installed too
set -euo pipefail
cd "$(dirname "$0")/.."
long=false
case ${1:-} in
  "") ;;
  --long) long=true ;;
  -h | --help) sed -n '2,19s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "test: unknown option $1; see --help" >&2; exit 2 ;;
esac
setup=(--oracles --python --sweep --docs --cross --viewer)
[ "${IST_REQUIRE_ALL:-}" != 1 ] || setup+=(--hardware --package)
! $long || setup+=(--cloudcompare --blender --slurm --doors)
scripts/setup.sh "${setup[@]}"
jobs=$(nproc)

part() { echo "== $1 (after $SECONDS s)"; }

run() {  # preset and its options, targets to build, then arguments for ctest
  local options=($1) targets=$2
  local preset=${options[0]}
  shift 2
  part "preset ${options[*]}"
  cmake --preset "${options[@]}" >/dev/null
  # shellcheck disable=SC2086  # targets are words
  if ! cmake --build --preset "$preset" --target $targets -- -j"$jobs" >"build/$preset.log"; then
    cat "build/$preset.log"
    exit 1
  fi
  ctest --preset "$preset" -j"$jobs" "$@" | grep -vE '^ *Start +[0-9]+:'
}

# What users build: the library file by file, since builds of several files as one hide a missing include.
run "release -DIST_TESTS=ON" "golden_test base_test mesh_test tree_test query_test search_test" \
  -L '^(golden|base|mesh|tree|query|search)_test$' -E 'RealPairs\.HaveTheTriangles'
threaded="base_test thread_ranges_test capi_test loop_test tree_test search_test workers_test coherent_test"
run thread "$threaded" -R "^Threads\.(${threaded// /|})$"
# What reads what a caller gives, and what runs in vectors; all rooms, and the policies that share code
# with `table` and `slab`, are watched in the long run.
run sanitize "ist_shared capi_test ist_c11_test labels_test mesh_test search_test fuzz_test exact_test" -E '_NOT_BUILT|[/_](avx3|sse4|ssse3)$|/[a-z]+Published(Saved)?$|^(Viewer|Docs)\.|^(House|Figures|Report|MutantsStillApply|BenchCompare)$|/(Guarantee|AllPairsOf)\.[A-Za-z]*/(simple|tight)$|Thread\.|SplintModel|^Platforms$|OfMoreLeavesThan'
# The rooms that the golden answers come from; the long run compiles all rooms.
for preset in clang14 arm64 wasm; do run "$preset -DIST_WERROR=ON -DIST_WITH_LOOP=OFF" golden_test; done
part "the page"
scripts/viewer.sh
part "readers of tables"
scripts/sweep_readers.sh
run test all -LE '^long$'
$long || exit 0

part "packages, the circuit by more tools, and platforms that are refused"
ctest --preset test -L '^long$'
# Benchmarks are compiled by nothing else.
scripts/setup.sh --peers
cmake --preset bench -DIST_WERROR=ON >/dev/null
cmake --build --preset bench -- -j"$jobs" >build/bench.log || { cat build/bench.log; exit 1; }
scripts/golden_table.py --check
scripts/arm64_package.sh
run "python -DIST_GOLDEN=ON" "ist_shared golden_test"
run sanitize-all all -E '^(House|Figures|Report|HardwareReport|MutantsStillApply|BenchCompare)$|^(Package|Docs|Viewer)\.'
export IST_DATA_DIR=${IST_DATA_DIR:-$PWD/../shared/data} TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp
more() {  # preset, times the samples, program, filter
  part "$3 $4, preset $1, $2 times the samples"
  local said
  said=$(IST_EFFORT=$2 "build/$1/tests/$3" --gtest_brief=1 --gtest_filter="$4") || { echo "$said"; return 1; }
  echo "$said"
  ! grep -q "Running 0 tests" <<<"$said" || { echo "test: no test of $3 is named like $4" >&2; return 1; }
}
part "Package.Subdirectory and Python.Sdist, all compiled"
IST_COMPILE_ALL=1 ctest --preset test -R '^(Package\.Subdirectory|Python\.Sdist)$'
for jaws in built-in human; do
  part "distances of the $jaws jaws against CloudCompare's"
  /usr/bin/python3 -B tests/cli/occlusion/distances_by_cloudcompare.py "$jaws" build/test/ist \
    "build/test/cloudcompare-$jaws" || [ $? -eq 77 ]
done
part "the add-on in Blender"
/usr/bin/python3 -B tests/python/recipes/blender_itself.py build/test/src/package/libist.so || [ $? -eq 77 ]
for door in scans haptics script cycles; do
  part "door $door"
  "tests/doors/$door.sh" || [ $? -eq 77 ]
done
more thread 100 search_test 'SharedTreeThread.*'
more test 11 coherent_test 'Policies/CoherentQuery*:CoherentQueryOfScans*'  # a million ticks
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
more test 1000 load_test '*' &
load=$!
more test 20 stability_test '*'
more test 600 haptics_test 'LongPressing.*'
more test 17 cli_test 'SweepCommand.Kills*'  # 51 kills
more test 50 haptics_test 'AmongFiveBodies.PressesGiveNoEnergyBack'  # a million ticks among five bodies
wait $load
scripts/fuzz.sh --seconds 60
