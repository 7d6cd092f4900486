"""Fills the tables of pages from results, and draws the plots: see scripts/perf_report.sh, which runs this.

A page holds its text. Between `<!-- NAME table -->` and `<!-- end of NAME table -->` stand the lines that the results of NAME give."""

import pathlib
import re
import sys

from report import ablation, accuracy, counts, peers, scaling, seed, timing
from report.draw import draw
from report.figures import COUNTERS, ROOT, machine_state, stamp
from report.results import Results
from report.runner import Runner
from report.tables import BLOCK

TABLES = accuracy.TABLES | seed.TABLES | ablation.TABLES | peers.TABLES | scaling.TABLES | timing.TABLES
PROGRAMS = list(dict.fromkeys(table.program for table in TABLES.values()))
TABLES |= counts.TABLES
PAGES = ("perf/REPORT.md", "docs/performance.md", "perf/HARDWARE.md")


def lines_of(name, results):
    """The lines of a block: a table with its stamp, or what names its own commits."""
    if name == "instructions":
        return timing.instructions()
    if name == "made with":
        return timing.made_with(results, PROGRAMS)
    program = TABLES[name].program
    lines, context = TABLES[name].lines(results), results.context(program)
    state = "" if program in COUNTERS else machine_state(context)
    return [*lines, "", stamp(context["commit"], context["date"][:10], program, state)] if len(lines) > 1 else lines


def filled(text, results):
    """A page with its tables made anew, and the name of the results. A block stays as it is if its program has no results, or if another
    script makes it."""
    known = {f"{name} table" for name, table in TABLES.items() if results.made(table.program)} | {"instructions table"}
    if all(map(results.made, PROGRAMS)):
        known.add("made with table")
        text = re.sub(r"`results/[^`]*`", f"`results/{results.folder.name}`", text)
    return BLOCK.sub(lambda block: block[0] if block[2] not in known else
                     block[1] + "\n".join(lines_of(block[2].removesuffix(" table"), results)) + "\n" + block[3], text)


def description(results, program):
    """The machine, compiler, commit and date of a program's run, as the caption of a plot."""
    c = results.context(program)
    return ", ".join([c["processor"], f"{c['num_cpus']} cores", "g++ " + c["compiler"].split(") ")[-1], *c["flags"].split()[:1],
                      f"commit {c['commit']}", c["date"][:10]])


def main(arguments):
    options = {argument for argument in arguments if argument.startswith("--")}
    raw, *context = [argument for argument in arguments if argument not in options]
    quick = "--quick" in options
    folder = ROOT / "build/report/results" / pathlib.Path(raw).name if quick else pathlib.Path(raw)
    if "--fill" not in options:
        Runner(folder, context, quick).run(PROGRAMS, again=quick or "--fresh" in options)
    results = Results(folder)
    # The text of the pages is about the human pair.
    others = results.made("ablation_bench") and results.runs("ablation_bench", "ablation")[0]["label"] != "human"
    out = ROOT / "build/report" if quick or others else ROOT
    for page in PAGES:
        (out / page).parent.mkdir(parents=True, exist_ok=True)
        (out / page).write_text("**A quick run: no number in it counts.**\n\n" * quick + filled((ROOT / page).read_text(), results))
        print(f"perf_report: {out / page}", file=sys.stderr)
    if "--fill" not in options:
        draw(out / "perf/pictures/report", lambda program: description(results, program), results)


if __name__ == "__main__":
    main(sys.argv[1:])
