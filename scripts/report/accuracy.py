"""Tables and plots of the cost of accuracy, of coherent ticks and of measures."""

from report.draw import DOTTED, LOG, line, panel, plot, style
from report.results import Run
from report.tables import POLICIES, Table, between, code, is_loss, number, part, ratio, row, runs, scaled, value_of

BUDGET = 300  # µs, of the first question
WANTED = 0.1  # mm, of the second
TICK = 1000  # µs, of a haptic loop at 1 kHz
NAMES = {"exact": "pairs of triangles", "touches": "whether triangles meet"}
HERTZ = ("rate, Hz", lambda r: 1e6 / r["p50_us"])


size = part(1)


def first(results, policy):
    """Returns the errors and times at first contact by a policy, voxel size by voxel size."""
    return [run for run in results.runs("accuracy_bench", "first") if run.parts[2] == policy]


def curve(results, policy, x, y):
    """Returns points of two counters at first contact."""
    return sorted((value_of(run, x), value_of(run, y)) for run in first(results, policy))


def within_budget(results, _program):
    found = []
    for policy in POLICIES:
        error, at = (between(curve(results, policy, "p50_us", y), BUDGET) for y in ("error_max", size))
        if error is None:
            coarsest, *_, finest = curve(results, policy, "p50_us", "error_max")
            error = f"over {number(coarsest[1])}" if coarsest[0] > BUDGET else f"{number(finest[1])} or better"
        found.append(row(policy, policy=f"`{policy}`", error=error, size=number(at, 2) if at else "beyond the measured ones", time=BUDGET))
    return [*found, *(row(name, policy=NAMES[name], error="0", size="any", time=first(results, name)[0]["p50_us"]) for name in NAMES)]


def for_wanted(results, _program):
    found = []
    for policy in POLICIES:
        at = {y: between(curve(results, policy, "error_max", y), WANTED) for y in (size, "p50_us", "MB", "build_ms")}
        if at[size] is None:
            best = curve(results, policy, "error_max", "p50_us")[0][0]
            found.append(row(policy, **dict.fromkeys(("time", "rate", "MB", "s"), ""), size=f"not reached: {number(best)} mm with the finest"))
        else:
            found.append(row(policy, size=number(at[size], 2), time=at["p50_us"], rate=1e6 / at["p50_us"], MB=at["MB"], s=at["build_ms"] / 1e3))
    return found


def advice(results, program):
    curves = {"error": curve(results, "slab", size, "error_max"), "budget": curve(results, "slab", size, "p50_us")}
    return [Run(run | {f"curve_{key}": between(points, run["voxel_size"]) or "beyond what was measured" for key, points in curves.items()})
            for run in results.runs(program, "advise")]


def exceeds(kind):
    return lambda r: r.parts[1] == kind and not isinstance(r[f"curve_{kind}"], str) and r[f"curve_{kind}"] > float(r.parts[2])


def farther_off(key):
    """Whether a force is farther off than the force by the voxels' balls of the same size."""
    def rule(r):
        ball, = (other for other in r.rows if other.parts[1:3] == [r.parts[1], "simple"])
        return r[key] and is_loss(ball[key] / r[key])
    return rule


def motion(r):
    name = " ".join(r.parts[2:-1]).replace("_s", "/s").replace("_", " ").replace("mm/s", " mm/s")
    return f"{name} at {r.parts[1]} mm" + (" with two workers" if r.parts[-1] == "2" else "")


def by_tolerance(results, question):
    """The run of the slowest pose for each tolerance, from the coarsest to the finest."""
    found = {}
    for run in results.runs("measure_bench", "by_accuracy", question):
        found.setdefault(float(run.parts[2]), []).append(run)
    return [Run(max(of, key=lambda run: run["p50_us"]) | {"width": max(run["upper"] - run["lower"] for run in of)})
            for _, of in sorted(found.items(), reverse=True)]


QUESTIONS = {"touch": "exact touch", "distance": "distance of the surfaces", "depth": "penetration depth"}
OTHERS = {"distances": "vertices of both jaws within {reach:g} mm, with their distances", "first_contact": "first contact, to {tolerance:g} mm",
          "occlusion": "occlusion: areas, regions and depths"}

