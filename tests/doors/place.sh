# shellcheck shell=bash disable=SC2154  # door.sh has the other names
# Where a door leads to: a root of Debian 12, or a folder with packages unpacked.
base=$doors/root

# Why there can be no root; nothing where there can.
why_no_root() {
  if [ "$(id -u)" != 0 ]; then echo "debootstrap needs root"
  elif ! command -v debootstrap >/dev/null; then echo "debootstrap is not installed: scripts/setup.sh --doors does that"
  elif ! unshare --mount true 2>/dev/null; then echo "nothing may be mounted here"
  fi
}

# This machine's places of Debian 12's packages, a line each: address and suite.
places() {
  # shellcheck disable=SC2016  # for apt
  apt-get indextargets --format '$(REPO_URI) $(RELEASE)' "Created-By: Packages" 2>/dev/null |
    grep -E ' bookworm(-updates|-security)?$' | grep -E '/debian(-security)?/? ' | sort -u
}

# Once for all doors; what is not whole is made again.
make_root() {
  [ ! -e "$base.made" ] || return 0
  echo "door: making $base by debootstrap, once for all doors"
  local mirror
  mirror=$(places | awk '$2 == "bookworm" {print $1; exit}')
  rm -rf --one-file-system "${base:?}"
  debootstrap --variant=minbase bookworm "$base" "${mirror:-http://deb.debian.org/debian}" >"$doors/debootstrap.log" 2>&1 || return 1
  places | sed -E 's/(.*) (.*)/deb \1 \2 main/' >"$doors/sources"
  [ ! -s "$doors/sources" ] || cp "$doors/sources" "$base/etc/apt/sources.list"
  # A user answers with yes. No service is started.
  printf 'APT::Get::Assume-Yes "true";\nAPT::Install-Recommends "false";\nDPkg::Use-Pty "0";\n' >"$base/etc/apt/apt.conf.d/90door"
  apt-config dump | grep -E '^Acquire::https?::Proxy ' >>"$base/etc/apt/apt.conf.d/90door" || true
  printf '#!/bin/sh\nexit 101\n' >"$base/usr/sbin/policy-rc.d"
  # The only user is root, and a bare Debian has no sudo.
  # shellcheck disable=SC2016  # for the root's shell
  printf '#!/bin/sh\nexec "$@"\n' >"$base/usr/local/bin/sudo"
  chmod +x "$base/usr/sbin/policy-rc.d" "$base/usr/local/bin/sudo"
  touch "$base.made"
}

# In a mount namespace of the door's own.
enter_root() {
  root=$work/root walk=$work/root/root/walk
  rm -rf --one-file-system "${work:?}"
  mkdir -p "$root" "$work/upper" "$work/overlay" "$doors/archives/partial"
  if mount -t overlay overlay -o "lowerdir=$base,upperdir=$work/upper,workdir=$work/overlay" "$root" 2>/dev/null; then
    echo "the root lies over $base" >>"$log"
  else
    cp -a "$base/." "$root"
    echo "the root is a copy of $base" >>"$log"
  fi
  mkdir -p "$walk"
  mount -t proc proc "$root/proc"
  mount --rbind /dev "$root/dev"
  mount --bind "$doors/archives" "$root/var/cache/apt/archives"  # what was downloaded once
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  step "apt-get update in the root" typed "apt-get update -q"
}

# What a user's shell has, and nothing else of this machine's but what makes builds and downloads shorter.
passed_on() {
  local each
  for each in http_proxy https_proxy no_proxy CMAKE_BUILD_PARALLEL_LEVEL IST_REQUIRE_ALL "${passed[@]}"; do
    [ -z "${!each:-}" ] || printf '%s=%s\n' "$each" "${!each}"
  done
}
passed=()

in_place() {
  local -a given
  mapfile -t given < <(passed_on)
  if [ "$way" = root ]; then
    chroot "$root" /usr/bin/env -i HOME=/root USER=root LANG=C.UTF-8 TERM=dumb DEBIAN_FRONTEND=noninteractive \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${given[@]}" \
      bash -euo pipefail -c "cd /root/walk; $1"
  else
    local libraries
    libraries=$unpacked/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)
    (cd "$walk" && env -i HOME="$walk" USER="${USER:-}" LANG=C.UTF-8 TERM=dumb "${given[@]}" PATH="$unpacked/usr/bin:/usr/local/bin:/usr/bin:/bin" \
      LD_LIBRARY_PATH="$libraries" CMAKE_PREFIX_PATH="$unpacked/usr" PKG_CONFIG_PATH="$libraries/pkgconfig" \
      bash -euo pipefail -c "$1")
  fi
}
unpacked=$doors/unpacked

# For the title of a step: a user gets packages, the page and the wheel ready made.
outside="built on this machine, outside the bare Debian"

# The Debian packages of this tree, as docs/building.md makes them, beside the user.
packages_made() {
  cmake --preset release
  cmake --build --preset release
  rm -rf "$doors/packages"
  cpack --config build/release/CPackConfig.cmake -B "$doors/packages"
  cp "$doors"/packages/*.deb "$walk"
}
packages_unpacked() {
  rm -rf "$unpacked"
  mkdir -p "$unpacked"
  local package
  for package in "$walk"/*.deb; do
    echo "dpkg-deb -x $package"
    dpkg-deb -x "$package" "$unpacked"
  done
}
packages() {
  cd "$source" || exit
  step "the page, by scripts/viewer.sh, $outside" page_made
  step "the packages, by CMake's preset release and CPack, $outside" packages_made
  [ "$way" = root ] || step "the packages, unpacked" packages_unpacked
}
page_made() {
  scripts/viewer.sh || lacks "needs the page for the packages, and scripts/viewer.sh makes none here"
}

# A program or a module of Python that this machine must have where nothing is installed for the door.
needs_here() {
  [ "$way" = unpacked ] || return 0
  local each
  for each in "$@"; do
    case $each in
      python:*) /usr/bin/python3 -c "import ${each#*:}" 2>/dev/null || step "what the door takes from here" lacks "needs ${each#*:} for /usr/bin/python3: $install" ;;
      *) command -v "$each" >/dev/null || step "what the door takes from here" lacks "needs $each: $install" ;;
    esac
  done
}
install="scripts/setup.sh --doors installs it"
