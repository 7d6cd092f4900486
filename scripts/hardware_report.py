"""Makes HARDWARE.md; see hardware_report.sh.

    hardware_report.py RESULTS MADE FILE      raw results; what synthesise.sh and nextpnr-ice40 made; the report
"""

import json
import pathlib
import re
import subprocess
import sys

from report.figures import here, stamp, stamped
from report.results import Results
from report.tables import markdown as table, number

CIRCUIT = pathlib.Path("src/hardware/rtl/ist_pair_test.v")

# Assumptions, not measurements. The makers state the sizes of the parts; a share of a memory's highest rate
# is assumed, because nodes lie apart and only children lie together.
ICE40 = {"name": "iCE40 UP5K", "lut": 5280, "multiplier": 8, "memory": 30}
ECP5 = {"name": "ECP5 LFE5U-25F", "lut": 24288, "multiplier": 28, "memory": 56}
CLOCKS = [12e6, 48e6, 100e6]
MEMORIES = [  # name, bytes a transfer, transfers a second, share
    ("one 16-bit SDRAM at 100 MHz", 2, 100e6, 0.5),
    ("one 16-bit DDR3 at 400 MHz", 2, 800e6, 0.5),
]
LEAF_PAIR_BYTES = 8  # two leaves of 32 bits
SERVO = 1000  # Hz

HEAD = """# The pair test in hardware

Made by `scripts/hardware_report.sh`; no measured number in it is typed by hand. The circuit is
[`ist_pair_test.v`](../src/hardware/rtl/ist_pair_test.v), specified in [`src/hardware`](../src/hardware/README.md):
it takes one pair of nodes a clock and answers {latency} clocks later. The balls are the published ones, from the table as it is;
`ist::Query` enlarges them by constants, so that they are nested, and the circuit does not.
"""


def cells(file):
    """Returns the cells of a netlist by type. The text that yosys 0.23 writes round them is no valid JSON."""
    text = file.read_text()
    return json.JSONDecoder().raw_decode(text, text.index("{", text.index('"num_cells_by_type"')))[0]


def total(counts, pattern):
    return sum(count for name, count in counts.items() if re.fullmatch(pattern, name))


def used(count, of):
    return f"{count:,} of {of:,} ({100 * count / of:.0f} %)"


def synthesis(made):
    ice40, ecp5 = cells(made / "ice40.json"), cells(made / "ecp5.json")
    rows = []
    for part, counts, lut, flip_flop, multiplier, memory in (
            (ICE40, ice40, total(ice40, "SB_LUT4"), "SB_DFF.*", "SB_MAC16", "SB_RAM40_4K"),
            (ECP5, ecp5, total(ecp5, "LUT4") + 2 * total(ecp5, "CCU2C"), "TRELLIS_FF", "MULT18X18D", "DP16KD")):
        rows.append([part["name"], used(lut, part["lut"]), f"{total(counts, flip_flop):,}",
                     used(total(counts, multiplier), part["multiplier"]), used(total(counts, memory), part["memory"])])
    version = subprocess.run(["yosys", "-V"], capture_output=True, text=True, check=True).stdout.split(" (")[0]
    return ["## Size", "", f"Synthesised by {version}, without the registers of a query and the logic that feeds the circuit.", "",
            *table(["part", "4-input LUTs", "flip-flops", "multipliers", "memory blocks"], rows), "",
            "The four multipliers square n_x, n_y, n_z and m; the memory blocks hold the table twice, once for each node of a",
            "pair. On the iCE40 a carry sits beside its LUT; on the ECP5 a carry takes a LUT, and is counted."]


def placed(made):
    """Returns the clock on the iCE40 in Hz, or None where nothing was placed, and the sentences on it."""
    file = made / "placed.json"
    if not file.is_file():
        return None, ["The clock is not measured: nextpnr measures it, and `nextpnr-ice40` is not installed."]
    said = json.loads(file.read_text())
    clock = 1e6 * min(entry["achieved"] for entry in said["fmax"].values())
    logic = said["utilization"]["ICESTORM_LC"]
    return clock, [
        f"Placed and routed on the UP5K by nextpnr-ice40 with one seed, it runs at **{clock / 1e6:.1f} MHz**, and takes",
        f"{used(logic['used'], logic['available'])} logic cells, including a shift register of 458 bits that replaces its pins."
        " Debian has", "no such tool for the ECP5: its clock is not measured."]


def near_misses(runs):
    rows = [[f"{run['voxel_size']:g}", run.parts[2], *(f"{int(run[name]):,}" for name in ("pairs", "misses", "false_hits")),
             f"{100 * run['false_hit_rate']:.3f} %"] for run in runs]
    worst = max(runs, key=lambda run: run["false_hit_rate"])
    more = max(runs, key=lambda run: run["pairs"] / run["pairs_exact"])
    found = max(runs, key=lambda run: run["contacts"] - run["contacts_exact"])
    extra = int(found["contacts"] - found["contacts_exact"])
    lost = sum(int(run["false_misses"]) for run in runs)
    lines = ["## How often a near miss is a hit", "",
             "The table counts the pairs that a query tests along a closing by `table` spheres, the misses among them (pairs without a common",
             "point), and the misses that the circuit calls hits. "
             f"The circuit misses a hit in {lost:,} of {sum(int(run['pairs']) for run in runs):,} pairs"
             + (".", ": **this must not be.**")[lost > 0], "",
             *table(["voxel", "dz", "pairs tested", "misses", "of them called a hit", "part"], rows), ""]
    if worst["false_hits"] == 0:
        return [*lines, "It calls no miss a hit."]
    lines += [f"At most {100 * worst['false_hit_rate']:.3f} % of the misses become hits. They cost at most"
              f" {100 * (more['pairs'] / more['pairs_exact'] - 1):.2f} % more pairs, and"]
    lines.append(f"at most {extra:,} more leaf pairs, of {int(found['contacts_exact']):,}." if extra > 0
                 else "no more leaf pairs.")
    return lines