TABLES = {
    "budget": Table("accuracy_bench", within_budget, [
        ("bounds", "policy"), ("largest error, mm", "error"), ("voxel size, mm", "size"), ("slowest pose, µs", "time")]),
    "wanted accuracy": Table("accuracy_bench", for_wanted, [
        ("bounds", code(0)), ("voxel size, mm", "size"), ("slowest pose, µs", "time"), ("rate, Hz", "rate"), ("both trees, MB", "MB"),
        ("to build both, s", "s")]),
    "every accuracy": Table("accuracy_bench", runs("first", sort=lambda r: (-r["error_max"], r["p50_us"])), [
        ("bounds", lambda r: NAMES.get(r.parts[2], f"`{r.parts[2]}`")), ("voxel size, mm", lambda r: "any" if r.parts[2] in NAMES else r.parts[1]),
        ("error, median, mm", "error_p50"), ("error, largest, mm", "error_max"), ("certain bound, mm", "resolution"),
        ("to build both, s", scaled("build_ms", 1e-3)), ("both trees, MB", "MB"), ("slowest pose, µs", "p50_us"),
        ("its 99 of 100, µs", "p99_us"), HERTZ]),
    "advice": Table("advise_bench", advice, [
        ("asked for", lambda r: f"{float(r.parts[2]):g} {'µs' if r.parts[1] == 'budget' else 'mm'}"),
        ("recommended, mm", lambda r: f"{r['voxel_size']:g}"), ("its error, mm", "error"), ("curve, mm", "curve_error", exceeds("error")),
        ("its slowest pose, µs", "slowest_us"), ("curve, µs", "curve_budget", exceeds("budget")), ("sizes tried", "sizes"),
        ("seconds", "seconds")]),
    "missed contacts": Table("accuracy_bench", runs("verdict"), [
        ("bounds", code(2)), ("voxel size, mm", 1), ("missed", "missed", lambda r: r["missed"] > 0), ("false", "false"),
        ("leaf pairs, closed", "leaf_pairs"), ("of which false, %", lambda r: 100 * (1 - r["crossing"] / r["leaf_pairs"]))]),
    "depths and normals": Table("accuracy_bench", runs("form"), [
        ("bounds", code(2)), ("voxel size, mm", 1), ("depth error, mean, mm", "depth_mean"), ("largest, mm", "depth_max"),
        ("largest, voxels", lambda r: r["depth_max"] / float(r.parts[1])), ("normal error, mean, °", "normal_mean"), ("largest, °", "normal_max"),
        ("n", "n")]),
    "forces": Table("accuracy_bench", runs("force"), [
        ("bounds", code(2)), ("voxel size, mm", 1), ("direction off by, median, °", "angle_p50", farther_off("angle_p50")),
        ("largest, °", "angle_max", farther_off("angle_max")), ("length off by, median, %", scaled("length_p50", 100), farther_off("length_p50")),
        ("largest, %", scaled("length_max", 100), farther_off("length_max")), ("no force", "none")]),
    "coherent": Table("coherent_bench", runs("ticks", sort=lambda r: (int(r.parts[-1]), r["step_p50_voxels"])), [
        ("motion, voxels", motion), ("motion a tick, voxels", "step_p50_voxels"), ("fresh, median, µs", "fresh_p50_us"),
        ("kept, median, µs", "kept_p50_us", lambda r: is_loss(r["fresh_p50_us"] / r["kept_p50_us"])), ("fresh, slowest, µs", "fresh_max_us"),
        ("kept, slowest, µs", "kept_max_us", lambda r: is_loss(r["fresh_max_us"] / r["kept_max_us"])), ("ticks by search", "by_search"),
        ("by kept pairs", "among_kept"), ("in a clearance", "in_clearance")]),
    "tolerance": Table("measure_bench", lambda results, _: [run for question in QUESTIONS for run in by_tolerance(results, question)], [
        ("question", lambda r: QUESTIONS[r.parts[1]]), ("tolerance, mm", part(2)), ("slowest at dz, mm", 3),
        ("slowest pose, µs", "p50_us", lambda r: r["p50_us"] > TICK), ("its 99 of 100, µs", "p99_us"), HERTZ, ("widest interval, mm", "width")]),
    "warm depth": Table("measure_bench", lambda results, program: [
        r for r in runs("measure", "depth", by=2)(results, program) if r["cold:upper"] > 0], [
        ("dz, mm", 3), ("afresh, µs", "cold:real_time"),
        ("from the last answer, µs", "warm:real_time", lambda r: is_loss(r["cold:real_time"] / r["warm:real_time"])),
        ("points afresh", "cold:points"), ("points from it", "warm:points"), ("depth at least, mm", "cold:lower")]),
    "other measures": Table("measure_bench", lambda results, program: [
        max(results.runs(program, "measure", kind), key=lambda run: run["real_time"]) for kind in OTHERS], [
        ("question", lambda r: OTHERS[r.parts[1]].format(**r)), ("slowest at dz, mm, or motion", 2),
        ("slowest, ms (mean)", scaled("real_time", 1e-3))]),
}


def ways_and_rounds(results):
    run = results.runs("accuracy_bench", "first")[0]
    return f"n = {run['n']:.0f} ways of approach, {run['rounds']:.0f} rounds"


