#!/usr/bin/env bash
# Lets programs of others read tables, by node.
#
#   run.sh TEST.mjs ...
#
# Ends with 77, which ctest takes for skipped, where the programs are not installed, and with 1 where
# IST_REQUIRE_ALL=1.
set -euo pipefail
cd "$(dirname "$0")"
missing() {
  echo "$1: run scripts/sweep_readers.sh"
  [ "${IST_REQUIRE_ALL:-}" != 1 ] || exit 1
  exit 77
}
command -v node >/dev/null || missing "node is not installed"
[ -e node_modules/hyparquet ] && [ -e node_modules/@duckdb/node-api ] || missing "the readers are not installed"
cmp -s readers/package-lock.json ../../build/sweep_readers/package-lock.json || missing "the readers are of another version"
exec node --test "$@"
