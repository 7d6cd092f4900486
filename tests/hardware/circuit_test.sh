#!/usr/bin/env bash
# Holds src/hardware/rtl against golden vectors, and the table against its other forms, with one
# tool. What should be found out is tried too: an answer that is wrong, a file that is cut off.
#
#   tests/hardware/circuit_test.sh iverilog|verilator|ghdl|yosys IST FOLDER
#
#   IST       the ist command
#   FOLDER    for what is made on the way; is emptied first
#
# Where the tool is missing, that is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it is 1.
set -euo pipefail
[ $# -eq 3 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
tool=$1 ist=$2 folder=$3
here=$(cd "$(dirname "$0")" && pwd)
source_folder=$(cd "$here/../.." && pwd)
rtl=$source_folder/src/hardware/rtl
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"

need() {  # tools
  local name
  for name in "$@"; do
    command -v "$name" >/dev/null && continue
    echo "circuit_test: $name is missing; scripts/setup.sh --hardware installs it" >&2
    [ "${IST_REQUIRE_ALL:-}" = 1 ] && exit 1
    exit 77
  done
}

fail() { echo "circuit_test: $*" >&2; exit 1; }

refuses() {  # what it must say, command…
  local text=$1
  shift
  if ( "$@"; exit $? ) >said 2>&1; then cat said; fail "passes, and should not: $*"; fi
  grep -qF "$text" said || { cat said; fail "should say \"$text\": $*"; }
}

# A bench, as a command that takes the vectors.
finds_out() {
  "$ist" table --vectors 300 --seed 2 -o few.txt
  sed '250s/0$/2/; 250s/1$/0/; 250s/2$/1/' few.txt >flipped.txt
  refuses "line 250: valid 1, hit $(sed -n '250s/.*\(.\)$/\1/p' few.txt)," "$@" +vectors=flipped.txt
  refuses "300 vectors, 300 answers" "$@" +vectors=flipped.txt
  sed '250s/ [0-9a-f]\{10\} \(.\)$/ 0123456789 \1/' few.txt >reach.txt
  refuses "line 250: valid 1, hit" "$@" +vectors=reach.txt
  sed '250s/ [0-9a-f]\{10\} \(.\)$/ 8000000005 \1/' few.txt >reach.txt
  refuses "a number in line 250 does not fit" "$@" +vectors=reach.txt
  sed '250s/.$/3/' few.txt >hit.txt
  refuses "a number in line 250 does not fit" "$@" +vectors=hit.txt
  head -n 200 few.txt >cut.txt
  refuses "vector 193 of 300 has" "$@" +vectors=cut.txt
  head -n 8 few.txt | sed 's/^# count .*/# count 0/' >none.txt
  refuses "has no vectors" "$@" +vectors=none.txt
  head -n 2 few.txt >header.txt
  refuses "does not say how many vectors follow" "$@" +vectors=header.txt
  : >empty.txt
  refuses "ends in its header" "$@" +vectors=empty.txt
  sed 's/^# count .*/# count 299/' few.txt >more.txt
  refuses "has more than 299 vectors" "$@" +vectors=more.txt
  refuses "cannot read" "$@" +vectors=nowhere.txt
}

answers() {  # how many, command…
  local count=$1
  shift
  "$@" >said || { cat said; fail "the circuit differs from the model"; }
  cat said
  grep -q "^$count vectors, $count answers, [1-9][0-9]* hits, 0 mismatches$" said ||
    fail "did not compare $count vectors"
}

case $tool in
  iverilog)
    need iverilog vvp
    "$ist" table --format verilog -o ist_table_rom.v
    "$ist" table --vectors 100000 --seed 1 -o vectors.txt
    # The circuit is Verilog-2005; only the bench asks for more, to end with an exit code.
    iverilog -g2005 -Wall -t null ist_table_rom.v "$rtl/ist_pair_test.v" 2>&1 | tee warnings
    [ ! -s warnings ] || fail "warnings"
    iverilog -g2012 -o bench ist_table_rom.v "$rtl/ist_pair_test.v" "$rtl/ist_pair_test_tb.v"
    answers 100000 vvp -n bench +vectors=vectors.txt
    finds_out vvp -n bench
    ;;
  verilator)
    need verilator g++ make
    "$ist" table --format verilog -o ist_table_rom.v
    "$ist" table --vectors 100000 --seed 1 -o vectors.txt
    verilator --lint-only -Wall -Wno-UNUSEDSIGNAL --top-module ist_pair_test ist_table_rom.v "$rtl/ist_pair_test.v"
    verilator --binary --timing -Wno-WIDTH -Wno-TIMESCALEMOD -O3 -CFLAGS -O1 --Mdir made \
      --top-module ist_pair_test_tb ist_table_rom.v "$rtl/ist_pair_test.v" "$rtl/ist_pair_test_tb.v" \
      >build.log 2>&1 || { cat build.log; fail "verilator cannot build the bench"; }
    answers 100000 made/Vist_pair_test_tb +vectors=vectors.txt
    finds_out made/Vist_pair_test_tb
    ;;
  ghdl)
    need ghdl
    "$ist" table --format vhdl -o ist_table_rom.vhd
    "$ist" table --format mem -o ist_table_rom.mem
    ghdl -a --std=93 --workdir=. ist_table_rom.vhd
    mkdir 2008
    ghdl -a --std=08 --workdir=2008 ist_table_rom.vhd "$here/ist_table_rom_tb.vhd"
    table() { ghdl -r --std=08 --workdir=2008 ist_table_rom_tb "-gwords=$1"; }
    sed 's,//.*,,' ist_table_rom.mem | tr -s ' ' '\n' | sed '/^$/d' >words
    table words | tee said
    grep -q "256 words are alike" said || fail "did not compare 256 words"
    sed '100s/.*/fff/' words >other
    refuses "mask 99" table other
    sed '256d' words >short
    refuses "fewer than 256" table short
    ;;
  yosys)
    need yosys iverilog vvp
    cells=$(dirname "$(command -v yosys)")/../share/yosys/ice40/cells_sim.v
    for family in ice40 ecp5; do
      "$source_folder/scripts/hardware/synthesise.sh" $family "$ist" .
      echo "$family: $(grep -oE '"(SB_LUT4|LUT4|SB_MAC16|MULT18X18D)": [0-9]+' $family.json | sort -u | tr '\n' ' ')"
    done
    # Of some thousand vectors every tenth: a netlist takes its time.
    "$ist" table --vectors 4000 --seed 3 -o all.txt
    sed -n '1,8p; 9~10p' all.txt | sed 's/^# count .*/# count 400/' >vectors.txt
    iverilog -g2012 -DIST_NETLIST -DNO_ICE40_DEFAULT_ASSIGNMENTS -o bench ice40.v "$cells" \
      "$rtl/ist_pair_test_tb.v"
    answers 400 vvp -n bench +vectors=vectors.txt
    ;;
  *) fail "no test with $tool" ;;
esac