@plot("accuracy_bench")
def accuracy_for_time(results):
    floor = 0.7 * min(run["error_max"] for run in results.runs("accuracy_bench", "first") if run["error_max"] > 0)
    exact = [([first(results, name)[0]["p50_us"]], [floor], style(name, label=f"{words}: error 0", linestyle=""))
             for name, words in (("exact", "all pairs of triangles"), ("touches", "whether triangles meet"))]

    def name_sizes(_, all_axes):
        for run in first(results, "slab") + first(results, "table"):
            all_axes[0].annotate(run.parts[1], (run["p50_us"], run["error_max"]), xytext=(4, 3), textcoords="offset points", fontsize=7)
        all_axes[0].annotate(f"{BUDGET} µs", (BUDGET, floor), xytext=(3, 0), textcoords="offset points", fontsize=8)
    return {"width": 7.6, "height": 4, "n": ways_and_rounds(results), "then": name_sizes, "panels": [panel(
        [*(line(first(results, policy), "p50_us", "error_max", **style(policy)) for policy in POLICIES), *exact], [("axvline", BUDGET, DOTTED)],
        {"title": "bounds; numbers are\nvoxel sizes, mm", "title_fontsize": 8, "loc": "upper left", "bbox_to_anchor": (1, 1)}, **LOG,
        xlabel="slowest pose, µs (median, one worker)", ylabel="largest error at first contact, mm",
        title=f"I have {BUDGET} µs: what accuracy can I have?")]}


@plot("accuracy_bench")
def time_for_accuracy(results):
    title = f"I need {WANTED} mm: what does it take?"
    return {"height": 3.8, "n": ways_and_rounds(results), "then": lambda figure, _: figure.suptitle(title), "panels": [
        panel([line(first(results, policy), "error_max", counter, **style(policy)) for policy in POLICIES], [("axvline", WANTED, DOTTED)], legend,
              **LOG, xlabel="largest error at first contact, mm", ylabel=label)
        for counter, label, legend in (("p50_us", "slowest pose, µs (median)", {}), ("MB", "both trees in memory, MB", None))]}


@plot("accuracy_bench")
def gap_width(results):
    gaps = results.runs("accuracy_bench", "gap")
    distances = sorted({run.parts[3] for run in gaps}, key=float)
    looks = {policy: style(policy) for policy in POLICIES} | {"exact": style("exact", label="with triangles")}
    return {"width": 11, "height": 3.4, "n": f"n = {gaps[0]['n']:.0f} queries a point", "panels": [panel(
        [line([r for r in gaps if r.parts[2].split("-")[0] == name and r.parts[3] == at], "p50_us", "width_p50", **look)
         for name, look in looks.items()],
        legend=None if place else {"fontsize": 7}, **LOG, xlabel="time, µs (median)", title=f"{at} mm apart",
        ylabel="" if place else "width of the interval, mm (median)") for place, at in enumerate(distances)]}


@plot("accuracy_bench")
def gap_by_budget(results):
    given = results.runs("accuracy_bench", "deadline")
    n = f"n = {given[0]['n']:.0f} queries a point, slab, voxels of {given[0]['voxel_size']:g} mm"
    return {"width": 6, "height": 3.8, "n": n, "panels": [panel(
        [line([r for r in given if r.parts[2] == at], size, "width_p50", marker=mark, label=f"{at} mm apart")
         for at, mark in zip(sorted({run.parts[2] for run in given}, key=float), "osD^")], legend={}, **LOG, xlabel="budget, µs",
        ylabel="width of the interval, mm (median)", title="What is known of the gap at a deadline")]}


@plot("coherent_bench")
def coherent_by_motion(results):
    ticks = sorted(results.runs("coherent_bench", "ticks"), key=lambda r: r["step_p50_voxels"])
    counts = [r["ticks"] for r in ticks]
    n = f"n = {number(min(counts))} to {number(max(counts))} ticks a point; above the dotted line keeping pairs loses"
    return {"height": 3.8, "n": n, "panels": [
        panel([line([r for r in ticks if r.parts[-1] == workers], "step_p50_voxels", ratio(f"kept_{counter}", f"fresh_{counter}"), **style(
            colour, linestyle="", marker=mark, label=f"{workers} worker{'s' if workers == '2' else ''}"))
            for workers, mark, colour in (("1", "D", "slab"), ("2", "o", "table"))], [("axhline", 1, DOTTED)], legend, **LOG,
            xlabel="motion of a tick, voxels", title=f"{kind} tick", ylabel="time by kept pairs / fresh")
        for kind, counter, legend in (("median", "p50_us", {}), ("slowest", "max_us", None))]}


@plot("measure_bench")
def measures_by_tolerance(results):
    touch, = by_tolerance(results, "touch")
    return {"width": 7, "height": 3.8, "n": f"n = {touch['n']:.0f} rounds a pose", "panels": [panel(
        [line(by_tolerance(results, question), part(2), "p50_us", **style(look, label=QUESTIONS[question]))
         for question, look in (("distance", "slab"), ("depth", "tight"))],
        [("axhline", touch["p50_us"], {"label": "exact touch", "color": style("touches")["color"]}),
         ("axhline", TICK, DOTTED | {"label": f"a tick of {TICK:,} µs"})], {}, **LOG,
        xlabel="tolerance, mm", ylabel="slowest pose, µs (median, one worker)", title="What an accuracy takes")]}
