#!/usr/bin/env bash
# For bash to source: how a test script builds a preset and runs its tests.

jobs=$(nproc)

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
  local options=($1) targets=($2)
  shift 2
  part "preset ${options[*]}"
  configure "${options[@]}"
  build "${options[0]}" "${targets[@]}"
  tests "${options[0]}" "$@"
}
