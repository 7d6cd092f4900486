"""Chapter: how the time and the memory of a query grow."""

import numpy

from report.curves import power
from report.draw import style
from report.text import number, table

PROGRAMS = ["scaling_bench"]
PROGRAM = PROGRAMS[0]

GIB16 = 2**34 / 1e6  # MB
COLOURS = ("#1b9e77", "#d95f02", "#7570b3", "#e7298a")


def chapter(results, pictures):
    """The markdown of the chapter."""
    lines = ["## Scaling", "",
             "Unless stated otherwise, the bodies are the two jaws, in voxels of 0.2 mm with slabs, and one worker "
             "uses the best instruction set. Each time is a median, and each answer was compared with the "
             "scalar query's."]
    for section in (_leaves, _overlap, _conformal, _workers, _memory):
        lines += [""] + section(results, pictures)
    return lines


def _queries(runs):
    """How often each point of a plot was asked."""
    (count,) = {int(run["rounds"]) for run in runs}
    return f"n = {count:,} queries a point"


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
                            _queries(runs))
    sizes = sorted({float(run.parts[1]) for run in runs})
    lines = ["### Against leaves", "",
             f"The same jaws in voxels from {number(max(sizes))} to {number(min(sizes))} mm. Surfaces that cross meet "
             "in a curve, so leaf pairs should grow as the root of the leaves; surfaces that lie on each other as the "
             "leaves themselves. Fitted from 0.8 mm on, by least squares of the logarithms:", ""]
    lines += table(["dz, mm", "time grows as", "tests grow as", "finest, mm", "leaves there", "contacts", "median, µs"],
                   [[dz, f"leaves^{exponent:.2f}", f"leaves^{of_tests:.2f}", last.parts[1], last["leaves"],
                     last["contacts"], last["p50_us"]] for dz, exponent, of_tests, last in fits])
    return lines + ["", picture]


def _overlap(results, pictures):
    runs = results.runs(PROGRAM, "overlap")
    places = [float(run.parts[1]) for run in runs]
    touching = [run for run in runs if run["contacts"] > 0]
    figure, (by_place, by_contacts) = pictures.figure(2)
    by_place.plot(places, [run["p50_us"] for run in runs], **style("slab", label="median"))
    by_place.plot(places, [run["p99_us"] for run in runs], "--", color=style("slab")["color"], label="99 of 100")
    by_place.set(xlabel="dz, mm (0: full occlusion)", ylabel="time of a query, µs", title="Along the closing", ylim=0)
    by_contacts.plot([run["contacts"] for run in touching], [run["p50_us"] for run in touching], "D",
                     color=COLOURS[0], label="median, against contacts")
    slope, start = numpy.polyfit([run["contacts"] for run in touching], [run["p50_us"] for run in touching], 1)
    ends = numpy.array([0, max(run["contacts"] for run in touching)])
    by_contacts.plot(ends, start + slope * ends, "-", color="#555555",
                     label=f"fit: {start:.0f} µs + {1e3 * slope:.0f} ns a contact")
    by_contacts.set(xlabel="contacts (leaf pairs)", ylabel="time of a query, µs", title="Against contacts", ylim=0)
    for axes in (by_place, by_contacts):
        axes.legend(fontsize=7)
    picture = pictures.save(figure, "scaling_overlap", "Time of a query along a closing, and against its contacts",
                            _queries(runs))
    apart, closed = runs[0], runs[-1]
    lines = ["### Against overlap and contacts", "",
             f"The lower jaw closes in steps of 0.25 mm. From a gap of {number(apart['gap_mm'])} mm to full occlusion "
             f"the time grows from {number(apart['p50_us'])} to {number(closed['p50_us'])} µs, "
             f"{number(closed['p50_us'] / apart['p50_us'])} times. Where the jaws touch, it is {number(start, 2)} µs "
             f"and {number(1e3 * slope, 2)} ns a contact, by least squares. The number of pairs of triangles that meet, "
             "found exactly, shows how far they overlap. The gap is the distance of the triangles.", ""]
    lines += table(["dz, mm", "gap, mm", "triangle pairs", "contacts", "tests", "median, µs", "99 of 100, µs",
                    "ns a test"],
                   [[run.parts[1], run["gap_mm"], run["triangle_pairs"], run["contacts"], run["tests"], run["p50_us"],
                     run["p99_us"], 1e3 * run["p50_us"] / run["tests"]] for run in runs])
    return lines + ["", picture]


