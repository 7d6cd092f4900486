"""Tables and plots of how the time and the memory of a query grow."""

import statistics

from report.draw import LOG, line, panel, plot, style
from report.tables import Table, is_loss, part, power, row, runs, scaled

PROGRAM = "scaling_bench"
COLOURS = ("#1b9e77", "#d95f02", "#7570b3", "#e7298a")
TICK = 1000  # µs, of a haptic loop at 1 kHz
GIB16 = 2**34 / 1e6  # MB
PACES = {"row": "back to back", "paced": "paced"}
NS_A_TEST = ("ns a test", lambda r: 1e3 * r["p50_us"] / r["tests"])


def queries(found):
    return f"n = {int(found[0]['rounds']):,} queries a point"


def fits(results, program):
    """Yields how time and tests grow with the leaves at each pose, in voxels of 0.8 mm and finer. The call itself takes most of the time in
    coarser ones."""
    for dz in ("0", "-1.5"):
        own = [run for run in results.runs(program, "leaves") if run.parts[2] == dz]
        fine = [run for run in own if float(run.parts[1]) <= 0.8]
        (exponent, factor), (tests, _) = (power([r["leaves"] for r in fine], [r[key] for r in fine]) for key in ("p50_us", "tests"))
        yield row(own[-1]["name"], dz=dz, exponent=exponent, factor=factor, tests_grow=tests, last=own[-1], own=own, fine=fine)


def last(counter):
    return lambda r: r["last"][counter]


def conformal(results, program):
    """The largest area of each kind of bodies, with the power that fits the times."""
    for kind in ("plates", "shells"):
        for gap in ("0.05", "0.5"):
            own = [run for run in results.runs(program, "conformal") if run.parts[1:3] == [kind, gap]]
            exponent, factor = power([r["area_mm2"] for r in own], [r["p50_us"] for r in own])
            yield row(f"{kind}, {gap} mm", last=own[-1], own=own, exponent=exponent, tick_at=(TICK / factor) ** (1 / exponent))


def workers(results, program):
    found = {tuple(run.parts[1:]): run for run in results.runs(program, "workers")}
    return [row(f"{PACES[pace]}/{dz}", one=one, two=two, gain=one["p50_us"] / two["p50_us"])
            for pace in PACES for count, at, dz in found if (count, at) == ("1", "row")
            for one, two in [(found["1", pace, dz], found["2", pace, dz])]]


def held(run):
    return run["trees_MB"] + run["query_MB"]


def peak(run):
    return run["peak_MB"]


class Line:
    """Megabytes over 1/size², through the two finest pairs of jaws: a surface's leaves grow as 1/size²."""

    def __init__(self, found, megabytes):
        ends = sorted(found, key=part(2))[:2]
        self.slope, self.start = statistics.linear_regression([part(2)(run) ** -2 for run in ends], [megabytes(run) for run in ends])

    def at(self, size):
        return self.start + self.slope * size**-2

    def size_of(self, megabytes):
        return ((megabytes - self.start) / self.slope) ** -0.5


def memory(results, program):
    for policy in ("table", "slab"):
        found = results.runs(program, "memory", policy)
        lines = {of: Line(found, of) for of in (peak, held)}
        yield row(policy, own=found, last=found[-1], size=found[-1].parts[2], **{of.__name__: on for of, on in lines.items()})


def largest(results, program):
    """Returns the largest pair that was built, beside the prediction by the line through smaller ones."""
    run, (table, _) = results.runs(program, "largest")[0], memory(results, program)
    if not run["built"]:
        return []
    return [row(name, run=run, took=of(run), line=table[of.__name__].at(run["voxel_size"])) for name, of in (("to build", peak), ("to hold", held))]


