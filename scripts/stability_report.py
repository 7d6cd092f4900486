#!/usr/bin/python3
"""Makes perf/STABILITY.md: tries the hard cases many more times than a run of all tests does, and shows the worst error of each
beside the guarantee. Some 20 minutes on two cores.

    scripts/stability_report.py                10 million queries of real jaws, 20 times the other samples
    scripts/stability_report.py --quick        as many as in a run of all tests, written to build/stability
    scripts/stability_report.py --out FOLDER   written there instead of perf/"""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

from machine import build, machine, refuse
from report.draw import pyplot
from report.figures import ROOT, here, stamp
from report.tables import fill, markdown

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
    """Returns the worst error over its bound, or None if the case is right or wrong."""
    if not case["bound"]:
        return None
    return math.inf if case["worst"] is None else case["worst"] / case["bound"]


def number(value):
    return "no number" if value is None else f"{value:.3g}"


def table(cases):
    rows = [[case["name"], f"{case['samples']:,}", case["error"], number(case["worst"]), number(case["bound"]),
             number(ratio(case)) if case["bound"] else ""] for case in cases]
    return markdown(["case", "samples", "error", "worst", "bound", "worst / bound"], rows, right=(1, 3, 4, 5))


def plot(cases, file):
    shown = [case for case in cases if ratio(case) is not None]
    plt = pyplot()
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
    figure.savefig(file, metadata={"Date": None})


def tried(cases, effort, load_effort):
    """Runs the hard cases, which add their lines to a file. Returns whether each program passed."""
    cases.unlink(missing_ok=True)
    environment = {"IST_DATA_DIR": str(ROOT.parent / "shared/data"), **os.environ, "IST_STABILITY": str(cases)}

    def begin(effort, program, tests):
        print(f"== {program} {tests}, {effort} times the samples", file=sys.stderr)
        return subprocess.Popen([f"build/test/tests/{program}", "--gtest_brief=1", f"--gtest_filter={tests}"],
                                env={**environment, "IST_EFFORT": str(effort)}, stdout=sys.stderr)

    load = begin(load_effort, "load_test", "*")
    try:
        # Cases that break their guarantee are shown too.
        codes = [begin(*each).wait() for each in (
            (effort, "stability_test", "*"), (effort, "search_test", "SharedTreeThread.*"), (effort, "fuzz_test", "*"),
            (1, "cli_test", "Faults*:CutFiles*:Interruption*:SweepCommand*"))]
        return not any([*codes, load.wait()])
    finally:
        load.kill()


def main():
    words = sys.argv[1:]
    folder, efforts = PAGE.parent, (20, 1000)
    if words == ["--quick"]:
        folder, efforts = ROOT / "build/stability", (1, 1)
    elif len(words) == 2 and words[0] == "--out":
        folder = pathlib.Path(words[1]).resolve()
    else:
        refuse(words, __doc__)
    build("test", "stability_test", "load_test", "search_test", "fuzz_test", "cli_test", needs=["--tests", "--bench"])
    file, on = pathlib.Path(os.environ.get("IST_STABILITY", ROOT / "build/stability.jsonl")), machine()
    passed, results = tried(file, *efforts), folder / "results" / on.results.name
    for made in (results, folder / "pictures"):
        made.mkdir(parents=True, exist_ok=True)
    shutil.copy(file, results / "stability.jsonl")
    # The cases of a group stay in the order of the tests.
    cases = sorted(map(json.loads, file.open()), key=lambda case: list(GROUPS).index(case["group"]))
    plot(cases, folder / "pictures/stability.svg")
    broken = [case for case in cases if case["broken"]]
    lines = [f"{on.model}, {os.cpu_count()} cores; {on.compiler}; commit {on.commit}. {len(cases)} cases, "
             f"{sum(c['samples'] for c in cases):,} samples, {len(broken)} broken.", "",
             "![The worst error of each case over its bound](pictures/stability.svg)", ""]
    for group, title in GROUPS.items():
        chosen = [case for case in cases if case["group"] == group]
        if chosen:
            lines += [f"## {title}", "", *table(chosen), "", stamp(*here(), "stability_report.py"), ""]
    if folder.resolve() != PAGE.parent:
        shutil.copy(PAGE, folder)
    fill(folder / PAGE.name, "cases", "\n".join(lines))
    if broken or not passed:
        sys.exit(f"stability_report: {len(broken)} cases break their guarantee" if broken else "stability_report: a test failed")


if __name__ == "__main__":
    main()
