#!/usr/bin/env bash
# Runs what takes hours, part by part: scripts/test.sh itself; the tests of what users build; the packages, and the
# circuit's synthesis; golden answers by more compilers and optimisations; a program built for ARM64 from the package;
# every room and test under the sanitizers; the hard cases of perf/STABILITY.md with 20 times the samples, and ten
# million queries of real jaws; an hour of simulated pressing; a million ticks of coherent queries against fresh ones;
# CloudCompare's distances; Blender; a release, built twice; the four doors of tests/doors in a bare Debian; each
# fuzzer for 30 minutes. Parts that use one core run side by side.
#
#   scripts/long.sh                 every part anew
#   scripts/long.sh --resume        those that do not count at this commit
#   scripts/long.sh PART …          these; a word stands for all parts that begin with it
#   scripts/long.sh --list          which parts count at this commit
#
# A part keeps its log, build/long/PART.log. The log's last line says whether the part passed, at which commit, when and
# how long it took; where code is not committed, or changes meanwhile, it passes for nothing. A part that passed counts until
# something else than pages and results changes: docs/, perf/ and the pages beside them. A door types what pages say, and counts
# until one of these changes too. A test that ctest skips is counted as such; IST_REQUIRE_ALL=1 lets it fail. A part that fails ends this with 1, when all others have run. scripts/long_table.py writes the
# results to docs/guarantees.md.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  -h | --help) sed -n '2,18s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
source scripts/run_preset.sh
source scripts/parts.sh
begin_parts "$PWD/build/long" "$@"
export IST_DATA_DIR=${IST_DATA_DIR:-$PWD/../shared/data} TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp

more() {  # preset, times the samples, program, filter
  flock build/long cmake --preset "$1"  # parts that run side by side build one after the other
  flock build/long cmake --build --preset "$1" --target "$3" -- -j"$jobs"
  IST_EFFORT=$2 "build/$1/tests/$3" --gtest_brief=0 --gtest_filter="$4"
  grep -q 'Running [1-9]' "$log"
  ! grep -q '^\[  SKIPPED \]' "$log" || return 77
}

built() {  # the preset `test` of this commit, and then a command that tries it
  cmake --preset test
  cmake --build --preset test -- -j"$jobs"
  "$@"
}
with_page() {
  scripts/viewer.sh
  built "$@"
}

benches() {  # which nothing else compiles
  scripts/setup.sh --peers
  cmake --preset bench -DIST_WERROR=ON
  cmake --build --preset bench -- -j"$jobs"
}
release() {  # made of the commit, twice
  rm -rf build/tried build/tried-draft
  scripts/release.sh --despite-figures --out build/tried
}
as_users_build="base_test mesh_test tree_test query_test search_test"
installed() { scripts/setup.sh --oracles --python --sweep --docs --cross --viewer --hardware --package --cloudcompare --blender --slurm --doors; }

$list || installed >build/long/setup.log 2>&1 || { cat build/long/setup.log; exit 1; }
alone suite scripts/test.sh
alone as-users-build run "release -DIST_TESTS=ON" "$as_users_build" -L "^(${as_users_build// /|})$" -E 'RealPairs\.HaveTheTriangles'
alone packages with_page ctest --preset test -L '^long$'
alone benches benches
alone golden scripts/golden_table.py --check
alone arm64 scripts/arm64_package.sh
alone portable run "python -DIST_GOLDEN=ON" "ist_shared golden_test"
# The sanitizers themselves allocate, where a thread begins, call the system, and take terabytes of addresses.
alone sanitize-all run sanitize-all all -E '^(House|Figures|Report|HardwareReport|MutantsStillApply|BenchCompare|LongRuns|Doors|Release)$|^(Package|Docs|Viewer|Allocations|SystemCalls)\.|MakesNoSystemCall$|^Faults\.MemoryThatEndsIsNamedWithTheRemedy$'
alone compile-all with_page env IST_COMPILE_ALL=1 ctest --preset test -R '^(Package\.Subdirectory|Python\.Sdist)$'
for jaws in built-in human; do
  alone cloudcompare-$jaws built /usr/bin/python3 -B tests/cli/occlusion/distances_by_cloudcompare.py "$jaws" build/test/ist "build/test/cloudcompare-$jaws"
done
alone blender built /usr/bin/python3 -B tests/python/recipes/blender_itself.py build/test/src/package/libist.so
alone threads more thread 100 search_test 'SharedTreeThread.*'
alone stability scripts/stability_report.sh --out build/long/stability
alone kills more test 17 cli_test 'SweepCommand.Kills*'
aside pressing more test 600 haptics_test 'LongPressing.*'
aside coherent more test 11 coherent_test 'Policies/CoherentQuery*:CoherentQueryOfScans*'
aside five-bodies more test 50 haptics_test 'AmongFiveBodies.PressesGiveNoEnergyBack'
settle 0
alone release release
for door in scans haptics script cycles; do
  also[doors-$door]=$pages
  alone doors-$door tests/doors/$door.sh
done
for round in 1 2 3 4 5 6; do alone fuzz-$round scripts/fuzz.sh --seconds 300; done

end_parts