def rate(value):
    return f"**{number(value)}**" if value >= SERVO else number(value)


def worst_tick(runs, latency, clock):
    sizes = sorted({run["voxel_size"] for run in runs}, reverse=True)
    worst = [max((run for run in runs if run["voxel_size"] == size), key=lambda run: run["pairs"]) for size in sizes]
    clocks = CLOCKS + ([clock] if clock else [])
    name = lambda hertz: f"{hertz / 1e6:g} MHz" if hertz in CLOCKS else f"{hertz / 1e6:.1f} MHz, as placed"
    traffic = lambda run: run["words"] * run["word_bytes"] + run["contacts"] * LEAF_PAIR_BYTES
    waiting = lambda run: run["pairs"] + latency * run["opened"]
    of = lambda run: f"{run['voxel_size']:g}"

    lines = ["## The worst tick, on paper", "",
             "This is an estimate; no such circuit was built. The counts are a query's, down two trees, at the pose of the closing with most",
             f"tests; the clocks, and the memories' share of their highest rate, are assumed. **Bold** is {SERVO:,} Hz or more.", "",
             *table(["voxel", "worst at dz", "pairs P", "pairs opened O", "words read W", "leaf pairs C", "centres moved"],
                    [[of(run), run.parts[2], *(f"{int(run[key]):,}" for key in ("pairs", "opened", "words", "contacts", "moved"))]
                     for run in worst]), "",
             "**By the circuit**: one unit, at one pair a clock, gives clock / P ticks a second if it never waits, because other pairs are",
             f"under way while one is opened. If each opened pair waits for its answer, it gives clock / (P + {latency} O).", "",
             *table(["clock", *(f"voxel {of(run)}" for run in worst)],
                    [[name(hertz), *(f"{rate(hertz / run['pairs'])} … {rate(hertz / waiting(run))} Hz" for run in worst)]
                     for hertz in sorted(clocks)]), "",
             f"**By memory**: a word has {int(worst[0]['word_bytes'])} bytes, a mask and a first child, and leaves have none; "
             f"a leaf pair is written in {LEAF_PAIR_BYTES}.", "So a tick moves "
             f"{int(worst[0]['word_bytes'])} W + {LEAF_PAIR_BYTES} C bytes, if no word is kept from one pair to the next, and each centre is",
             "moved when its node is met. A kept centre would cost 12 bytes to write, and to read at each opened pair.", "",
             *table(["memory", "highest rate", "share assumed", *(f"voxel {of(run)}" for run in worst)],
                    [["bytes a tick", "", "", *(f"{int(traffic(run)):,}" for run in worst)]]
                    + [[memory, f"{number(width * per_second / 1e6)} MB/s", f"{100 * share:g} %",
                        *(f"{rate(width * per_second * share / traffic(run))} Hz" for run in worst)]
                       for memory, width, per_second, share in MEMORIES]), ""]
    for run in worst:
        by_circuit = CLOCKS[-1] / run["pairs"]
        by_memory = [width * per_second * share / traffic(run) for _, width, per_second, share in MEMORIES]
        limit = "the circuit" if by_circuit < by_memory[0] else "the memory"
        holds = min(by_circuit, by_memory[0]) >= SERVO
        need = run["pairs"] * SERVO / CLOCKS[-1]
        lines.append(
            f"- Voxel {of(run)}, {CLOCKS[-1] / 1e6:g} MHz, {MEMORIES[0][0]}: {limit} is the limit, and {SERVO:,} Hz are "
            f"{'reached' if holds else 'not reached'}; by pairs alone they take {number(need, 2)} units. The trees take at most "
            f"{number(run['nodes'] * run['word_bytes'] / 2**20, 2)} MiB.")
    return lines


def main():
    results, made, file = Results(sys.argv[1]), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    latency = int(re.search(r"localparam LATENCY = (\d+);", CIRCUIT.read_text()).group(1))
    runs = results.runs("hardware_bench", "hardware")
    context = results.context("hardware_bench")
    clock, said = placed(made)
    counted = stamp(context["commit"], context["date"][:10], "hardware_bench")
    lines = [HEAD.format(latency=latency), *stamped(synthesis(made), stamp(*here(), "hardware_report.sh")), "", *said, "",
             *stamped([*near_misses(runs), "", *worst_tick(runs, latency, clock)], counted), "",
             f"Counts on a {runs[0]['label']} pair of jaws, lengths in millimetres. The counts do not depend on the machine."]
    file.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
