#!/usr/bin/env bash
# Makes one static site of README, docs and the other pages, and of every public header: build/docs/site. It loads nothing from
# elsewhere, and can be put on any server.
#
#   scripts/docs.sh
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  "") ;;
  -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
  *) echo "docs: unknown option $1; see --help" >&2; exit 2 ;;
esac
scripts/setup.sh --docs
scripts/site/reference.sh "$PWD/build/docs"
/usr/bin/python3 -B scripts/site/pages.py build/docs
echo "docs: open build/docs/site/index.html"
echo "docs: to search the pages too: python3 -m http.server --directory build/docs/site, then http://localhost:8000"
