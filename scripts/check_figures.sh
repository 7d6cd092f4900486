#!/usr/bin/env bash
# Names the figures that are older than their code: for each stamp on a page of results, the sources that have changed since its commit.
# Comments do not count. The exit code is 1 if there are such figures.
#
#   scripts/check_figures.sh            every page
#   scripts/check_figures.sh PAGE …     some: README.md, docs/performance.md, perf/REPORT.md, …
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
PYTHONPATH=scripts exec python3 -B -m report.figures "$@"
