"""Section of scaling: the memory to build and to hold both jaws, and the finest voxels that 16 GiB allow."""

import numpy

from report.styles import style
from report.text import number, table

PROGRAM = "scaling_bench"
GIB16 = 2**34 / 1e6  # MB


class _Line:
    """Megabytes over 1/size², through the two finest pairs of jaws: a surface's leaves grow as 1/size²."""

    def __init__(self, runs, megabytes):
        (coarse, fine) = sorted(runs, key=lambda run: -float(run.parts[2]))[-2:]
        x, y = [float(run.parts[2]) ** -2 for run in (coarse, fine)], [megabytes(run) for run in (coarse, fine)]
        self.slope = (y[1] - y[0]) / (x[1] - x[0])
        self.start = y[1] - self.slope * x[1]

    def at(self, size):
        return self.start + self.slope * size**-2

    def size_of(self, megabytes):
        return ((megabytes - self.start) / self.slope) ** -0.5


def _held(run):
    return run["trees_MB"] + run["query_MB"]


def section(results, pictures):
    largest = results.runs(PROGRAM, "largest")[0]
    figure, axes = pictures.figure()
    rows, lines_of = [], {}
    for policy in ("table", "slab"):
        runs = results.runs(PROGRAM, "memory", policy)
        sizes = numpy.array([float(run.parts[2]) for run in runs])
        peak, held = lines_of[policy] = _Line(runs, lambda run: run["peak_MB"]), _Line(runs, _held)
        axes.loglog(sizes, [run["peak_MB"] for run in runs], **style(policy, label=f"{policy}: to build", linestyle=""))
        axes.loglog(sizes, [_held(run) for run in runs],
                    **style(policy, label="to hold", linestyle="", fillstyle="none"))
        reach = numpy.geomspace(min(sizes), min(peak.size_of(GIB16), held.size_of(GIB16)), 20)
        axes.loglog(reach, [peak.at(size) for size in reach], ":", color=style(policy)["color"])
        finest = runs[-1]
        rows.append([policy, finest.parts[2], finest["leaves"], finest["trees_MB"], finest["query_MB"],
                     finest["peak_MB"], finest["build_s"], f"{peak.size_of(GIB16):.4f}", f"{held.size_of(GIB16):.4f}"])
    if largest["built"]:
        axes.loglog([largest["voxel_size"]], [largest["peak_MB"]], "*", color="#000000", markersize=10,
                    label="table: built")
    axes.axhline(GIB16, color="#555555", label="16 GiB")
    axes.invert_xaxis()
    axes.set(xlabel="voxel size, mm", ylabel="memory of both jaws, MB (10⁶ bytes)", title="Memory by voxel size")
    axes.legend(fontsize=7)
    picture = pictures.save(figure, "scaling_memory", "Memory to build and to hold both jaws by voxel size, log-log",
                            "n = 1 building a point; dotted: a line over 1/size² through the two finest, extrapolated")
    lines = ["### The largest pair in 16 GiB", "",
             "\"To build\" is the peak memory while one jaw was built after the other; \"to hold\" is both trees and "
             "one query. The leaves of a surface grow as 1/size², so both are extrapolated by a line over 1/size² through the "
             "two finest voxel sizes of each policy. The last two columns are values of that line, not measurements.", ""]
    lines += table(["spheres", "finest, mm", "leaves", "trees, MB", "query, MB", "peak, MB", "built in, s",
                    "16 GiB to build at, mm", "16 GiB to hold at, mm"], rows)
    return lines + ["", _largest(largest, lines_of["table"]), "", picture]


def _largest(run, line):
    limit = "`max_memory` limits each tree by an estimate made before it is built, so a pair " \
        "may be refused before it needs that much."
    if not run["built"]:
        return f"{limit} No pair near the limit was built ({run['label']}), so the extrapolation is not tested here."
    peak, held = (one.at(run["voxel_size"]) for one in line)
    off = 100 * (run["peak_MB"] / peak - 1), 100 * (_held(run) / held - 1)
    worst = max(abs(part) for part in off)
    verdict = "it was right to within" if worst <= 10 else "**it was wrong by up to**"
    return (f"{limit} So the extrapolation was tested at {100 * run['part_of_limit']:.0f} % of it: both jaws with `table`, voxels of "
            f"{run['voxel_size']:.4f} mm and a `max_memory` of 16 GiB, built in {number(run['build_s'])} s, have "
            f"{number(run['leaves'] / 1e6)} million leaves. Building took {number(run['peak_MB'])} MB; the line "
            f"predicts {number(peak)} ({off[0]:+.1f} %). Holding took {number(_held(run))} MB; it predicts {number(held)} "
            f"({off[1]:+.1f} %): {verdict} {worst:.0f} %. A query in full occlusion takes "
            f"{number(1e-3 * run['p50_us'])} ms there, with {number(run['contacts'])} leaf pairs and "
            f"{number(run['tests'])} tests (median of {int(run['rounds'])}).")
