#!/usr/bin/env bash
# Installs from Debian 12's packages what is missing to build and test. Works as root or with sudo,
# and does nothing where all is there.
#
#   scripts/setup.sh             what the library, the command and the tests need
#   scripts/setup.sh --bench     also what the benchmarks and the plots need
#   scripts/setup.sh --peers     also the libraries that bench/peers compares with
#   scripts/setup.sh --fuzz      also what the fuzzers need
#   scripts/setup.sh --hardware  also what simulates and synthesises the circuit
#   scripts/setup.sh --oracles   also what reads and measures again what the command writes
#   scripts/setup.sh --python    also what makes and tests the Python package
#   scripts/setup.sh --sweep     also what runs sweeps on other engines: dask, GNU parallel
#   scripts/setup.sh --slurm     also Slurm, which the tests run on one node of their own
#   scripts/setup.sh --docs      also what makes a site of the pages and of the reference
#   scripts/setup.sh --package   also what checks manual pages and Debian packages
#   scripts/setup.sh --cloudcompare   also CloudCompare, which measures distances too
#   scripts/setup.sh --blender   also Blender, in which its add-on is tested
#   scripts/setup.sh --doors     also what walks the four doors: debootstrap, and what they take from here without a root
#   scripts/setup.sh --viewer    also what makes and tests the page. It takes the commands node (18 or
#                                later) and npm as they are there, and Debian's where they are not
#   scripts/setup.sh --cross     also what builds and runs for ARM64 and WebAssembly, and clang 16; only
#                                then the architecture arm64 is added to this machine's
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config
  libeigen3-dev libtbb-dev libassimp-dev libhwy-dev libfmt-dev libxxhash-dev
  libtomlplusplus-dev zlib1g-dev
  libcli11-dev nlohmann-json3-dev libpng-dev
  libgtest-dev libgmp-dev python3 valgrind clang-14
  binutils dpkg-dev file locales)
bench=(libbenchmark-dev python3-matplotlib)
cross=(clang-16 emscripten googletest g++-aarch64-linux-gnu qemu-user
  libtbb-dev:arm64 libhwy-dev:arm64 libfmt-dev:arm64 libxxhash-dev:arm64 libtomlplusplus-dev:arm64
  zlib1g-dev:arm64 libpng-dev:arm64 libgtest-dev:arm64)
for argument in "$@"; do
  case $argument in
    --bench) packages+=("${bench[@]}") ;;
    --peers) packages+=("${bench[@]}" libfcl-dev libembree-dev
      libbullet-dev libcgal-dev libopenvdb-dev) ;;
    --fuzz) packages+=(libclang-rt-14-dev llvm-14) ;;
    --hardware) packages+=(iverilog verilator ghdl yosys) ;;
    --oracles) packages+=(python3-numpy python3-vtk9 python3-meshio) ;;
    --python) packages+=(python3-numpy python3-setuptools python3-wheel python3-build python3-venv python3-pip
      mypy python3-matplotlib python3-meshio python3-vtk9) ;;
    --sweep) packages+=(python3-numpy python3-dask python3-distributed parallel) ;;
    --slurm) packages+=(slurm-wlm munge) ;;
    --docs) packages+=(doxygen mkdocs) ;;
    --package) packages+=(man-db mandoc lintian) ;;
    --cloudcompare) packages+=(cloudcompare) ;;
    --blender) packages+=(blender) ;;
    --doors) packages+=(debootstrap git python3-numpy python3-vtk9 python3-venv python3-pip python3-setuptools python3-wheel
      python3-build python3-dask python3-distributed libfcl-dev libembree-dev libbenchmark-dev) ;;
    --viewer)
      packages+=(emscripten googletest chromium)
      command -v node >/dev/null || packages+=(nodejs)
      command -v npm >/dev/null || packages+=(npm)
      viewer=true
      ;;
    --cross) packages+=("${cross[@]}") ;;
    -h | --help) sed -n '2,22s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "setup: unknown option $argument; see --help" >&2; exit 2 ;;
  esac
done

# A package may be installed for several architectures.
native=$(dpkg --print-architecture)
# A node from elsewhere may be too old for the page's packages.
oldest_node=18
check_node() {
  local version
  version=$(node --version | sed 's/^v//; s/\..*//')
  [ "$version" -ge $oldest_node ] && return
  echo "setup: node is of version $version, and the page needs $oldest_node: take Debian's, by apt-get install nodejs" >&2
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
    echo "setup: these packages are missing, and neither root nor sudo is here to install them:" >&2
    echo "  apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
if [[ ${missing[*]} == *:arm64* ]]; then "${as_root[@]}" dpkg --add-architecture arm64; fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  "${missing[@]}" >/dev/null
[ -z "${viewer:-}" ] || check_node
echo "setup: done"
