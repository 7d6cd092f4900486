#!/usr/bin/python3
"""Makes perf/HARDWARE.md: the size of the circuit of src/hardware on two FPGAs, by yosys, how often it calls a near miss a hit, and, on paper, its
rate in the worst tick. perf/results/<machine>/hardware_bench.json keeps the counts along a closing. Some 3 minutes once built.

    scripts/hardware_report.py            counts if the counts are missing, synthesises
    scripts/hardware_report.py --fresh    counts again

nextpnr-ice40, a package of its own, measures the clock. Without it the report says that the clock is not measured.

    IST_DATA_DIR=FOLDER    the folder of the real jaws, by default ../shared/data; without it the built-in jaws are used"""

import json
import pathlib
import re
import shutil
import sys

from machine import build, machine, output, refuse, run
from report.figures import here, stamp
from report.runner import Runner
from report.tables import fill, markdown

# The makers state the sizes of the parts: 4-input LUTs, multipliers and memory blocks.
ICE40, ECP5 = ("iCE40 UP5K", 5280, 8, 30), ("ECP5 LFE5U-25F", 24288, 28, 56)


def cells(file):
    """Returns the cells of a netlist by type. yosys 0.23 writes them into a text that is not valid JSON."""
    text = file.read_text()
    return json.JSONDecoder().raw_decode(text, text.index("{", text.index('"num_cells_by_type"')))[0]


def total(counts, pattern):
    return sum(count for name, count in counts.items() if re.fullmatch(pattern, name))


def used(count, of):
    return f"{count:,} of {of:,} ({100 * count / of:.0f} %)"


def placed(made):
    """Returns the clock on the iCE40, which nextpnr measures."""
    file = made / "placed.json"
    if not file.is_file():
        return "not measured: `nextpnr-ice40` is not installed"
    said = json.loads(file.read_text())
    logic = said["utilization"]["ICESTORM_LC"]
    return f"{min(entry['achieved'] for entry in said['fmax'].values()):.1f} MHz, with {used(logic['used'], logic['available'])} logic cells"


def lines(made):
    ice40, ecp5 = cells(made / "ice40.json"), cells(made / "ecp5.json")
    rows = [[name, used(lut, luts), f"{total(counts, flip_flop):,}", used(total(counts, multiplier), multipliers),
             used(total(counts, memory), blocks), clock]
            for (name, luts, multipliers, blocks), counts, lut, flip_flop, multiplier, memory, clock in (
                (ICE40, ice40, total(ice40, "SB_LUT4"), "SB_DFF.*", "SB_MAC16", "SB_RAM40_4K", placed(made)),
                (ECP5, ecp5, total(ecp5, "LUT4") + 2 * total(ecp5, "CCU2C"), "TRELLIS_FF", "MULT18X18D", "DP16KD", "not measured"))]
    version = output("yosys", "-V").stdout.split(" (")[0]
    return [*markdown(["part", "4-input LUTs", "flip-flops", "multipliers", "memory blocks", "clock"], rows), "",
            stamp(*here(), "hardware_report.py", f"Synthesised by {version}.")]


def place_and_route(made):
    run("yosys", "-q", "-l", made / "pins.log", "-p", f"""
        read_verilog {made}/ist_table_rom.v src/hardware/rtl/ist_pair_test.v
        read_verilog scripts/hardware/ist_pair_test_pins.v
        synth_ice40 -device u -dsp -top ist_pair_test_pins -json {made}/pins.json""")
    run("nextpnr-ice40", "--up5k", "--package", "sg48", "--json", made / "pins.json", "--pcf-allow-unconstrained", "--freq", "48",
        "--timing-allow-fail", "--seed", "1", "--report", made / "placed.json", "--quiet")


def main(words):
    refuse([word for word in words if word != "--fresh"], __doc__)
    build("bench", "hardware_bench", "ist_cli", "fixed_loop", needs=["--bench", "--hardware"])
    machine_here, made = machine(), pathlib.Path("build/hardware")
    if words or not (machine_here.results / "hardware_bench.json").exists():
        Runner(machine_here.results, machine_here.context, quick=False).measure("hardware_bench", "hardware_report: counting")
    shutil.rmtree(made, ignore_errors=True)
    for family in ("ice40", "ecp5"):
        run("scripts/hardware/synthesise.sh", family, "build/bench/ist", made)
    if shutil.which("nextpnr-ice40"):
        place_and_route(made)
    fill(pathlib.Path("perf/HARDWARE.md"), "size table", "\n".join(lines(made)))
    run("scripts/perf_report.py", "--fill")


if __name__ == "__main__":
    main(sys.argv[1:])
