#!/usr/bin/env bash
# Makes perf/HARDWARE.md: what the circuit of src/hardware takes on two FPGAs, by yosys, how often
# it calls a near miss a hit, and, on paper, what rate it would give where a tick asks most. Counts
# along a closing are kept in perf/results/<machine>/hardware_bench.json and made where they are
# missing. Some 3 minutes once built.
#
#   scripts/hardware_report.sh            counts if need be, synthesises
#   scripts/hardware_report.sh --fresh    counts again
#
# The clock is known only where nextpnr-ice40 is installed, a package of its own; else the report says so.
#
#   IST_DATA_DIR=FOLDER    where the real jaws are, by default ../shared/data; else the built-in ones
set -euo pipefail
cd "$(dirname "$0")/.."
fresh=false
for argument in "$@"; do
  case $argument in
    --fresh) fresh=true ;;
    -h | --help) sed -n '2,12s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "hardware_report: unknown option $argument; see --help" >&2; exit 2 ;;
  esac
done
scripts/setup.sh --bench --hardware >&2
cmake --preset bench >/dev/null
cmake --build --preset bench --target hardware_bench ist_cli | tail -n 1 >&2
source scripts/machine.sh

mkdir -p "$results"
counts=$results/hardware_bench.json
if $fresh || [ ! -f "$counts" ]; then
  begin=$SECONDS
  build/bench/bench/hardware_bench --benchmark_out="$counts.part" --benchmark_out_format=json >&2
  PYTHONPATH=scripts /usr/bin/python3 -m report.results "$counts.part" "${context[@]}" \
    "seconds=$((SECONDS - begin))" "arguments="
  mv "$counts.part" "$counts"
fi

made=build/hardware
rm -rf "$made"
for family in ice40 ecp5; do
  echo "hardware_report: synthesising for $family" >&2
  scripts/hardware/synthesise.sh $family build/bench/ist "$made"
done
if command -v nextpnr-ice40 >/dev/null; then
  echo "hardware_report: placing and routing for ice40" >&2
  yosys -q -l "$made/pins.log" -p "
    read_verilog $made/ist_table_rom.v src/hardware/rtl/ist_pair_test.v
    read_verilog scripts/hardware/ist_pair_test_pins.v
    synth_ice40 -device u -dsp -top ist_pair_test_pins -json $made/pins.json" >&2
  nextpnr-ice40 --up5k --package sg48 --json "$made/pins.json" --pcf-allow-unconstrained --freq 48 \
    --timing-allow-fail --seed 1 --report "$made/placed.json" 2>"$made/placed.log" ||
    { tail -n 5 "$made/placed.log" >&2; exit 1; }
fi
PYTHONPATH=scripts /usr/bin/python3 scripts/hardware_report.py "$made" perf/HARDWARE.md
scripts/perf_report.sh --fill
echo perf/HARDWARE.md >&2