TABLES = {
    "leaves": Table(PROGRAM, lambda *given: list(fits(*given)), [
        ("dz, mm", "dz"), ("time grows as", lambda r: f"leaves^{r['exponent']:.2f}"), ("tests grow as", lambda r: f"leaves^{r['tests_grow']:.2f}"),
        ("finest, mm", 1), ("leaves there", last("leaves")), ("leaf pairs", last("contacts")), ("median, µs", last("p50_us"))]),
    "overlap": Table(PROGRAM, runs("overlap"), [
        ("dz, mm", 1), ("gap, mm", "gap_mm"), ("triangle pairs", "triangle_pairs"), ("leaf pairs", "contacts"), ("tests", "tests"),
        ("median, µs", "p50_us"), ("99 of 100, µs", "p99_us"), NS_A_TEST]),
    "conformal": Table(PROGRAM, lambda *given: list(conformal(*given)), [
        ("bodies", 0), ("time grows as", lambda r: f"area^{r['exponent']:.2f}"), ("largest area, mm²", last("area_mm2")), ("leaves", last("leaves")),
        ("leaf pairs", last("contacts")), ("tests", last("tests")),
        ("median, ms", scaled(last("p50_us"), 1e-3), lambda r: r["last"]["p50_us"] > TICK),
        (NS_A_TEST[0], lambda r: NS_A_TEST[1](r["last"])), ("1 ms by the fit, mm²", "tick_at")]),
    "workers": Table(PROGRAM, workers, [
        ("queries", 0), ("dz, mm", lambda r: float(r.parts[1])), ("one, µs", lambda r: r["one"]["p50_us"]),
        ("two, µs", lambda r: r["two"]["p50_us"], lambda r: is_loss(r["gain"])),
        ("times faster", "gain"), ("one, 99 of 100", lambda r: r["one"]["p99_us"]),
        ("two, 99 of 100", lambda r: r["two"]["p99_us"], lambda r: is_loss(r["one"]["p99_us"] / r["two"]["p99_us"])),
        ("worth sharing", lambda r: f"{100 * r['two']['worth']:.0f} %"), ("shared", lambda r: f"{100 * r['two']['shared']:.0f} %")]),
    "memory": Table(PROGRAM, lambda *given: list(memory(*given)), [
        ("spheres", 0), ("finest, mm", "size"), ("leaves", last("leaves")), ("trees, MB", last("trees_MB")), ("query, MB", last("query_MB")),
        ("peak, MB", last("peak_MB")), ("built in, s", last("build_s")), ("16 GiB to build at, mm", lambda r: f"{r['peak'].size_of(GIB16):.4f}"),
        ("16 GiB to hold at, mm", lambda r: f"{r['held'].size_of(GIB16):.4f}")]),
    "largest pair": Table(PROGRAM, largest, [
        ("`table` at, mm", lambda r: f"{r['run']['voxel_size']:.4f}"), ("leaves", lambda r: r["run"]["leaves"]), ("memory", 0),
        ("measured, MB", "took"), ("by the line, MB", "line"),
        ("off, %", lambda r: f"{100 * (r['took'] / r['line'] - 1):+.1f}", lambda r: abs(r["took"] / r["line"] - 1) > 0.1),
        ("built in, s", lambda r: r["run"]["build_s"]), ("a query, ms", lambda r: 1e-3 * r["run"]["p50_us"])]),
}


@plot(PROGRAM)
def scaling_leaves(results):
    lines = []
    for fit, colour, mark in zip(fits(results, PROGRAM), COLOURS, "Do"):
        look = {"color": colour, "linestyle": "", "marker": mark}
        lines += [line(fit["own"], "leaves", "p50_us", label=f"dz = {fit['dz']} mm: median", **look),
                  line(fit["own"], "leaves", "p99_us", fillstyle="none", label="99 of 100", **look),
                  line([fit["fine"][0], fit["fine"][-1]], "leaves", lambda r, fit=fit: fit["factor"] * r["leaves"] ** fit["exponent"], color=colour,
                       label=f"fit: leaves^{fit['exponent']:.2f}")]
    return {"n": queries(results.runs(PROGRAM, "leaves")), "panels": [panel(
        lines, legend={"fontsize": 7}, **LOG, xlabel="leaves of both trees", ylabel="time of a query, µs", title="Time against leaves")]}


