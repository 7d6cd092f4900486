"""Writes the README's table of a closing, from the same results as the report."""

import pathlib
import re
import sys

from report.text import number, table

POSES = {"0.0": "closed, dz = 0", "-0.5": "dz = -0.5", "-1.0": "dz = -1", "-1.5": "dz = -1.5, before contact", "-2.0": "dz = -2"}


def update(results, machine, readme=pathlib.Path("README.md")):
    """Between `<!-- closing table -->` and the end of the table. Its text and plots are of the human pair, so only with that."""
    pair = results.runs("ablation_bench", "ablation")[0]["label"]
    if pair != "human":
        print(f"perf_report: {readme} is left as it is: it shows the human pair, and this is the {pair} one", file=sys.stderr)
        return
    rows = []
    for pose, name in POSES.items():
        published, one, two = (results.runs("ablation_bench", "ablation", *way, "0.2", pose)[0]
                               for way in (("ladder", "2-pointers_table"), ("without", "1-second_worker"), ("without", "0-full")))
        cell = lambda run: f"{number(run['p50_us'])} µs, {published['p50_us'] / run['p50_us']:.0f} times as fast"
        rows.append([name, f"{number(published['p50_us'])} µs", cell(one), cell(two), f"{one['contacts']:,.0f}" if one["contacts"] else "none"])
    text = "\n".join([f"Medians of one run ({machine}):", "",
                      *table(["", "published", "one worker", "two workers", "contacts"], rows), ""])
    marked = re.compile(r"<!-- closing table -->\n.*?\n\|.*?\n(?!\|)", re.S)
    before = readme.read_text()
    if not marked.search(before):
        raise SystemExit(f"report: {readme} has no table marked '<!-- closing table -->'")
    readme.write_text(marked.sub(lambda _: f"<!-- closing table -->\n{text}", before))
