"""Makes the report: see scripts/perf_report.sh, which runs this."""

import pathlib
import sys

from report import ablation, accuracy, bodies, closing, coherent, deadlines, guard, loop, measures, peers, scaling, seed, sweeps
from report.draw import Pictures
from report.figures import machine_state, stamp, stamped
from report.made_with import made_with
from report.results import Results
from report.runner import Runner

CHAPTERS = [accuracy, coherent, measures, seed, ablation, peers, scaling, deadlines, loop, bodies, sweeps, guard]
HEAD = """# What accuracy costs in time

Made by `scripts/perf_report.sh` from the raw results in `{results}`; no measured number in it is typed by hand, \
but for the times of peers that were built elsewhere, which say so. Times are wall times
of a query alone, trees loaded, unless stated otherwise; a *median* is over *n* queries. Two jaws are a *{pair}*
pair: {triangles}. Lengths are in millimetres. The *closing* moves the lower jaw along z: at dz = 0 teeth are in full
occlusion, at dz = -1.5 they are just apart. In tables and plots, **bold** marks the best of a row or column, or a loss;
the text says which. What is worse by 3 % or more is a loss: less is noise.

A shared machine changes its speed within minutes, so the same query may take different times in different chapters: compare within one.
These measurements took turns, under the same conditions: all bounds of one voxel size in the cost of accuracy, coherent ticks and fresh ones, \
the article's
rates, saved spheres, folding and levels, the parts of the query, the peers, worlds, and sweeps. All others ran one after the other: \
voxel sizes, gaps,
advice, one worker and two, deadlines, the loop. The last chapter states the load of the machine.
"""


def description(results, program):
    """Returns the machine, compiler, commit and date of a program's run, as the caption of a plot."""
    c = results.context(program)
    level = c["flags"].split()[:1]
    return ", ".join([c["processor"], f"{c['num_cpus']} cores", "g++ " + c["compiler"].split(") ")[-1],
                      *level, f"commit {c['commit']}", c["date"][:10]])


def with_stamps(lines, chapter, results):
    """Returns the lines with a stamp below each table: of the program that its section names, or else of the chapter's first."""
    if not chapter.PROGRAMS:
        return lines
    made, begins = [], [0, *(i for i, line in enumerate(lines) if line.startswith("#") and i > 0), len(lines)]
    for begin, end in zip(begins, begins[1:]):
        section = lines[begin:end]
        program = getattr(chapter, "SECTIONS", {}).get(section[0].lstrip("# "), chapter.PROGRAMS[0]) if section else None
        context = results.context(program)
        made += stamped(section, stamp(context["commit"], context["date"][:10], program, machine_state(context)))
    return made


def programs():
    return list(dict.fromkeys(program for chapter in CHAPTERS for program in chapter.PROGRAMS))


def main():
    options = {argument for argument in sys.argv[1:] if argument.startswith("--")}
    raw, *context = [argument for argument in sys.argv[1:] if argument not in options]
    quick = "--quick" in options
    raw = pathlib.Path(raw)
    out = pathlib.Path("build/report") if quick else raw.parent.parent
    results_folder = out / "results" / raw.name if quick else raw
    Runner(results_folder, context, quick).run(programs(), again=quick or "--fresh" in options)

    results = Results(results_folder)
    folder = out / "pictures" / "report"
    voxels = results.runs("seed_bench", "voxels")[0]
    first = results.runs("accuracy_bench", "first")[0]
    lines = [HEAD.format(results=results_folder.relative_to(out), pair=first["label"],
                         triangles=f"the lower jaw has {voxels['triangles']:,.0f} triangles and is {voxels['extent']:.0f} mm long")]
    if quick:
        lines += ["**A quick run: it shows that everything runs, and no number in it counts.**", ""]
    for chapter in CHAPTERS:
        machine = description(results, chapter.PROGRAMS[0]) if chapter.PROGRAMS else ""
        lines += [*with_stamps(chapter.chapter(results, Pictures(folder, machine)), chapter, results), ""]
    lines += made_with(results, programs())
    report = out / "REPORT.md"
    report.write_text("\n".join(lines) + "\n")
    if not quick:
        closing.update(results, description(results, "ablation_bench"))
    print(f"perf_report: {report}", file=sys.stderr)


if __name__ == "__main__":
    main()
