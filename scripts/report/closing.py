"""Writes the tables of a closing, in docs/performance.md and README.md, from the same results as the report."""

import pathlib
import re
import sys

from report.text import number, table

POSES = {"0.0": "closed, dz = 0", "-0.5": "dz = -0.5", "-1.0": "dz = -1", "-1.5": "dz = -1.5, before contact", "-2.0": "dz = -2"}
FEW = {"0.0": "closed: {} pairs of voxels", "-1.5": "just before contact"}
PAGE, README = pathlib.Path("docs/performance.md"), pathlib.Path("README.md")


def write(page, text):
    """Between `<!-- closing table -->` and the end of the table."""
    marked = re.compile(r"<!-- closing table -->\n.*?\n\|.*?\n(?!\|)", re.S)
    before = page.read_text()
    if not marked.search(before):
        raise SystemExit(f"report: {page} has no table marked '<!-- closing table -->'")
    page.write_text(marked.sub(lambda _: f"<!-- closing table -->\n{text}\n", before))


def update(results, machine):
    """Text and plots of the pages are of the human pair, so only with that."""
    pair = results.runs("ablation_bench", "ablation")[0]["label"]
    if pair != "human":
        print(f"perf_report: {PAGE} is left as it is: it shows the human pair, and this is the {pair} one", file=sys.stderr)
        return
    rows, few = [], []
    for pose, name in POSES.items():
        published, one, two = (results.runs("ablation_bench", "ablation", *way, "0.2", pose)[0]
                               for way in (("ladder", "2-pointers_table"), ("without", "1-second_worker"), ("without", "0-full")))
        times = lambda run: f"{number(run['p50_us'])} µs"
        cell = lambda run: f"{times(run)}, {published['p50_us'] / run['p50_us']:.0f} times as fast"
        pairs = f"{one['contacts']:,.0f}" if one["contacts"] else "none"
        rows.append([name, times(published), cell(one), cell(two), pairs])
        if pose in FEW:
            few.append([FEW[pose].format(pairs), times(published), times(one)])
    write(PAGE, "\n".join([f"Medians of one run ({machine}):", "",
                           *table(["", "published", "one worker", "two workers", "leaf pairs"], rows)]))
    write(README, "\n".join(table(["two human jaws, 0.2 mm voxels", "published query", "IST, one worker"], few)))
