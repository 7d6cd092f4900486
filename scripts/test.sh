#!/usr/bin/env bash
# Sets up, builds, and runs every test: optimised with assertions, then what has threads under
# ThreadSanitizer, then all under AddressSanitizer and UndefinedBehaviorSanitizer.
#
#   IST_DATA_DIR=FOLDER    where the real meshes are; by default ../shared/data
#   IST_REQUIRE_ALL=1      a test that would be skipped fails
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
jobs=$(nproc)

run() {  # preset, then arguments for ctest
  local preset=$1
  shift
  echo "== preset $preset"
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -- -j"$jobs" | tail -n 1
  ctest --preset "$preset" -j"$jobs" --progress "$@"
}

run thread -L threads
run sanitize -LE real-data
run test
