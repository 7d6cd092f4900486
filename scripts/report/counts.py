"""Tables of programs that scripts/perf_report.py does not run: the circuit's counts in perf/HARDWARE.md and the builds in docs/performance.md."""

import re
import statistics

from report.figures import ROOT
from report.results import Run
from report.tables import POLICIES, Table, number, row

# Assumptions, not measurements: the clocks, and a share of a memory's highest rate, because nodes lie apart and only children lie together.
CLOCKS = (12e6, 48e6, 100e6)
MEMORIES = {"one 16-bit SDRAM at 100 MHz": (2, 100e6, 0.5), "one 16-bit DDR3 at 400 MHz": (2, 800e6, 0.5)}  # bytes, transfers a second, share
LEAF_PAIR_BYTES = 8  # two leaves of 32 bits
SERVO = 1000  # Hz


def circuit(results, program):
    """The poses of the closing. The circuit may call a miss a hit, and never a hit a miss."""
    found = results.runs(program, "hardware")
    if missed := sum(run["false_misses"] for run in found):
        raise SystemExit(f"report: the circuit misses {missed:,.0f} hits: correct src/hardware before you write about it")
    return found


def worst(results, program):
    """The pose with most pairs for each voxel size."""
    found = circuit(results, program)
    return [max((run for run in found if run.parts[1] == size), key=lambda run: run["pairs"])
            for size in sorted({run.parts[1] for run in found}, key=float, reverse=True)]


def rate(hertz):
    return f"**{number(hertz)}**" if hertz >= SERVO else number(hertz)


def traffic(run):
    return run["words"] * run["word_bytes"] + run["contacts"] * LEAF_PAIR_BYTES


def by_memory(run, memory):
    width, per_second, share = MEMORIES[memory]
    return width * per_second * share / traffic(run)


def sizes(*columns):
    """Columns, and one for each voxel size, which each row has by its name."""
    return lambda rows: [*columns, *((name, name) for name in rows[0] if name.startswith("voxel "))]


def voxel(run):
    return f"voxel {run.parts[1]}"


def clocks(results, program):
    circuit_text = (ROOT / "src/hardware/rtl/ist_pair_test.v").read_text()
    found, wait = worst(results, program), int(re.search(r"localparam LATENCY = (\d+);", circuit_text)[1])
    return [row(f"{hertz / 1e6:g} MHz", **{voxel(run): f"{rate(hertz / run['pairs'])} … {rate(hertz / (run['pairs'] + wait * run['opened']))} Hz"
                                           for run in found}) for hertz in CLOCKS]


def memories(results, program):
    found = worst(results, program)
    return [row("bytes a tick", most="", share="", **{voxel(run): traffic(run) for run in found}),
            *(row(name, most=f"{number(width * per_second / 1e6)} MB/s", share=f"{100 * share:g} %",
                  **{voxel(run): f"{rate(by_memory(run, name))} Hz" for run in found}) for name, (width, per_second, share) in MEMORIES.items())]


def builds(results, program):
    """The medians of several builds, a row a voxel size."""
    made = {}
    for run in results.runs(program, "build"):
        made.setdefault(run.parts[2], {}).setdefault(run.parts[1], []).append(run)
    for size in sorted(made, key=float, reverse=True):
        for policy in POLICIES[1:]:
            if len(made[size][policy]) < 3:
                raise SystemExit(f"report: {size}, {policy}: too few builds for a median: scripts/bench.py build_bench -- --benchmark_repetitions=5")
        yield Run({"name": size, **{f"{policy}:{key}": statistics.median(run[key] for run in of) for policy, of in made[size].items()
                                    for key in ("real_time", "tree_MB", "peak_MB", "leaves")}})


def triangles_alone(results, program):
    if not results.has(program, "stages"):
        return []
    made = {}
    for run in results.runs(program, "stages"):
        if float(run.parts[0]) == 0:
            made.setdefault(run.parts[1], []).append(run)
    keys = ("read_ms", "build_ms", "load_ms", "trees_MB")
    return [Run(of[0] | {key: statistics.median(run[key] for run in of) for key in keys} | {"n": len(of)}) for of in made.values()]


TABLES = {
    "near misses": Table("hardware_bench", circuit, [
        ("voxel", 1), ("dz", 2), ("pairs tested", "pairs"), ("misses", "misses"), ("of them called a hit", "false_hits"),
        ("part", lambda r: f"{100 * r['false_hit_rate']:.3f} %")]),
    "worst tick": Table("hardware_bench", worst, [
        ("voxel", 1), ("worst at dz", 2), ("pairs P", "pairs"), ("pairs opened O", "opened"), ("words read W", "words"), ("leaf pairs C", "contacts"),
        ("centres moved", "moved")]),
    "by the circuit": Table("hardware_bench", clocks, sizes(("clock", 0))),
    "by memory": Table("hardware_bench", memories, sizes(("memory", 0), ("highest rate", "most"), ("share assumed", "share"))),
    "what it takes": Table("hardware_bench", worst, [
        ("voxel", 1), (f"the limit at {CLOCKS[-1] / 1e6:g} MHz with SDRAM",
                       lambda r: "circuit" if CLOCKS[-1] / r["pairs"] < by_memory(r, next(iter(MEMORIES))) else "memory"),
        (f"units for {SERVO:,} Hz by pairs alone", lambda r: number(r["pairs"] * SERVO / CLOCKS[-1], 2)),
        ("trees, MiB", lambda r: number(r["nodes"] * r["word_bytes"] / 2**20, 2)),
        ("more pairs than exact, %", lambda r: f"{100 * (r['pairs'] / r['pairs_exact'] - 1):.2f}"),
        ("more leaf pairs", lambda r: r["contacts"] - r["contacts_exact"])]),
    "build": Table("build_bench", lambda *given: list(builds(*given)), [
        ("voxel size", lambda r: f"{float(r.parts[0]):g}"), ("voxels", "table:leaves"),
        *((head, lambda r, p=p, form=form: form(r, p)) for p in POLICIES[1:] for head, form in (
            (f"`{p}`", lambda r, p: f"{r[p + ':real_time']:,.0f} ms"), ("in memory", lambda r, p: f"{r[p + ':tree_MB']:,.1f} MB"))),
        ("peak", lambda r: f"{r['slab:peak_MB']:,.0f} MB")]),
    "build of triangles": Table("build_bench", triangles_alone, [
        ("threads", 1), *((head, lambda r, key=key: f"{r[key]:,.0f} ms") for head, key in (
            ("both files read", "read_ms"), ("both trees built", "build_ms"), ("both loaded", "load_ms"))),
        ("in memory", lambda r: f"{r['trees_MB']:,.1f} MB"), ("n", "n")]),
}
