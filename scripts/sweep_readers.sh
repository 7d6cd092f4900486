#!/usr/bin/env bash
# Installs what reads the tables of IST again in tests/engines: hyparquet and DuckDB for node, by
# their lock file, into build/sweep_readers, 70 MB.
#
#   scripts/sweep_readers.sh
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "sweep_readers: unknown option $1; see --help" >&2; exit 2 ;;
esac
for tool in node npm; do
  command -v $tool >/dev/null || { echo "sweep_readers: $tool is not installed: scripts/setup.sh --viewer does that" >&2; exit 1; }
done
sources=tests/engines/readers packages=build/sweep_readers
if ! cmp -s $sources/package-lock.json $packages/package-lock.json; then
  mkdir -p $packages
  cp $sources/package.json $sources/package-lock.json $packages
  npm ci --prefix $packages --no-audit --no-fund >$packages/install.log 2>&1 ||
    { rm $packages/package-lock.json
      echo "sweep_readers: npm ci failed ($(grep -m 1 'npm ERR\|npm error' $packages/install.log)): check the network, and run this again; see $packages/install.log" >&2
      exit 1; }
fi
ln -sfn "$PWD/$packages/node_modules" tests/engines/node_modules
echo "sweep_readers: everything is installed"
