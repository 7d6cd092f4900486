"""Writes the table of a closing in docs/performance.md from the same results as the report."""

import pathlib
import re
import sys

from report.figures import machine_state, stamp
from report.losses import NOT_EXPLAINED, factor, is_loss, listing
from report.text import number, table

POSES = {"0.0": "closed, dz = 0", "-0.5": "dz = -0.5", "-1.0": "dz = -1", "-1.5": "dz = -1.5, before contact", "-2.0": "dz = -2"}
PAGE = pathlib.Path("docs/performance.md")
# IST's spheres, workers, and the published spheres that they are compared with.
COMPARED = (("table", 1, "table"), ("tight", 1, "tight"), ("slab", 1, "slab"), ("slab", 1, "table"), ("slab", 2, "table"))


def write(page, text):
    """Between `<!-- closing table -->` and its end."""
    marked = re.compile(r"<!-- closing table -->\n.*?<!-- end of closing table -->\n", re.S)
    before = page.read_text()
    if not marked.search(before):
        raise SystemExit(f"report: {page} has no place for the table: '<!-- closing table -->' and its end")
    page.write_text(marked.sub(lambda _: f"<!-- closing table -->\n{text}\n<!-- end of closing table -->\n", before))


def compare(results):
    """The rows of the table, with losses in bold, and sentences on the losses."""
    rows, alone, behind, slower = [], {}, [], []
    for of, workers, over in COMPARED:
        row = [f"`{of}`{', two workers' if workers == 2 else ''} against `{over}`"]
        for pose, place in POSES.items():
            published = results.runs("ablation_bench", "ablation", "same", f"published-{over}", "0.2", pose)[0]
            way = ("same", f"fast-{of}") if workers == 1 else ("without", "0-full")
            fast = results.runs("ablation_bench", "ablation", *way, "0.2", pose)[0]
            times = published["p50_us"] / fast["p50_us"]
            lost = is_loss(times)
            if lost:
                behind.append(f"{row[0]}, {place} ({factor(times)})")
            if workers == 1:
                alone[of, pose] = fast["p50_us"]
            elif is_loss(alone[of, pose] / fast["p50_us"]):
                lost = True
                slower.append(f"{place} ({number(fast['p50_us'])} against {number(alone[of, pose])} µs)")
            bold = "**" if lost else ""
            row.append(f"{number(published['p50_us'])} → {number(fast['p50_us'])}: {bold}{times:.1f}{bold}<br>"
                       f"{published['contacts']:,.0f} → {fast['contacts']:,.0f}")
        rows.append(row)
    return rows, " ".join([f"**Slower than the published query**: {'; '.join(behind)}; {NOT_EXPLAINED}." if behind else
                           "No cell is slower than the published query by 3 % or more.",
                           f"**Two workers are slower than one** at {listing(slower)}: {NOT_EXPLAINED}." if slower else
                           "Two workers are nowhere slower than one by 3 % or more."])


def update(results, machine):
    """Text and plots of the pages are of the human pair, so only with that."""
    pair = results.runs("ablation_bench", "ablation")[0]["label"]
    if pair != "human":
        print(f"perf_report: {PAGE} is left as it is: it shows the human pair, and this is the {pair} one", file=sys.stderr)
        return
    rows, verdict = compare(results)
    context = results.context("ablation_bench")
    write(PAGE, "\n".join([f"Medians of one run ({machine}), one worker unless stated. Each cell has the published query's µs, IST's µs, the ratio, "
                           "and below it how many leaf pairs each lists. "
                           "Bold is a loss, against the published query or against one worker less, by 3 % or more:", "",
                           *table(["IST against published", *POSES.values()], rows), "", verdict, "",
                           stamp(context["commit"], context["date"][:10], "ablation_bench", machine_state(context))]))