@plot(PROGRAM)
def scaling_overlap(results):
    found = results.runs(PROGRAM, "overlap")
    pairs, times = zip(*((r["contacts"], r["p50_us"]) for r in found if r["contacts"] > 0))
    slope, start = statistics.linear_regression(pairs, times)
    look, dz = style("slab", label="median"), part(1)
    common = {"legend": {"fontsize": 7}, "ylim": 0, "ylabel": "time of a query, µs"}
    return {"n": queries(found), "panels": [
        panel([line(found, dz, "p50_us", **look), line(found, dz, "p99_us", linestyle="--", color=look["color"], label="99 of 100")],
              xlabel="dz, mm (0: full occlusion)", title="Along the closing", **common),
        panel([(pairs, times, {"linestyle": "", "marker": "D", "color": COLOURS[0], "label": "median, against leaf pairs"}),
               ([0, max(pairs)], [start, start + slope * max(pairs)],
                {"color": "#555555", "label": f"fit: {start:.0f} µs + {1e3 * slope:.0f} ns a leaf pair"})],
              xlabel="leaf pairs", title="Against leaf pairs", **common)]}


@plot(PROGRAM)
def scaling_conformal(results):
    kinds = [(r, {"color": colour, "marker": mark}) for r, colour, mark in zip(conformal(results, PROGRAM), COLOURS, "DosP")]
    common = {"legend": {"fontsize": 7}, "xlabel": "area that lies along the other body, mm²", **LOG}
    return {"n": queries(results.runs(PROGRAM, "conformal")), "panels": [
        panel([line(r["own"], "area_mm2", "p50_us", label=f"{r.parts[0]} apart: area^{r['exponent']:.2f}", **look) for r, look in kinds],
              [("axhline", TICK, {"color": "#555555", "linestyle": ":", "label": "1 ms"})],
              ylabel="time of a query, µs", title="Time against area (medians)", **common),
        panel([line(met, "area_mm2", "contacts", label=f"{r.parts[0]} apart", **look) for r, look in kinds
               for met in [[one for one in r["own"] if one["contacts"] > 0]] if met],
              ylabel="leaf pairs", title="Leaf pairs against area", **common)]}


@plot(PROGRAM)
def scaling_workers(results):
    found = results.runs(PROGRAM, "workers")
    return {"n": queries(found), "panels": [panel(
        [line([r for r in found if r.parts[1:3] == [count, pace]], part(3), counter,
              **look | {"color": colour, "label": f"{count} worker{'s' * (count == '2')}: {words}"})
         for count, colour, mark in (("1", COLOURS[2], "^"), ("2", COLOURS[0], "D"))
         for counter, words, look in (("p50_us", "median", {"marker": mark}), ("p99_us", "99 of 100", {"linestyle": "--"}))],
        legend={"fontsize": 7}, xlabel="dz, mm (0: full occlusion)", ylabel="time of a query, µs", title=title, ylim=0)
        for pace, title in (("row", "Back to back"), ("paced", "Paced at 1 kHz"))]}


@plot(PROGRAM)
def scaling_memory(results):
    lines, size = [], part(2)
    for r in memory(results, PROGRAM):
        begin, end = min(map(size, r["own"])), min(r[of].size_of(GIB16) for of in ("peak", "held"))
        reach = [begin * (end / begin) ** (i / 19) for i in range(20)]
        lines += [line(r["own"], size, peak, **style(r.parts[0], label=f"{r.parts[0]}: to build", linestyle="")),
                  line(r["own"], size, held, **style(r.parts[0], label="to hold", linestyle="", fillstyle="none")),
                  (reach, [r["peak"].at(at) for at in reach], {"linestyle": ":", "color": style(r.parts[0])["color"]})]
    run = results.runs(PROGRAM, "largest")[0]
    built = [([run["voxel_size"]], [run["peak_MB"]], {"marker": "*", "linestyle": "", "color": "#000000", "markersize": 10, "label": "table: built"})]
    return {"n": "n = 1 building a point; dotted: a line over 1/size² through the two finest, extrapolated",
            "then": lambda _, all_axes: all_axes[0].invert_xaxis(), "panels": [panel(
                lines + built * bool(run["built"]), [("axhline", GIB16, {"color": "#555555", "label": "16 GiB"})], {"fontsize": 7}, **LOG,
                xlabel="voxel size, mm", ylabel="memory of both jaws, MB (10⁶ bytes)", title="Memory by voxel size")]}
