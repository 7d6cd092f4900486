#!/usr/bin/env bash
# Synthesises src/hardware/rtl/ist_pair_test.v with yosys, without the port that only tests read.
# Fails if the circuit has a latch, a divider or a loop, or not four multiplications, before or after.
#
#   scripts/hardware/synthesise.sh ice40|ecp5 IST FOLDER
#
#   IST       the ist command, which writes the table
#   FOLDER    gets FAMILY.json, the cells by type, FAMILY.v, the netlist, and FAMILY.log
set -euo pipefail
[ $# -eq 3 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
family=$1 ist=$2 folder=$3
rtl=$(cd "$(dirname "$0")/../../src/hardware/rtl" && pwd)
case $family in
  ice40) synthesis="synth_ice40 -device u -dsp -top ist_pair_test" multiplier=SB_MAC16 ;;
  ecp5) synthesis="synth_ecp5 -top ist_pair_test" multiplier=MULT18X18D ;;
  *) echo "synthesise: unknown family $family; ice40 and ecp5 are known" >&2; exit 2 ;;
esac
mkdir -p "$folder"
"$ist" table --format verilog -o "$folder/ist_table_rom.v" >&2
# yosys 0.23 only warns of a wire with two drivers. A netlist of single wires is simulated faster.
if ! yosys -q -l "$folder/$family.log" -e 'river conflict' -p "
  read_verilog $folder/ist_table_rom.v $rtl/ist_pair_test.v
  hierarchy -check -top ist_pair_test
  proc
  select -assert-none t:\$dlatch t:\$adlatch t:\$dlatchsr t:\$sr
  select -assert-none t:\$div t:\$mod t:\$divfloor t:\$modfloor t:\$pow
  select -assert-count 4 t:\$mul
  delete -port ist_pair_test/reach
  $synthesis
  check -assert
  select -assert-count 4 t:$multiplier
  tee -q -o $folder/$family.json stat -json
  splitnets
  clean
  write_verilog -noattr $folder/$family.v" >"$folder/$family.said" 2>&1; then
  cat "$folder/$family.said" >&2
  exit 1
fi
