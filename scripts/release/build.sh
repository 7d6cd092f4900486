#!/usr/bin/env bash
# Builds a release from the sources around this script, which release.sh has unpacked, and puts it into a folder.
#
#   build.sh FOLDER [-D…]     with options for CMake
set -euo pipefail
cd "$(dirname "$0")/../.."
out=$1
shift
SOURCE_DATE_EPOCH=$(cmake -P src/package/commit.cmake)
export SOURCE_DATE_EPOCH
version=$(scripts/version.sh)
part() { echo "== $1 (after $SECONDS s)"; }

cmake --preset release "$@"  # first, because it names missing packages

part "the page"
scripts/viewer.sh
cp build/viewer/ist.html "$out/ist-$version-page.html"

part "packages"  # with the page in them
cmake --build --preset release
(cd build/release && cpack)
cp build/release/*.deb "$out"

part "the Python package"
scripts/python_packages.sh --build build/python "$@"
mkdir "$out/python"
cp build/python/ist-*.whl build/python/ist-*.tar.gz "$out/python"

part "the site"
scripts/docs.sh
tar --create --directory build/docs --transform "s|^site|ist-$version-site|" --sort=name --owner=0 --group=0 --numeric-owner \
  --mtime="@$SOURCE_DATE_EPOCH" --mode=go=rX,u+rw --format=gnu site | gzip -9n >"$out/ist-$version-site.tar.gz"

part "notices"
/usr/bin/python3 -B scripts/release/third_party.py "$out/THIRD_PARTY"
