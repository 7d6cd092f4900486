"""Makes the report: see scripts/perf_report.sh, which runs this."""

import pathlib
import sys

from report import ablation, accuracy, closing, guard, loop, peers, scaling, seed
from report.draw import Pictures
from report.results import Results
from report.runner import Runner
from report.text import table

CHAPTERS = [accuracy, seed, ablation, peers, scaling, loop, guard]
HEAD = """# What accuracy costs in time

Made by `scripts/perf_report.sh` from the raw results in `{results}`; no number in it is typed by hand. Times are wall times
of a query alone, trees loaded, unless said otherwise; a *median* is of so many queries as *n* says. Two jaws are a *{pair}*
pair: {triangles}. Lengths are in millimetres. The *closing* moves the lower jaw along z: at dz = 0 teeth stand in full
occlusion, at dz = -1.5 they are just apart. In tables and plots, what is **bold** is best in its row or column, or a loss
that is meant to be seen: the text says which.

A machine that is shared changes its speed within minutes, so the same query may take other times in other chapters: compare within one.
What took turns, and so met the machine alike, are all bounds of one voxel size in the cost of accuracy, the article's rates, saved
spheres, folding and levels, the parts of the query, and the peers. All else was measured one after the other: voxel sizes, gaps,
advice, one worker and two, the loop. How busy the machine was stands at the end.
"""


def description(results, program):
    """What a program ran on, in a line for under a plot."""
    c = results.context(program)
    level = c["flags"].split()[:1]
    return ", ".join([c["processor"], f"{c['num_cpus']} cores", "g++ " + c["compiler"].split(") ")[-1], *level, f"commit {c['commit']}", c["date"][:10]])


def made_with(results):
    """Where every number comes from."""
    rows = []
    for program in programs():
        c = results.context(program)
        load = ", ".join(f"{value:.1f}" for value in c["load_avg"])
        rows.append([f"`{program}`", c["commit"], c["date"][:16].replace("T", " "), float(c["seconds"]), load])
    first = results.context(seed.PROGRAMS[0])
    caches = ", ".join(f"L{c['level']} {c['type'].lower()} {c['size'] // 1024} KiB" for c in first["caches"])
    return ["## What it was made with", "",
            f"{first['processor']}, {first['num_cpus']} cores at {first['mhz_per_cpu']} MHz; {caches}. "
            f"{first['compiler']}; `{first['flags']}`.", "",
            *table(["program", "commit", "begun", "seconds", "load when it began (1, 5, 15 minutes)"], rows), "",
            "A commit with a + had other code than it names."]


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
        lines += [*chapter.chapter(results, Pictures(folder, machine)), ""]
    lines += made_with(results)
    report = out / "REPORT.md"
    report.write_text("\n".join(lines) + "\n")
    if not quick:
        closing.update(results, description(results, "ablation_bench"))
    print(f"perf_report: {report}", file=sys.stderr)


if __name__ == "__main__":
    main()
