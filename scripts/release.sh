#!/usr/bin/env bash
# Makes the folder of a release from the last commit: an archive of the sources, Debian packages, the wheel and the sdist of the Python package,
# the page, the site of the documents, THIRD_PARTY with the notices of others, and SHA256SUMS. All files are built from that archive,
# twice, in different folders. If a byte differs, the script names the file and makes nothing.
#
#   scripts/release.sh                     into build/ist-VERSION
#   scripts/release.sh --out FOLDER        into another folder, which does not exist yet
#   scripts/release.sh --once              a draft, in FOLDER-draft: built once, in half the time, so nothing shows that another build has the same bytes
#   scripts/release.sh --despite-figures   a draft, too: made even if figures are older than their code, or a long test has not passed at the commit
#                                          (scripts/check_figures.sh, scripts/test.sh --left)
#   scripts/release.sh -DIST_MAINTAINER='Name <address>' -DIST_HOMEPAGE=https://…
#                                          the contact of the packages; without them "IST developers", and no page
#
# Exit codes: 1 if a part is stale, missing or different, 2 for a wrong option.
set -euo pipefail
cd "$(dirname "$0")/.."
say() { echo "release: $*"; }
fail() { echo "release: $*" >&2; exit 1; }

out='' twice=true despite=false contact=()
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:?release: --out needs a folder}; shift ;;
    --once) twice=false ;;
    --despite-figures) despite=true ;;
    -DIST_MAINTAINER=?* | -DIST_HOMEPAGE=?*) contact+=("$1") ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "release: unknown option $1; see --help" >&2; exit 2 ;;
  esac
  shift
done

top=$(git rev-parse --show-toplevel 2>/dev/null) || top=''
[ "$top" = "$(pwd -P)" ] || fail "this folder is no git checkout, and a release is made of a commit: clone the repository"
changed=$(git status --porcelain)
[ -z "$changed" ] || fail "the working tree differs from its commit: commit, or remove"$'\n'"$changed"
version=$(scripts/version.sh)
name=ist-$version
out=${out:-build/$name}
if $despite || ! $twice; then out=${out%-draft}-draft; fi
[ ! -e "$out" ] || fail "$out is there already: remove it, or name another folder by --out"

say "ist $version of commit $(git log -1 --format='%h, %cs') into $out"
[[ ${contact[*]} == *IST_MAINTAINER=* ]] || say 'IST_MAINTAINER is unset: the packages say "IST developers"'
[[ ${contact[*]} == *IST_HOMEPAGE=* ]] || say "IST_HOMEPAGE is unset: the packages name no page"
stale=''
for check in "check_figures.sh" "test.sh --left"; do
  # shellcheck disable=SC2086  # words
  said=$(scripts/$check 2>&1) || stale+=$said$'\n'
done
if [ -n "$stale" ]; then
  printf '%s' "$stale" >&2
  $despite || fail "figures are older than their code, or long tests have not passed: make these anew, or a draft by --despite-figures"
  say "figures are older than their code, or long tests have not passed: this is a draft"
fi
scripts/setup.sh --viewer --python --docs --package

work=$(mktemp -d)
whole=''
keep() {
  [ $? -ne 0 ] || return 0
  [ -z "$whole" ] || rm -rf "$whole"
  echo "release: what was made so far is in $work" >&2
}
trap keep EXIT
umask 022
# Settings of a user for other builds would become part of the release.
unset CC CXX CFLAGS CXXFLAGS CPPFLAGS LDFLAGS CPATH C_INCLUDE_PATH CPLUS_INCLUDE_PATH LIBRARY_PATH CMAKE_GENERATOR CMAKE_BUILD_TYPE CMAKE_CXX_COMPILER_LAUNCHER CMAKE_C_COMPILER_LAUNCHER
# With a cache of objects, the second build would take objects of the first one.
export CCACHE_DISABLE=1 LC_ALL=C.UTF-8 TZ=UTC
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
git -c tar.umask=0022 archive --prefix="$name/" HEAD | gzip -9n >"$work/$name-source.tar.gz"

build() {  # a folder of its own
  local folder=$work/$1 begin=$SECONDS
  say "builds $1 (log: $work/$1.log)"
  mkdir "$folder"
  tar -xzf "$work/$name-source.tar.gz" -C "$folder"
  mkdir "$work/made-$1"
  cp "$work/$name-source.tar.gz" "$work/made-$1"
  (cd "$folder/$name" && scripts/release/build.sh "$work/made-$1" "${contact[@]}") >"$work/$1.log" 2>&1 ||
    { tail -n 40 "$work/$1.log" >&2; fail "the build $1 failed"; }
  rm -rf "$folder"
  say "built $1 in $(((SECONDS - begin + 59) / 60)) minutes"
}
build first
if $twice; then
  build second-in-another-folder
  if ! different=$(diff -rq "$work/made-first" "$work/made-second-in-another-folder"); then
    fail "the second build has other bytes:"$'\n'"${different//$work\//}"
  fi
  say "both builds have the same bytes"
else
  say "built once: that another build has the same bytes is not shown, so this is a draft"
fi

cd "$work/made-first"
find . -type f -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' sha256sum >"$work/SHA256SUMS"
mv "$work/SHA256SUMS" .
cd - >/dev/null
mkdir -p "$(dirname "$out")"
whole=$(mktemp -d "$out.XXXXXX")
chmod 755 "$whole"
cp -r "$work/made-first/." "$whole"
mv -T "$whole" "$out"
rm -rf "$work"
say "$out has"
cat "$out/SHA256SUMS"
