#!/usr/bin/env bash
# Sets up this machine, builds, and runs tests.
#
#   scripts/test.sh            the fast tests, with a fifth of the random samples: 10 minutes on two cores from nothing
#   scripts/test.sh --all      the rest that a landing needs: threads under ThreadSanitizer; readers and vector code
#                              under AddressSanitizer and UndefinedBehaviorSanitizer; golden answers in WebAssembly; the
#                              page; packages; other tools as oracles; and every test with all its samples
#   scripts/test.sh LABEL      the tests of one label: fast slow oracle page package long sanitize thread
#   scripts/test.sh --long [WORD …]   hours of more: the tests labelled long whose names contain one of the words. A test that
#                              passed at this commit, with nothing changed beside it, is not run again: build/long has the stamps
#   scripts/test.sh --left     names the long tests that have not passed at this commit, and ends with 1 if there are any
#
#   IST_DATA_DIR=FOLDER    the folder of real meshes; ../shared/data if it is not set
#   IST_EFFORT=FACTOR      the share of random samples; 0.2 for the fast tests and under sanitizers, else 1
#   IST_REQUIRE_ALL=1      a test that would be skipped fails
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)
export IST_DATA_DIR=${IST_DATA_DIR:-$PWD/../shared/data}
few=${IST_EFFORT:-0.2} all=${IST_EFFORT:-1}
what=${1:-fast}
[ $# -le 1 ] || [[ $what == --long || $what == --part ]] || { echo "test: one word at a time, and \"$2\" is a second one: call the script once for each label" >&2; exit 2; }

part() { echo "== $1 (after $SECONDS s)"; }

configure() {  # a preset and its options
  mkdir -p build
  cmake --preset "$@" >build/configure.log 2>&1 || { cat build/configure.log; exit 1; }
}

build() {  # a preset and its targets; ninja's progress shows on a terminal
  local preset=$1
  shift
  part "building $preset"
  if [ -t 1 ]; then
    cmake --build --preset "$preset" --target "$@" -- -j"$jobs"
    return
  fi
  echo "the log of the build is build/$preset.log"
  if ! cmake --build --preset "$preset" --target "$@" -- -j"$jobs" >"build/$preset.log" 2>&1; then
    cat "build/$preset.log"
    exit 1
  fi
}

tests() {  # a preset for ctest, and its arguments
  part "tests of $1"
  ctest --preset "$@" -j"$jobs" | grep --line-buffered -vE '^ *Start +[0-9]+:'
}

run() {  # a preset and its options, targets to build, then arguments for ctest
  # shellcheck disable=SC2206  # words
  local options=($1) targets=($2)
  shift 2
  part "preset ${options[*]}"
  configure "${options[@]}"
  build "${options[0]}" "${targets[@]}"
  tests "${options[0]}" "$@"
}

# A build with every instruction set serves the fast tests too, and stays.
instruction_sets() { grep -qs '^IST_FEW_TARGETS:BOOL=OFF' build/test/CMakeCache.txt && echo OFF || echo ON; }

count() {  # of the tests with a label that are not fast
  ctest --test-dir build/test -N -L "^$1$" -LE '^fast$' | sed -n 's/^Total Tests: //p'
}

fast() {
  scripts/setup.sh --tests
  part "fast tests"
  configure test "-DIST_FEW_TARGETS=$(instruction_sets)"
  build test tests_fast
  echo "left out, and run by scripts/test.sh --all: four fifths of the random samples; sanitizers; WebAssembly;" \
    "$(count slow) slow, $(count oracle) oracle, $(count page) page and $(count package) package tests;" \
    "$(grep -rh '^  IST_SLOW();' tests | wc -l) slow cases"
  [ -d "$IST_DATA_DIR" ] || echo "left out: tests of real meshes, because there is no folder $IST_DATA_DIR (IST_DATA_DIR)"
  echo "left out: $(count long) long tests; scripts/test.sh --long runs them"
  IST_EFFORT=$few tests fast
}

threads() {  # file by file, because builds of several files as one hide a missing include
  IST_EFFORT=$few run "thread -DIST_UNITY=OFF" tests_thread -L '^thread$'
}

sanitize() { IST_EFFORT=$few run sanitize tests_sanitize -L '^sanitize$'; }

page() { part "the page"; scripts/viewer.sh; }

labelled() {  # the rest of the test preset: arguments for ctest
  part "preset test"
  configure test -DIST_FEW_TARGETS=OFF
  build test all
  IST_EFFORT=$all tests "$@"
}

named() {  # the long tests whose names contain one of the words
  ctest --test-dir build/test -N -L '^long$' -R "$(IFS='|'; echo "$*")" | sed -nE 's/^ *Test +#[0-9]+: //p'
}

left() {  # the names of these that have not passed at the commit; changes beside it void every stamp
  for name in "$@"; do [ -n "$commit" ] && grep -qsx "$commit" "build/long/$name.passed" || echo "$name"; done
}

long() {
  local names line
  commit=$(git rev-parse HEAD)
  [ -z "$(git status --porcelain)" ] || commit=''
  configure test -DIST_FEW_TARGETS=OFF
  mapfile -t names < <(named "${@:-.}")
  [ ${#names[@]} -gt 0 ] || { echo "test: no long test has one of these words in its name: $*" >&2; exit 2; }
  mapfile -t names < <(left "${names[@]}")
  part "long tests that have not passed at this commit: ${#names[@]}"
  [ ${#names[@]} -gt 0 ] || return 0
  printf '%s\n' "${names[@]}"
  [ "$what" != --left ] || exit 1
  scripts/setup.sh --all --lint --cross --cloudcompare --blender --slurm --doors
  page
  build test all
  mkdir -p build/long
  export IST_COMPILE_ALL=1 IST_EFFORT=$all
  tests test -R "^($(IFS='|'; echo "${names[*]//./\\.}"))\$" | while IFS= read -r line; do
    echo "$line"
    if [[ -n $commit && $line =~ Test\ +\#[0-9]+:\ ([^ ]+)\ .*\ Passed\  ]]; then echo "$commit" >"build/long/${BASH_REMATCH[1]}.passed"; fi
  done
}

long_part() {  # a long test that needs more than one command
  case $1 in
    samples) for program in build/test/tests/*_test; do [[ $program == */ist_c11_test ]] || IST_EFFORT=20 "$program" --gtest_brief=1; done ;;
    as-users-build) run "release -DIST_TESTS=ON" "base_test mesh_test tree_test query_test search_test" -R '^(base|mesh|tree|query|search)_test' ;;
    benches) scripts/setup.sh --peers; configure bench -DIST_WERROR=ON; build bench all ;;
    portable) run "python -DIST_GOLDEN=ON" "ist_loop_shared golden_test" ;;
    sanitize-all) run sanitize-all tests_fast -L '^fast$' ;;
    threads)
      configure thread
      build thread search_test
      IST_EFFORT=100 TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp build/thread/tests/search_test --gtest_filter='SharedTreeThread.*' ;;
    release) rm -rf build/tried build/tried-draft; scripts/release.sh --despite-figures --out build/tried ;;
    *) echo "test: there is no part \"$1\"" >&2; exit 2 ;;
  esac
}

case $what in
  fast) fast ;;
  thread) scripts/setup.sh --tests; threads ;;
  sanitize) scripts/setup.sh --tests; sanitize ;;
  page) scripts/setup.sh --tests --viewer; page; labelled test -L '^page$' ;;
  slow | oracle | package) scripts/setup.sh --all; labelled test -L "^$what\$" ;;
  --all)
    scripts/setup.sh --all
    threads
    sanitize
    run "wasm -DIST_WERROR=ON -DIST_WITH_LOOP=OFF" golden_test
    page
    labelled all
    ;;
  long | --long | --left) long "${@:2}" ;;
  --part) long_part "$2" ;;
  -h | --help) sed -n '2,17s/^# \{0,1\}//p' "$0" ;;
  *) echo "test: there is no label or option \"$what\": take fast, slow, oracle, page, package, long, sanitize, thread, --all or --long" >&2; exit 2 ;;
esac
