#!/usr/bin/env bash
# Makes the reference of the public headers: FOLDER/reference/html. Fails at doxygen's warnings.
#
#   reference.sh FOLDER
#
# Without doxygen the exit code is 77; with IST_REQUIRE_ALL=1 it is 1.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v doxygen >/dev/null; then
  echo "reference: skipped: doxygen is not installed: scripts/setup.sh --docs does that" >&2
  [ "${IST_REQUIRE_ALL:-}" = 1 ] && exit 1
  exit 77
fi
out=$1/reference
rm -rf "$out"
mkdir -p "$out"
mapfile -t headers < <(sed -n 's|^ist/|src/&|p' src/package/public_headers.txt)
version=$(scripts/version.sh)
{
  cat scripts/site/Doxyfile
  echo "INPUT = ${headers[*]} src/hardware/include scripts/site/reference.dox"
  echo "OUTPUT_DIRECTORY = \"$out\""
  echo "PROJECT_NUMBER = $version"
} | doxygen -
echo "reference: ${#headers[@]} headers and the circuit's, without a warning"
