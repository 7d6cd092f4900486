#!/usr/bin/env bash
# Makes the wheel and the sdist of the Python package; scripts/setup.sh --python installs the tools.
#
#   scripts/python_packages.sh                        into build/python
#   scripts/python_packages.sh --build FOLDER [-D…]   into another build folder, with options for CMake
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/python
case ${1:-} in
  "") ;;
  --build) build=${2:?--build needs a folder}; shift 2 ;;
  -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "python_packages: unknown option $1; see --help" >&2; exit 2 ;;
esac
if ! /usr/bin/python3 -c 'import build, setuptools, wheel' 2>/dev/null; then
  echo "python_packages: python3-build, python3-setuptools or python3-wheel is missing: run scripts/setup.sh --python" >&2
  exit 1
fi
mkdir -p "$build"
build=$(cd "$build" && pwd)
echo "python_packages: builds the library and both packages, up to 10 minutes; the logs are $build/{configure,build,packages}.log" >&2
cmake --preset python -B "$build" "$@" >"$build/configure.log" || { cat "$build/configure.log"; exit 1; }
cmake --build "$build" --target ist_loop_shared >"$build/build.log" || { cat "$build/build.log"; exit 1; }

# In a copy, for setuptools writes beside the modules. The wheel is made from the sdist.
rm -rf "$build/source" "$build"/ist-*.whl "$build"/ist-*.tar.gz
mkdir "$build/source"
cp -r src/python/{pyproject.toml,setup.py,MANIFEST.in,README.md,ist} "$build/source"
sed -i "/^dynamic = /r $build/contact.toml" "$build/source/pyproject.toml"
SOURCE_DATE_EPOCH=$(cmake -P src/package/commit.cmake)
export SOURCE_DATE_EPOCH
IST_PYTHON_LIBRARY=$build/src/package/libist_loop.so.0 \
  /usr/bin/python3 -m build --no-isolation --outdir "$build" "$build/source" >"$build/packages.log" 2>&1 ||
  { cat "$build/packages.log"; exit 1; }
ls -1 "$build"/ist-*.whl "$build"/ist-*.tar.gz
