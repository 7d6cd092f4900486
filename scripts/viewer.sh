#!/usr/bin/env bash
# Makes the page: one HTML file with the engine in it, which opens from a disk or a mail, without a
# server: build/viewer/ist.html. The engine is WebAssembly, in build/wasm/viewer.
#
#   scripts/viewer.sh
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "viewer: unknown option $1; see --help" >&2; exit 2 ;;
esac
scripts/setup.sh --viewer
mkdir -p build/viewer
log=build/viewer/build.log
logged() { "$@" >"$log" 2>&1 || { cat "$log"; exit 1; }; }
logged cmake --preset wasm -DIST_WITH_LOOP=OFF
logged cmake --build --preset wasm --target ist_page_engine -- -j"$(nproc)"
# Packages by their lock file, in build/ and not among the sources; once all of them are there.
packages=build/viewer/packages
if ! cmp -s src/viewer/package-lock.json "$packages/installed"; then
  mkdir -p "$packages"
  cp src/viewer/package.json src/viewer/package-lock.json "$packages"
  npm ci --prefix "$packages" --no-audit --no-fund >"$log" 2>&1 ||
    { echo "viewer: npm ci failed ($(grep -m 1 'npm ERR\|npm error' "$log")): check the network, and run this again; see $log" >&2; exit 1; }
  cp src/viewer/package-lock.json "$packages/installed"
fi
ln -sfn "$PWD/$packages/node_modules" src/viewer/node_modules
logged node src/viewer/node_modules/typescript/bin/tsc -p src/viewer
node src/viewer/bundle.mjs --engine build/wasm/viewer --output build/viewer/ist.html --bundled build/viewer/bundled.json
echo "viewer: open build/viewer/ist.html"
