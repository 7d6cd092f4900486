#!/usr/bin/env bash
# Sets up this machine, builds, and runs tests.
#
#   scripts/test.sh            the fast tests, with a fifth of the random samples: 10 minutes on two cores from nothing
#   scripts/test.sh --all      the rest that a landing needs: threads under ThreadSanitizer; readers and vector code
#                              under AddressSanitizer and UndefinedBehaviorSanitizer; golden answers in WebAssembly; the
#                              page; packages; other tools as oracles; and every test with all its samples
#   scripts/test.sh LABEL      the tests of one label: fast slow oracle page package long sanitize thread
#   scripts/test.sh --long     hours of more, in parts: scripts/long.sh, which takes the words after --long
#
#   IST_DATA_DIR=FOLDER    the folder of real meshes; ../shared/data if it is not set
#   IST_EFFORT=FACTOR      the share of random samples; 0.2 for the fast tests and under sanitizers, else 1
#   IST_REQUIRE_ALL=1      a test that would be skipped fails
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/run_preset.sh
export IST_DATA_DIR=${IST_DATA_DIR:-$PWD/../shared/data}
few=${IST_EFFORT:-0.2} all=${IST_EFFORT:-1}
what=${1:-fast}
[ $# -le 1 ] || [ "$what" = --long ] || { echo "test: one word at a time, and \"$2\" is a second one: call the script once for each label" >&2; exit 2; }

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

golden() { run "wasm -DIST_WERROR=ON -DIST_WITH_LOOP=OFF" golden_test; }

page() {
  part "the page"
  scripts/viewer.sh
}

labelled() {  # the rest of the test preset: arguments for ctest
  part "preset test"
  configure test -DIST_FEW_TARGETS=OFF
  build test all
  IST_EFFORT=$all tests "$@"
}

case $what in
  fast) fast ;;
  thread) scripts/setup.sh --tests; threads ;;
  sanitize) scripts/setup.sh --tests; sanitize ;;
  page) scripts/setup.sh --tests --viewer; page; labelled test -L '^page$' ;;
  slow | oracle | package) scripts/setup.sh --all; labelled test -L "^$what\$" ;;
  long) scripts/setup.sh --all; page; labelled test -L '^long$' ;;
  --all)
    scripts/setup.sh --all
    threads
    sanitize
    golden
    page
    labelled all
    ;;
  --long) shift; exec scripts/long.sh "$@" ;;
  -h | --help) sed -n '2,15s/^# \{0,1\}//p' "$0" ;;
  *) echo "test: there is no label or option \"$what\": take fast, slow, oracle, page, package, long, sanitize, thread, --all or --long" >&2; exit 2 ;;
esac
