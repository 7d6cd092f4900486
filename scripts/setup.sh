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
#   scripts/setup.sh --docs      also what makes a site of the pages and of the reference
#   scripts/setup.sh --package   also what checks manual pages and Debian packages
#   scripts/setup.sh --cloudcompare   also CloudCompare, which measures distances too
set -euo pipefail

packages=(g++ cmake ninja-build pkg-config
  libeigen3-dev libtbb-dev libassimp-dev libhwy-dev libfmt-dev libxxhash-dev
  libtomlplusplus-dev zlib1g-dev
  libcli11-dev nlohmann-json3-dev libpng-dev
  libgtest-dev libgmp-dev python3 valgrind clang-14
  binutils dpkg-dev file)
bench=(libbenchmark-dev python3-matplotlib)
for argument in "$@"; do
  case $argument in
    --bench) packages+=("${bench[@]}") ;;
    --peers) packages+=("${bench[@]}" libfcl-dev libembree-dev
      libbullet-dev libcgal-dev libopenvdb-dev) ;;
    --fuzz) packages+=(libclang-rt-14-dev llvm-14) ;;
    --hardware) packages+=(iverilog verilator ghdl yosys) ;;
    --oracles) packages+=(python3-numpy python3-vtk9 python3-meshio) ;;
    --docs) packages+=(doxygen mkdocs) ;;
    --package) packages+=(man-db mandoc lintian) ;;
    --cloudcompare) packages+=(cloudcompare) ;;
    -h | --help) sed -n '2,13s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "setup: unknown option $argument; see --help" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
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
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  "${missing[@]}" >/dev/null
echo "setup: done"
