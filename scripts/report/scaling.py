"""Chapter: how the time and the memory of a query grow."""

import numpy

from report import scaling_conformal, scaling_memory, scaling_workers
from report.curves import power
from report.scaling_asked import COLOURS, queries
from report.styles import style
from report.text import number, table

PROGRAMS = ["scaling_bench"]
PROGRAM = PROGRAMS[0]


def chapter(results, pictures):
    """The markdown of the chapter."""
    lines = ["## Scaling", "",
             f"Unless stated otherwise, the bodies are the two jaws, in voxels of {_voxel_size(results)} mm with slabs, and one worker "
             "uses the best instruction set. Each time is a median, and each answer was compared with the "
             "scalar query's."]
    for section in (_leaves, _overlap, scaling_conformal.section, scaling_workers.section, scaling_memory.section):
        lines += [""] + section(results, pictures)
    return lines


def _voxel_size(results):
    (size,) = {run["voxel_size"] for kind in ("overlap", "conformal", "workers") for run in results.runs(PROGRAM, kind)}
    return f"{size:g}"


def _leaves(results, pictures):
    runs = results.runs(PROGRAM, "leaves")
    figure, axes = pictures.figure()
    fits = []
    for dz, colour, mark in (("0", COLOURS[0], "D"), ("-1.5", COLOURS[1], "o")):
        own = [run for run in runs if run.parts[2] == dz]
        leaves, times = [run["leaves"] for run in own], [run["p50_us"] for run in own]
        # Where it is coarse, the first levels and the call itself are most of the time.
        fine = [i for i, run in enumerate(own) if float(run.parts[1]) <= 0.8]
        exponent, factor = power([leaves[i] for i in fine], [times[i] for i in fine])
        axes.loglog(leaves, times, mark, color=colour, label=f"dz = {dz} mm: median")
        axes.loglog(leaves, [run["p99_us"] for run in own], mark, color=colour, fillstyle="none", label="99 of 100")
        ends = numpy.array([leaves[fine[0]], leaves[fine[-1]]])
        axes.loglog(ends, factor * ends**exponent, "-", color=colour, label=f"fit: leaves^{exponent:.2f}")
        last = own[-1]
        fits.append((dz, exponent, power([leaves[i] for i in fine], [own[i]["tests"] for i in fine])[0], last))
    axes.set(xlabel="leaves of both trees", ylabel="time of a query, µs", title="Time against leaves")
    axes.legend(fontsize=7)
    picture = pictures.save(figure, "scaling_leaves", "Time of a query against the leaves of both trees, log-log",
                            queries(runs))
    sizes = sorted({float(run.parts[1]) for run in runs})
    lines = ["### Against leaves", "",
             f"The same jaws in voxels from {number(max(sizes))} to {number(min(sizes))} mm. Surfaces that cross meet "
             "in a curve, so leaf pairs should grow as the root of the leaves; surfaces that lie on each other as the "
             "leaves themselves. Fitted from 0.8 mm on, by least squares of the logarithms:", ""]
    lines += table(["dz, mm", "time grows as", "tests grow as", "finest, mm", "leaves there", "leaf pairs", "median, µs"],
                   [[dz, f"leaves^{exponent:.2f}", f"leaves^{of_tests:.2f}", last.parts[1], last["leaves"],
                     last["contacts"], last["p50_us"]] for dz, exponent, of_tests, last in fits])
    return lines + ["", picture]


def _overlap(results, pictures):
    runs = results.runs(PROGRAM, "overlap")
    places = [float(run.parts[1]) for run in runs]
    touching = [run for run in runs if run["contacts"] > 0]
    figure, (by_place, by_pairs) = pictures.figure(2)
    by_place.plot(places, [run["p50_us"] for run in runs], **style("slab", label="median"))
    by_place.plot(places, [run["p99_us"] for run in runs], "--", color=style("slab")["color"], label="99 of 100")
    by_place.set(xlabel="dz, mm (0: full occlusion)", ylabel="time of a query, µs", title="Along the closing", ylim=0)
    by_pairs.plot([run["contacts"] for run in touching], [run["p50_us"] for run in touching], "D",
                  color=COLOURS[0], label="median, against leaf pairs")
    slope, start = numpy.polyfit([run["contacts"] for run in touching], [run["p50_us"] for run in touching], 1)
    ends = numpy.array([0, max(run["contacts"] for run in touching)])
    by_pairs.plot(ends, start + slope * ends, "-", color="#555555",
                  label=f"fit: {start:.0f} µs + {1e3 * slope:.0f} ns a leaf pair")
    by_pairs.set(xlabel="leaf pairs", ylabel="time of a query, µs", title="Against leaf pairs", ylim=0)
    for axes in (by_place, by_pairs):
        axes.legend(fontsize=7)
    picture = pictures.save(figure, "scaling_overlap", "Time of a query along a closing, and against its leaf pairs",
                            queries(runs))
    apart, closed = runs[0], runs[-1]
    lines = ["### Against overlap and leaf pairs", "",
             f"The lower jaw closes in steps of {number(places[1] - places[0])} mm. From a gap of {number(apart['gap_mm'])} mm to full occlusion "
             f"the time grows from {number(apart['p50_us'])} to {number(closed['p50_us'])} µs, "
             f"{number(closed['p50_us'] / apart['p50_us'])} times. Where the jaws touch, it is {number(start, 2)} µs "
             f"and {number(1e3 * slope, 2)} ns a leaf pair, by least squares. The number of pairs of triangles that meet, "
             "found exactly, shows how far they overlap. The gap is the distance of the triangles.", ""]
    lines += table(["dz, mm", "gap, mm", "triangle pairs", "leaf pairs", "tests", "median, µs", "99 of 100, µs",
                    "ns a test"],
                   [[run.parts[1], run["gap_mm"], run["triangle_pairs"], run["contacts"], run["tests"], run["p50_us"],
                     run["p99_us"], 1e3 * run["p50_us"] / run["tests"]] for run in runs])
    return lines + ["", picture]
