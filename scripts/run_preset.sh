#!/usr/bin/env bash
# For bash to source: how a test script builds a preset and runs its tests.

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
