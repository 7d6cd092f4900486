"""Makes STABILITY.md and its plot; see stability_report.sh.

    stability_report.py CASES.jsonl FOLDER MACHINE COMMIT DATE
"""
import json
import math
import pathlib
import shutil
import sys

import matplotlib

from report.figures import ROOT, stamp
from report.tables import fill

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PAGE = ROOT / "perf/STABILITY.md"
FLOOR, CEILING = 1e-6, 10  # ends of the plot: values beyond them are drawn there, as triangles
GROUPS = {
    "tangency": "Bodies that only just touch",
    "scale": "Any size",
    "place": "Any place",
    "arithmetic": "Any arithmetic of the caller",
    "long runs": "Millions of motions",
    "shapes": "Shapes that meshes should not have",
    "motion": "Small steps",
    "faults": "Failures",
    "load": "Load",
}


def ratio(case):
    """Returns the worst error over its bound; None where the case is right or wrong."""
    if not case["bound"]:
        return None
    return math.inf if case["worst"] is None else case["worst"] / case["bound"]


def number(value):
    return "no number" if value is None else f"{value:.3g}"


def table(cases):
    lines = ["| case | samples | error | worst | bound | worst / bound |", "|---|--:|---|--:|--:|--:|"]
    for case in cases:
        part = ratio(case)
        lines.append(
            f"| {case['name']} | {case['samples']:,} | {case['error']} | {number(case['worst'])} | "
            f"{number(case['bound'])} | {'' if part is None else number(part)} |")
    return lines


def plot(cases, file):
    shown = [case for case in cases if ratio(case) is not None]
    figure, axes = plt.subplots(figsize=(9, 1.2 + 0.2 * len(shown)))
    colours = dict(zip(GROUPS, plt.get_cmap("tab10").colors))
    for row, case in enumerate(shown):
        part = ratio(case)
        mark = "<" if part <= FLOOR else ">" if part > CEILING else "o"
        axes.plot(min(max(part, FLOOR), CEILING), row, mark, color=colours[case["group"]], markersize=5)
    axes.axvline(1, color="black", linewidth=1)
    axes.text(1, -0.8, " guaranteed", va="bottom", ha="right", fontsize=8)
    axes.set_yticks(range(len(shown)), [f"{c['group']}: {c['name']}" for c in shown], fontsize=7)
    axes.set_ylim(len(shown) - 0.5, -1.5)
    axes.set_xscale("log")
    axes.set_xlim(FLOOR / 2, 2 * CEILING)
    axes.grid(axis="x", alpha=0.3)
    axes.set_xlabel(f"worst error seen / bound guaranteed (a triangle: less than {FLOOR:g})")
    samples = sum(case["samples"] for case in shown)
    axes.set_title(f"How much of each guarantee is used: {len(shown)} cases, n = {samples:,} samples", fontsize=9)
    figure.tight_layout()
    plt.rcParams.update({"svg.hashsalt": "ist", "svg.fonttype": "none"})
    figure.savefig(file, metadata={"Date": None})


def main():
    source, folder, machine, commit, date = sys.argv[1], pathlib.Path(sys.argv[2]), *sys.argv[3:]
    cases = [json.loads(line) for line in open(source)]
    order = list(GROUPS)
    cases.sort(key=lambda case: order.index(case["group"]))  # stable: as they were tried
    (folder / "pictures").mkdir(parents=True, exist_ok=True)
    plot(cases, folder / "pictures/stability.svg")
    broken = [case for case in cases if case["broken"]]
    lines = [f"{machine}. {len(cases)} cases, {sum(c['samples'] for c in cases):,} samples, {len(broken)} broken.", "",
             "![The worst error of each case over its bound](pictures/stability.svg)", ""]
    for group, title in GROUPS.items():
        chosen = [case for case in cases if case["group"] == group]
        if chosen:
            lines += [f"## {title}", "", *table(chosen), "", stamp(commit, date, "stability_report.sh"), ""]
    if folder.resolve() != PAGE.parent:
        shutil.copy(PAGE, folder)
    fill(folder / PAGE.name, "cases", "\n".join(lines))
    if broken:
        print(f"stability_report: {len(broken)} cases break their guarantee", file=sys.stderr)


main()
