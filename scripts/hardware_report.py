"""Writes the circuit's size and clock to HARDWARE.md; see hardware_report.sh.

    hardware_report.py MADE PAGE      what synthesise.sh and nextpnr-ice40 made; the page
"""

import json
import pathlib
import re
import subprocess
import sys

from report.figures import here, stamp
from report.tables import fill, markdown

# The makers state the sizes of the parts: 4-input LUTs, multipliers and memory blocks.
ICE40, ECP5 = ("iCE40 UP5K", 5280, 8, 30), ("ECP5 LFE5U-25F", 24288, 28, 56)


def cells(file):
    """Returns the cells of a netlist by type. The text that yosys 0.23 writes round them is no valid JSON."""
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
    version = subprocess.run(["yosys", "-V"], capture_output=True, text=True, check=True).stdout.split(" (")[0]
    return [*markdown(["part", "4-input LUTs", "flip-flops", "multipliers", "memory blocks", "clock"], rows), "",
            stamp(*here(), "hardware_report.sh", f"Synthesised by {version}.")]


if __name__ == "__main__":
    fill(pathlib.Path(sys.argv[2]), "size table", "\n".join(lines(pathlib.Path(sys.argv[1]))))