def _conformal(results, pictures):
    runs = results.runs(PROGRAM, "conformal")
    figure, (time, contacts) = pictures.figure(2)
    rows = []
    kinds = [(kind, gap) for kind in ("plates", "shells") for gap in ("0.05", "0.5")]
    for (kind, gap), colour, mark in zip(kinds, COLOURS, "DosP"):
        own = [run for run in runs if run.parts[1:3] == [kind, gap]]
        area, times = [run["area_mm2"] for run in own], [run["p50_us"] for run in own]
        exponent, factor = power(area, times)
        time.loglog(area, times, "-" + mark, color=colour, label=f"{kind}, {gap} mm apart: area^{exponent:.2f}")
        met = [(run["area_mm2"], run["contacts"]) for run in own if run["contacts"] > 0]
        if met:
            contacts.loglog(*zip(*met), "-" + mark, color=colour, label=f"{kind}, {gap} mm apart")
        last = own[-1]
        rows.append([f"{kind}, {gap} mm", f"area^{exponent:.2f}", last["area_mm2"], last["leaves"], last["contacts"],
                     last["tests"], 1e-3 * last["p50_us"], 1e3 * last["p50_us"] / last["tests"],
                     (1000 / factor) ** (1 / exponent)])
    time.axhline(1000, color="#555555", linestyle=":", label="1 ms")
    time.set(ylabel="time of a query, µs", title="Time against area (medians)")
    contacts.set(ylabel="contacts (leaf pairs)", title="Contacts against area")
    for axes in (time, contacts):
        axes.set_xlabel("area that lies along the other body, mm²")
        axes.legend(fontsize=7)
    picture = pictures.save(figure, "scaling_conformal", "Time and contacts against conformal area, log-log",
                            _queries(runs))
    worst = max(runs, key=lambda run: run["p50_us"])
    lines = ["### Against conformal area", "",
             "Surfaces that lie along each other have the most contacts: two square plates, and a sphere in "
             "a shell. Leaves within reach of each other are contacts, so the nearer surface has many times more. The "
             f"worst here, {worst.parts[1]} {worst.parts[2]} mm apart on {number(worst['area_mm2'])} mm², takes "
             f"**{number(1e-3 * worst['p50_us'])} ms**: such a query needs a budget. The last column gives the area at which the "
             "fitted power reaches 1 ms.", ""]
    lines += table(["bodies", "time grows as", "largest area, mm²", "leaves", "contacts", "tests", "median, ms",
                    "ns a test", "1 ms by the fit, mm²"], rows)
    return lines + ["", picture]


def _workers(results, pictures):
    runs = {tuple(run.parts[1:]): run for run in results.runs(PROGRAM, "workers")}
    places = [key[2] for key in runs if key[:2] == ("1", "row")]
    figure, panels = pictures.figure(2)
    rows = []
    for axes, pace, title in zip(panels, ("row", "paced"), ("Back to back", "Paced at 1 kHz")):
        for workers, colour, mark in (("1", COLOURS[2], "^"), ("2", COLOURS[0], "D")):
            own = [runs[workers, pace, dz] for dz in places]
            name = f"{workers} worker" + "s" * (workers == "2")
            axes.plot([float(dz) for dz in places], [run["p50_us"] for run in own], "-" + mark, color=colour,
                      label=f"{name}: median")
            axes.plot([float(dz) for dz in places], [run["p99_us"] for run in own], "--", color=colour,
                      label=f"{name}: 99 of 100")
        axes.set(xlabel="dz, mm (0: full occlusion)", ylabel="time of a query, µs", title=title, ylim=0)
        axes.legend(fontsize=7)
        for dz in places:
            one, two = runs["1", pace, dz], runs["2", pace, dz]
            gain = one["p50_us"] / two["p50_us"]
            alone = number(one["p50_us"])
            rows.append(["paced" if pace == "paced" else "back to back", dz, f"**{alone}**" if gain < 1 else alone,
                         two["p50_us"], gain, one["p99_us"], two["p99_us"], f"{100 * two['worth']:.0f} %",
                         f"{100 * two['shared']:.0f} %"])
    picture = pictures.save(figure, "scaling_workers", "Time of a query by workers, along the closing",
                            _queries(runs.values()))
    lines = ["### One worker and two", "",
             "The second worker polls when a query is expected, and no query waits for it. Queries with too little work "
             "are not offered to it. Where one worker is the faster, its time is bold.", ""]
    lines += table(["queries", "dz, mm", "one, µs", "two, µs", "times faster", "one, 99 of 100", "two, 99 of 100",
                    "worth sharing", "shared"], rows)
    return lines + ["", picture]


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


def _memory(results, pictures):
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
    return (f"{limit} So the extrapolation was tested at three quarters of it: both jaws with `table`, voxels of "
            f"{run['voxel_size']:.4f} mm and a `max_memory` of 16 GiB, built in {number(run['build_s'])} s, have "
            f"{number(run['leaves'] / 1e6)} million leaves. Building took {number(run['peak_MB'])} MB; the line "
            f"predicts {number(peak)} ({off[0]:+.1f} %). Holding took {number(_held(run))} MB; it predicts {number(held)} "
            f"({off[1]:+.1f} %): {verdict} {worst:.0f} %. A query in full occlusion takes "
            f"{number(1e-3 * run['p50_us'])} ms there, with {number(run['contacts'])} contacts and "
            f"{number(run['tests'])} tests (median of {int(run['rounds'])}).")
