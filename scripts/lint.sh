#!/usr/bin/env bash
# Checks the style of the code by the settings at the root that editors read too: .clang-format, .flake8 and
# .prettierrc.json; and by .clang-tidy, which takes over 20 minutes on two cores.
#
#   scripts/lint.sh                    all but clang-tidy, on every file
#   scripts/lint.sh TOOL [FILE ...]    clang-format, flake8, prettier or clang-tidy, on these files, or on every file
#
# scripts/setup.sh --lint installs the tools. prettier comes with the page's packages: scripts/viewer.sh.
set -euo pipefail
cd "$(dirname "$0")/.."

missing() { echo "lint: $1 is not installed: run $2" >&2; exit 77; }

tracked() { git ls-files --cached --others --exclude-standard -- "$@"; }

lint() {
  local tool=$1 files=("${@:2}")
  case $tool in
    clang-format)
      command -v clang-format >/dev/null || missing clang-format "scripts/setup.sh --style"
      [ ${#files[@]} -gt 0 ] || mapfile -t files < <(tracked '*.h' '*.cpp' '*.c')
      clang-format --dry-run -Werror "${files[@]}"
      ;;
    flake8)
      command -v flake8 >/dev/null || missing flake8 "scripts/setup.sh --style"
      [ ${#files[@]} -gt 0 ] || mapfile -t files < <(tracked '*.py')
      flake8 "${files[@]}"
      ;;
    prettier)
      local prettier=build/viewer/packages/node_modules/.bin/prettier
      [ -x $prettier ] || missing prettier scripts/viewer.sh
      [ ${#files[@]} -gt 0 ] || mapfile -t files < <(tracked '*.js' '*.mjs')
      $prettier --check --log-level warn "${files[@]}"
      ;;
    clang-tidy)
      command -v run-clang-tidy-14 >/dev/null || missing clang-tidy "scripts/setup.sh --lint"
      # clang reads commands for clang, one a file.
      cmake --preset clang14 -B build/tidy -DIST_CLI=ON -DIST_UNITY=OFF -DIST_CLI_UNITY=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
      cmake --build build/tidy --target ist_commit
      run-clang-tidy-14 -quiet -p build/tidy -j"$(nproc)" "${files[@]}"
      ;;
    -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "lint: there is no tool \"$tool\": take clang-format, flake8, prettier or clang-tidy" >&2; exit 2 ;;
  esac
}

if [ $# -gt 0 ]; then
  lint "$@"
else
  for each in clang-format flake8 prettier; do lint "$each"; done
fi
