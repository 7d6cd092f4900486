#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing. It works as root or with sudo, and does nothing if all are installed.
# An option adds the packages of a task to those of a build:
#
#   scripts/setup.sh             to build the command and the library
#   scripts/setup.sh --tests     to build and run the fast tests
#   scripts/setup.sh --all       to run scripts/test.sh --all
#   scripts/setup.sh --bench     to build the benchmarks and draw the plots
#   scripts/setup.sh --peers     to build the libraries that bench/peers compares with
#   scripts/setup.sh --fuzz      to build the fuzzers
#   scripts/setup.sh --style     to check style by clang-format and flake8
#   scripts/setup.sh --lint      to check style by clang-tidy, and before each commit
#   scripts/setup.sh --hardware  to simulate and synthesise the circuit
#   scripts/setup.sh --oracles   to read and measure the command's files by other tools
#   scripts/setup.sh --python    to make and test the Python package
#   scripts/setup.sh --sweep     to run sweeps by dask and GNU parallel
#   scripts/setup.sh --slurm     to run sweeps by Slurm, on one node of its own
#   scripts/setup.sh --docs      to make a site of the pages and of the reference
#   scripts/setup.sh --package   to check packages, manual pages and instruction counts
#   scripts/setup.sh --cloudcompare   to measure distances by CloudCompare
#   scripts/setup.sh --blender   to test the add-on in Blender
#   scripts/setup.sh --doors     to walk the four doors of tests/doors
#   scripts/setup.sh --viewer    to make and test the page. It uses the node (18 or later) and npm that it finds, and
#                                installs Debian's if it finds none
#   scripts/setup.sh --cross     to build and run for ARM64 and WebAssembly, and with clang 16. It adds the
#                                architecture arm64 to this machine
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config
  libeigen3-dev libtbb-dev libhwy-dev libfmt-dev libxxhash-dev libtomlplusplus-dev zlib1g-dev
  libcli11-dev nlohmann-json3-dev libcairo2-dev help2man
  libassimp-dev libzip-dev libpugixml-dev libseccomp-dev)
bench="libbenchmark-dev python3-matplotlib"
declare -A tasks=(
  [--tests]="libgtest-dev libgmp-dev libpng-dev python3 python3-numpy locales git dpkg-dev"
  [--style]="clang-format flake8"
  [--lint]="clang-format flake8 clang-tidy-14 pre-commit"
  [--bench]=$bench
  [--peers]="$bench libfcl-dev libembree-dev libbullet-dev libcgal-dev libopenvdb-dev"
  [--fuzz]="clang-14 libclang-rt-14-dev llvm-14"
  [--hardware]="iverilog verilator ghdl yosys"
  [--oracles]="python3-numpy python3-vtk9 python3-meshio"
  [--python]="python3-numpy python3-setuptools python3-wheel python3-build python3-venv python3-pip mypy python3-matplotlib python3-meshio python3-vtk9"
  [--sweep]="python3-numpy python3-dask python3-distributed parallel"
  [--slurm]="slurm-wlm munge"
  [--docs]="doxygen mkdocs"
  [--package]="man-db mandoc lintian binutils dpkg-dev file clang-14 valgrind"
  [--cloudcompare]=cloudcompare
  [--blender]=blender
  [--doors]="debootstrap git python3-numpy python3-vtk9 python3-venv python3-pip python3-setuptools python3-wheel python3-build python3-dask
    python3-distributed libfcl-dev libembree-dev libbenchmark-dev"
  [--viewer]="emscripten googletest chromium"
  [--cross]="clang-14 clang-16 emscripten googletest g++-aarch64-linux-gnu qemu-user libtbb-dev:arm64 libhwy-dev:arm64 libfmt-dev:arm64
    libxxhash-dev:arm64 libtomlplusplus-dev:arm64 zlib1g-dev:arm64 libgtest-dev:arm64"
)
for argument in "${@/#--all/--tests --oracles --python --sweep --docs --viewer --hardware --package --style}"; do
  for task in ${argument:-none}; do
    case $task in
      -h | --help) sed -n '2,28s/^# \{0,1\}//p' "$0"; exit 0 ;;
      --viewer)
        viewer=true
        command -v node >/dev/null || packages+=(nodejs)
        command -v npm >/dev/null || packages+=(npm)
        ;;
    esac
    [ -n "${tasks[$task]:-}" ] || { echo "setup: unknown option $argument; see --help" >&2; exit 2; }
    # shellcheck disable=SC2206  # words
    packages+=(${tasks[$task]})
  done
done

# A package may be installed for several architectures.
native=$(dpkg --print-architecture)
# A node that Debian did not install may be too old for the page's packages.
oldest_node=18
check_node() {
  local version
  version=$(node --version | sed 's/^v//; s/\..*//')
  [ "$version" -ge $oldest_node ] && return
  echo "setup: node has version $version, and the page needs $oldest_node: run apt-get install nodejs" >&2
  exit 1
}
missing=()
for package in "${packages[@]}"; do
  architecture=${package#*:}
  [ "$architecture" != "$package" ] || architecture=$native
  dpkg-query -W -f '${Architecture} ${db:Status-Status}\n' "$package" 2>/dev/null |
    grep -qE "^($architecture|all) installed$" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  [ -z "${viewer:-}" ] || check_node
  echo "setup: everything is installed"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: packages are missing, and this user is neither root nor has sudo: ask for apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
if [[ ${missing[*]} == *:arm64* ]]; then "${as_root[@]}" dpkg --add-architecture arm64; fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=3 "$@" >"$log" 2>&1; }
if ! apt update || ! apt install -y --no-install-recommends "${missing[@]}"; then
  echo "setup: apt-get failed ($(grep -m 1 '^E:' "$log" || tail -n 1 "$log")): check the network and /etc/apt/sources.list, and run this again" >&2
  exit 1
fi
[ -z "${viewer:-}" ] || check_node
echo "setup: done"
