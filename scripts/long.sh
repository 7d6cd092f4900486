#!/usr/bin/env bash
# Runs hours of tests, part by part. Parts that use one core run side by side.
#
#   suite            scripts/test.sh and scripts/test.sh --all
#   samples          each test program with 20 times the random samples
#   packages         the tests labelled long: packages, manual pages, wheels, the page in a browser, pictures
#   as-users-build   five programs, compiled file by file without assertions, as users compile the library
#   benches, portable, compile-all, release     builds that no test makes
#   clang-tidy       the checks of .clang-tidy on the library and the command
#   golden, arm64    golden answers by more compilers, optimisations and platforms
#   sanitize-all     every test program under AddressSanitizer and UndefinedBehaviorSanitizer
#   threads, kills, pressing, coherent, five-bodies, stability     hard cases with more samples still
#   cloudcompare, blender, doors                what other programs and new users do with it
#   mutants          scripts/mutate.sh: the tests notice deliberate faults
#   fuzz-1 to 6      each fuzzer for 5 minutes, six times
#
#   scripts/long.sh                 every part anew
#   scripts/long.sh --resume        the parts that do not count at this commit
#   scripts/long.sh PART ...        these; a word stands for all parts that begin with it
#   scripts/long.sh --list          which parts count at this commit
#
# A part keeps its log, build/long/PART.log. Its last line is a stamp: passed or failed, the commit, the day and the time it
# took. A part with uncommitted changes does not count. A part counts until something other than docs/, perf/ and pages
# changes; a door also rests on the pages. A skipped test counts as skipped, or as failed with IST_REQUIRE_ALL=1. If a part
# fails, the others still run, and the exit code is 1. scripts/long_table.py writes the results to docs/guarantees.md.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  -h | --help) sed -n '2,27s/^# \{0,1\}//p' "$0"; exit 0 ;;
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
samples() {
  local program
  for program in build/test/tests/*_test; do
    [[ $program == */ist_c11_test ]] || IST_EFFORT=20 "$program" --gtest_brief=1
  done
}
suite() {
  scripts/test.sh
  scripts/test.sh --all
}
as_users_build="base_test mesh_test tree_test query_test search_test"
installed() { scripts/setup.sh --all --lint --cross --cloudcompare --blender --slurm --doors; }

$list || "$0" --list "${chosen[@]}" >/dev/null  # refuses unknown words before hours of work
$list || installed >build/long/setup.log 2>&1 || { cat build/long/setup.log; exit 1; }
alone suite suite
alone samples built samples
alone as-users-build run "release -DIST_TESTS=ON" "$as_users_build" -R "^(${as_users_build// /|})"
alone packages with_page ctest --preset test -L '^long$'
alone benches benches
alone clang-tidy scripts/lint.sh clang-tidy
alone golden scripts/golden_table.py --check
alone arm64 scripts/arm64_package.sh
alone portable run "python -DIST_GOLDEN=ON" "ist_shared golden_test"
alone sanitize-all run sanitize-all tests_fast -L '^fast$'
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
alone mutants scripts/mutate.sh --missing
for door in scans haptics script cycles; do
  also[doors-$door]=$pages
  alone doors-$door tests/doors/$door.sh
done
for round in 1 2 3 4 5 6; do alone fuzz-$round scripts/fuzz.sh --seconds 300; done

end_parts
