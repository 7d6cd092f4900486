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
of a query alone, trees loaded, unless stated otherwise; a *median* is over *n* queries. Two jaws are a *{pair}*
pair: {triangles}. Lengths are in millimetres. The *closing* moves the lower jaw along z: at dz = 0 teeth are in full
occlusion, at dz = -1.5 they are just apart. In tables and plots, **bold** marks the best of a row or column, or a loss;
the text says which.

A shared machine changes its speed within minutes, so the same query may take different times in different chapters: compare within one.
These measurements took turns, under the same conditions: all bounds of one voxel size in the cost of accuracy, the article's rates, saved
spheres, folding and levels, the parts of the query, and the peers. All others ran one after the other: voxel sizes, gaps,
advice, one worker and two, the loop. The last chapter states the load of the machine.
"""


def description(results, program):
    """Returns the machine, compiler, commit and date of a program's run, as the caption of a plot."""
    c = results.context(program)
    level = c["flags"].split()[:1]
    return ", ".join([c["processor"], f"{c['num_cpus']} cores", "g++ " + c["compiler"].split(") ")[-1], *level, f"commit {c['commit']}", c["date"][:10]])


def made_with(results):
    """Returns the chapter on the machine and the programs."""
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
            "A + after a commit says that the code had changes beside it."]


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
