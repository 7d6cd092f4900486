#!/usr/bin/env bash
# Makes the Debian packages for ARM64 on another machine, builds a user's program with them, and runs it by qemu.
#
#   scripts/arm64_package.sh      needs scripts/setup.sh --cross --package
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '2,4s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "arm64_package: unknown option $1; see --help" >&2; exit 2 ;;
esac
build=$PWD/build/arm64-package
root=$build/root
toolchain=$PWD/scripts/toolchains/arm64.cmake
cmake -G Ninja -S . -B "$build" --toolchain "$toolchain" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr \
  -DIST_TESTS=OFF -DIST_CLI=OFF >/dev/null
cmake --build "$build" -- -j"$(nproc)" >"$build/build.log" || { cat "$build/build.log"; exit 1; }
(cd "$build" && cpack >cpack.log 2>&1) || { cat "$build/cpack.log"; exit 1; }
rm -rf "$root"
for package in "$build"/*_arm64.deb; do
  echo "$(dpkg-deb -f "$package" Package Architecture | tr '\n' ' ')"
  dpkg-deb -x "$package" "$root"
done
cmake -G Ninja -S tests/package/consumer -B "$build/consumer" --toolchain "$toolchain" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$root/usr" >/dev/null
cmake --build "$build/consumer" >"$build/consumer.log" || { cat "$build/consumer.log"; exit 1; }
on_arm64() { qemu-aarch64 -E LD_LIBRARY_PATH="$root/usr/lib/aarch64-linux-gnu" "$@"; }
file -b "$build/consumer/consumer" | cut -d, -f1,2
on_arm64 "$build/consumer/consumer" "$build/consumer/tree.ist"  # writes the tree and reads it
on_arm64 "$build/consumer/hardware"
