#!/usr/bin/env bash
# Sets up, builds, and runs every test: optimised with assertions, then what has threads under
# ThreadSanitizer, then what reads files and what runs in vectors under AddressSanitizer and
# UndefinedBehaviorSanitizer.
#
#   IST_DATA_DIR=FOLDER    where the real meshes are; by default ../shared/data
#   IST_REQUIRE_ALL=1      a test that would be skipped fails
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
jobs=$(nproc)

run() {  # preset, targets to build, then arguments for ctest
  local preset=$1 targets=$2
  shift 2
  echo "== preset $preset"
  cmake --preset "$preset" >/dev/null
  # shellcheck disable=SC2086  # targets are words
  if ! cmake --build --preset "$preset" --target $targets -- -j"$jobs" >"build/$preset.log"; then
    cat "build/$preset.log"
    exit 1
  fi
  ctest --preset "$preset" -j"$jobs" "$@" | grep -vE '^ *Start +[0-9]+:'
}

run thread "base_test tree_test search_test workers_test" -R 'Thread|Parallel'
run sanitize "mesh_test tree_test search_test" -E '_NOT_BUILT|/(avx2|ssse3)$|Saved$|OfAnIcosphere|Thread\.|Golden\.|NearTouching/(simple|tight)$|MoreContactsThan|House'
run test all
