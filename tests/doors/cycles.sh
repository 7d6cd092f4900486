#!/usr/bin/env bash
# I count cycles: from a clone to `ist bench`, a kernel that is changed and seen, and FCL and Embree beside it.
#
#   cycles.sh [--without-root] [--keep]
#
# It builds the commit that is checked out, three times: 40 minutes on two cores. Where CMAKE_CXX_COMPILER_LAUNCHER is ccache
# in the environment the root has it too, with the same cache. --keep leaves the root as the door left it.
# shellcheck source=tests/doors/door.sh
source "$(dirname "$0")/door.sh"
door cycles "$@"
needs_here git g++ cmake ninja

cloned() {
  [ -z "$(git -C "$source" status --porcelain)" ] || echo "what is not committed is not in the clone"
  git clone --quiet --no-hardlinks "$source" "$walk/ist"
  git -C "$walk/ist" log -1 --format='%h %s'
}
step "a clone" cloned
installs "git, which a clone is made by" "apt-get install git"
if [ "$(basename "${CMAKE_CXX_COMPILER_LAUNCHER:-}")" = ccache ]; then
  echo "   with ccache: what is built takes less time than a first user's" | tee -a "$log"
  installs "ccache" "apt-get install ccache"
  CCACHE_BASEDIR=/root/walk
  [ "$way" = root ] || CCACHE_BASEDIR=$walk
  export CCACHE_BASEDIR CCACHE_NOHASHDIR=1 CCACHE_DIR=${CCACHE_DIR:-$HOME/.ccache}
  passed+=(CMAKE_C_COMPILER_LAUNCHER CMAKE_CXX_COMPILER_LAUNCHER CCACHE_BASEDIR CCACHE_NOHASHDIR CCACHE_SLOPPINESS CCACHE_DIR)
  if [ "$way" = root ]; then
    mkdir -p "$root$CCACHE_DIR" "$CCACHE_DIR"
    mount --bind "$CCACHE_DIR" "$root$CCACHE_DIR"
  fi
fi

typed_in_the_clone() { typed "cd ist
$1"; }
in_the_clone() { step "$1" typed_in_the_clone "$2"; }
# As README says, from nothing.
in_the_clone "README.md: ./scripts/demo.sh" "$(block README.md line ./scripts/demo.sh)"
in_the_clone "README.md: ist bench" "$(block README.md line 'export PATH=')
$(block README.md line 'ist bench')"

# An operation that changes no answer, in the kernel that most of a query is spent in.
changed() {
  cd "$walk/ist"
  local decoded='batch.end[g] = at = DecodeMoving(begin, group.end, at);'
  [ "$(grep -cF "$decoded" simd/advance-inl.h)" = 1 ]
  sed -i "s/^ *batch\.end\[g\] = at = DecodeMoving(.*/      DecodeMoving(begin, group.end, at);\n&/" simd/advance-inl.h
  git diff
}
step "a kernel, changed: each batch is decoded twice" changed
seen() {
  local status=0
  typed_in_the_clone "$(block docs/performance.md line scripts/try.sh)" || status=$?
  echo "it ends with $status"
  [ $status = 1 ] && grep -q ' slower$' "$work/printed"
}
step "docs/performance.md: scripts/try.sh sees it, and ends with 1" seen
in_the_clone "back again" "git checkout -- simd && git status --short"

in_the_clone "docs/performance.md: FCL and Embree" "$(block docs/performance.md block 'bench/peers_bench')"
beside() { grep -E '/(ist|fcl|embree)/' "$work/printed"; grep -q /fcl/ "$work/printed" && grep -q /embree/ "$work/printed"; }
step "both are beside IST" beside
end_door
