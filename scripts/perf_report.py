#!/usr/bin/python3
"""Makes the tables of perf/REPORT.md and of the closing in docs/performance.md, and the plots, from raw results in perf/results/<machine>/. People
write the text of the pages. Without the real jaws the pages go to build/report, as with --quick. The script runs the benchmarks that lack results of
this code, so it goes on after an interruption. Results of an earlier commit count if their sources have not changed. Results of code that no commit
holds do not count. It takes some half an hour on two idle cores, and 5 minutes to build.

    scripts/perf_report.py            runs the programs that lack results of this code
    scripts/perf_report.py --fresh    runs all again
    scripts/perf_report.py --fill     makes the tables from the results as they are, and runs nothing
    scripts/perf_report.py --quick    shows that all of it runs, in 3 minutes once built: few rounds, large voxels; all files go to build/report

    IST_DATA_DIR=FOLDER    the folder of the real jaws, by default ../shared/data; without it the built-in jaws are used

A table of a page stands between `<!-- NAME table -->` and `<!-- end of NAME table -->`."""

import re
import sys

from machine import build, machine, refuse
from report import ablation, accuracy, counts, hand, peers, scaling, seed, timing
from report.draw import draw
from report.figures import COUNTERS, ROOT, machine_state, stamp
from report.results import Results
from report.runner import Runner
from report.tables import BLOCK

TABLES = accuracy.TABLES | hand.TABLES | seed.TABLES | ablation.TABLES | peers.TABLES | scaling.TABLES | timing.TABLES
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
    """Returns a page with new tables and the name of the results. A block stays if its program lacks results, or if another script makes it."""
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


def main(options):
    refuse([word for word in options if word not in ("--quick", "--fresh", "--fill")], __doc__)
    quick, here = "--quick" in options, machine()
    folder = ROOT / "build/report/results" / here.results.name if quick else ROOT / here.results
    if "--fill" not in options:
        build("bench", needs=["--peers"])
        Runner(folder, machine().context, quick).run(PROGRAMS, again=quick or "--fresh" in options)
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
