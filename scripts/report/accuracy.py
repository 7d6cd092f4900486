"""Chapter: what accuracy costs in time. Errors are measured, never assumed."""

from report import advice
from report.curves import between, power
from report.losses import bold_if, by_reason, is_loss
from report.styles import style
from report.text import number, table

PROGRAMS = ["accuracy_bench", "advise_bench"]
SECTIONS = {"Advice, held against this curve": "advise_bench"}  # tables of another program than the first
POLICIES = ("simple", "table", "tight", "slab")
BUDGET = 300  # µs, of the question that the first plot answers
NAMES = {"exact": "pairs of triangles", "touches": "whether triangles meet"}
FORCE_ERRORS = (("angle_p50", 1), ("angle_max", 1), ("length_p50", 100), ("length_max", 100))
WANTED = 0.1  # mm, of the second


class FirstContacts:
    """By policy, from the coarsest voxels to the finest: error, time and all else of first/…"""

    def __init__(self, results):
        self.runs = results.runs("accuracy_bench", "first")
        self.by_policy = {}
        for run in self.runs:
            self.by_policy.setdefault(run.parts[2], []).append(run)
        self.n, self.rounds = self.runs[0]["n"], self.runs[0]["rounds"]

    def curve(self, policy, x, y):
        return sorted((run[x], run[y]) for run in self.by_policy[policy])

    def sized(self, policy, y):
        """Any number of the policy's runs over the voxel size."""
        return sorted((float(run.parts[1]), run[y]) for run in self.by_policy[policy])

    def sizes(self, policy, x):
        """Voxel size over any other number of the policy's runs."""
        return sorted((run[x], float(run.parts[1])) for run in self.by_policy[policy])


def chapter(results, pictures):
    first = FirstContacts(results)
    return ["## The cost of accuracy", "", *_meaning(first), *_budget(first, pictures), *_wanted(first, pictures),
            *_table(first), *advice.section(results, first), *_verdicts(results), *_gaps(results, pictures), *_deadlines(results, pictures),
            *_points(results), *_forces(results)]


def _meaning(first):
    some = first.runs[0]
    return [
        f"Two jaws approach each other on {first.n:.0f} straight paths, turned by up to {number(some['turned_degrees'], 2)} degrees about each axis "
        f"and inclined by up to {number(some['inclined_degrees'], 2)} to each side. The "
        "**error** is the distance of the surfaces, by exact triangles, when voxels first report a contact: "
        "the largest of all paths. A contact is never reported too late, and no error exceeds the certain bound: otherwise the program that measures "
        f"fails, and it did not. The **time** is the median ({first.rounds:.0f} rounds, all bounds of a voxel size in turns) of the slowest "
        f"pose, among {some['closing_poses']:.0f} of the closing and the first contacts of the paths: one worker, all pairs of overlapping voxels, "
        "written. This is the search's part of a tick; contact points and effects add to it.", ""]


def _budget(first, pictures):
    figure, axes = pictures.figure(width=7.6, height=4)
    floor = 0.7 * min(run["error_max"] for run in first.runs if run["error_max"] > 0)
    for policy in POLICIES:
        runs = first.by_policy[policy]
        axes.plot([r["p50_us"] for r in runs], [r["error_max"] for r in runs], **style(policy))
        for r in runs if policy in ("slab", "table") else ():
            axes.annotate(r.parts[1], (r["p50_us"], r["error_max"]), xytext=(4, 3), textcoords="offset points", fontsize=7)
    exact, touches = (first.by_policy[name][0] for name in ("exact", "touches"))
    axes.plot([exact["p50_us"]], [floor], linestyle="", **style("exact", label="all pairs of triangles: error 0"))
    axes.plot([touches["p50_us"]], [floor], linestyle="", **style("touches", label="whether triangles meet: error 0"))
    axes.axvline(BUDGET, color="black", linestyle=":", linewidth=1)
    axes.annotate(f"{BUDGET} µs", (BUDGET, floor), xytext=(3, 0), textcoords="offset points", fontsize=8)
    axes.set(xscale="log", yscale="log", xlabel="slowest pose, µs (median, one worker)",
             ylabel="largest error at first contact, mm", title=f"I have {BUDGET} µs: what accuracy can I have?")
    axes.legend(title="bounds; numbers are\nvoxel sizes, mm", fontsize=8, title_fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
    picture = pictures.save(figure, "accuracy_for_time", "Largest error at first contact over the time of the slowest pose, by policy",
                            f"n = {first.n:.0f} ways of approach, {first.rounds:.0f} rounds")
    said = []
    for policy in POLICIES:
        error = between(first.curve(policy, "p50_us", "error_max"), BUDGET)
        if error is None:
            points = first.curve(policy, "p50_us", "error_max")
            if points[0][0] > BUDGET:
                said.append((float("inf"), f"`{policy}` is too slow at every size measured"))
            else:
                said.append((points[-1][1], f"`{policy}` {number(points[-1][1])} mm or better, the finest measured"))
        else:
            size = between(first.sizes(policy, "p50_us"), BUDGET)
            said.append((error, f"`{policy}` {number(error)} mm, with voxels of {number(size, 2)} mm"))
    said.sort()
    return [f"### I have {BUDGET} µs: what accuracy can I have?", "", picture, "",
            "Read between the points: " + "; ".join(text for _, text in said) + ". All pairs of "
            f"triangles that meet, without any error, take {number(exact['p50_us'])} µs at any voxel size; the yes or no whether any meet, "
            f"from which no force can be computed, takes {number(touches['p50_us'])} µs.", ""]


def _wanted(first, pictures):
    figure, (times, memory) = pictures.figure(2, height=3.8)
    for policy in POLICIES:
        runs = first.by_policy[policy]
        errors = [r["error_max"] for r in runs]
        times.plot(errors, [r["p50_us"] for r in runs], **style(policy))
        memory.plot(errors, [r["MB"] for r in runs], **style(policy))
    for axes, label in ((times, "slowest pose, µs (median)"), (memory, "both trees in memory, MB")):
        axes.axvline(WANTED, color="black", linestyle=":", linewidth=1)
        axes.set(xscale="log", yscale="log", xlabel="largest error at first contact, mm", ylabel=label)
    times.legend(fontsize=8)
    figure.suptitle(f"I need {WANTED} mm: what does it take?")
    picture = pictures.save(figure, "time_for_accuracy", "Time and memory over the error at first contact, by policy",
                            f"n = {first.n:.0f} ways of approach, {first.rounds:.0f} rounds")
    rows = []
    for policy in POLICIES:
        size = between(first.sizes(policy, "error_max"), WANTED)
        if size is None:
            best = first.curve(policy, "error_max", "p50_us")[0][0]
            rows.append([f"`{policy}`", f"not reached: {number(best)} mm with the finest", "", "", "", ""])
            continue
        at = {key: between(first.curve(policy, "error_max", key), WANTED) for key in ("p50_us", "MB", "build_ms")}
        rows.append([f"`{policy}`", number(size, 2), at["p50_us"], 1e6 / at["p50_us"], at["MB"], at["build_ms"] / 1e3])
    return [f"### I need {WANTED} mm: what does it take?", "", picture, "",
            *table(["bounds", "voxel size, mm", "slowest pose, µs", "rate, Hz", "both trees, MB", "to build both, s"], rows), ""]


def _table(first):
    rows = []
    for run in sorted(first.runs, key=lambda r: (-r["error_max"], r["p50_us"])):
        size, policy = run.parts[1:3]
        rows.append([NAMES.get(policy, f"`{policy}`"), "any" if policy in NAMES else size, run["error_p50"], run["error_max"],
                     run["resolution"], run["build_ms"] / 1e3, run["MB"], run["p50_us"], run["p99_us"], 1e6 / run["p50_us"]])
    slab = first.by_policy["slab"]
    growth, _ = power([float(run.parts[1]) for run in slab], [run["error_max"] for run in slab])
    worst = max(run["error_max"] / run["resolution"] for run in first.runs if run["resolution"] > 0)
    return ["### Every accuracy", "",
            *table(["bounds", "voxel size, mm", "error, median, mm", "error, largest, mm", "certain bound, mm", "to build both, s",
                    "both trees, MB", "slowest pose, µs", "its 99 of 100, µs", "rate, Hz"], rows), "",
            f"With `slab` the error grows as size^{growth:.2f}. The rate is one over the median; each pair was built once. "
            f"The certain bound is `resolution`, which every answer states; measured errors are at most {100 * worst:.0f} % of it. Answers about "
            f"triangles do not depend on voxels; their trees have voxels of {first.by_policy['exact'][0].parts[1]} mm, and the table states the "
            "memory and build time of these.", ""]


def _verdicts(results):
    runs = results.runs("accuracy_bench", "verdict")
    rows = [[f"`{run.parts[2]}`", run.parts[1], f"{run['missed']:.0f}", f"{run['false']:.0f}", run["leaf_pairs"],
             100 * (1 - run["crossing"] / run["leaf_pairs"])] for run in runs]
    some = runs[0]
    return ["### Missed and false contacts", "",
            f"Measured at {some['n']:.0f} poses from {some['before_mm']:g} mm before first contact to {some['behind_mm']:g} mm behind it; "
            f"triangles meet at {some['touching']:.0f} of them. A pose is missed if triangles meet and no voxels do, and false if voxels meet and no "
            "triangles do. A leaf pair of the closed pose is false if its own triangles, clipped to the voxels, do not cross. A missing "
            "leaf pair would stop the program. " + missed_verdict(runs), "",
            *table(["bounds", "voxel size, mm", "missed", "false", "leaf pairs, closed", "of which false, %"], rows), ""]


def missed_verdict(runs):
    """Whether voxels missed a contact of triangles, and in which rows."""
    lost = [(f"{run['missed']:.0f} by `{run.parts[2]}` at {run.parts[1]} mm", None) for run in runs if run["missed"] > 0]
    return f"Missed are {by_reason(lost)}, which no bounds may miss." if lost else "None is missed in any row."


def _gaps(results, pictures):
    runs = results.runs("accuracy_bench", "gap")
    distances = sorted({run.parts[3] for run in runs}, key=float)
    figure, axes = pictures.figure(len(distances), width=11, height=3.4)
    for plot, distance in zip(axes, distances):
        for policy in POLICIES:
            of = [run for run in runs if run.parts[2] == policy and run.parts[3] == distance]
            plot.plot([r["p50_us"] for r in of], [r["width_p50"] for r in of], **style(policy))
        of = [run for run in runs if run.parts[2].startswith("exact") and run.parts[3] == distance]
        plot.plot([r["p50_us"] for r in of], [r["width_p50"] for r in of], **style("exact", label="with triangles"))
        plot.set(xscale="log", yscale="log", xlabel="time, µs (median)", title=f"{distance} mm apart")
    axes[0].set_ylabel("width of the interval, mm (median)")
    axes[0].legend(fontsize=7)
    picture = pictures.save(figure, "gap_width", "Width of the gap's interval over time, by distance",
                            f"n = {runs[0]['n']:.0f} queries a point")
    coarse = max(runs, key=lambda r: r["width_max"])
    return ["### The gap", "", picture, "",
            "The certified interval of the distance between the surfaces, from voxels alone (a point for each voxel size, "
            "coarse ones above) and with triangles, to tolerances of "
            + ", ".join(dict.fromkeys(r.parts[2].split("-")[1] for r in runs if "-" in r.parts[2])) + " mm. Every interval was compared with exact "
            f"triangles and contains the distance. The widest of all is {number(coarse['width_max'])} mm "
            f"(`{coarse.parts[2]}`, voxels of {coarse.parts[1]} mm).", ""]


def _deadlines(results, pictures):
    runs = results.runs("accuracy_bench", "deadline")
    figure, axes = pictures.figure(width=6, height=3.8)
    for distance, mark in zip(sorted({run.parts[2] for run in runs}, key=float), "osD^"):
        of = [run for run in runs if run.parts[2] == distance]
        axes.plot([float(r.parts[1]) for r in of], [r["width_p50"] for r in of], marker=mark, label=f"{distance} mm apart")
    axes.set(xscale="log", yscale="log", xlabel="budget, µs", ylabel="width of the interval, mm (median)",
             title="What is known of the gap at a deadline")
    axes.legend(fontsize=8)
    picture = pictures.save(figure, "gap_by_budget", "Width of the gap's interval by the query's budget",
                            f"n = {runs[0]['n']:.0f} queries a point, slab, voxels of {runs[0]['voxel_size']:g} mm")
    late = max((run["p50_us"] - float(run.parts[1]) for run in runs if run["p50_us"] > float(run.parts[1])), default=0)
    return ["### Deadlines", "", picture, "",
            "A contact query that a budget stops returns the interval known by then, and the interval always contains the distance. Where surfaces "
            "are far apart the query ends before its budget, and the interval stays as wide as the pruning left it: for a narrow one "
            f"ask for the gap itself. In the median no query ended more than {number(late, 2)} µs after its budget.", ""]


def _points(results):
    runs = results.runs("accuracy_bench", "form")
    some = runs[0]
    rows = [[f"`{run.parts[2]}`", run.parts[1], run["depth_mean"], run["depth_max"], run["depth_max"] / float(run.parts[1]),
             run["normal_mean"], run["normal_max"], run["n"]] for run in runs]
    return ["### Depths and normals", "",
            f"Measured on {some['forms']:.0f} pairs of bodies with known surfaces (spheres, planes, a bore, boxes, tori), whose "
            f"radii of curvature are many voxels, from {number(some['apart_voxels'])} voxel apart to {number(some['deep_voxels'])} deep. "
            "n is the number of contact points.", "",
            *table(["bounds", "voxel size, mm", "depth error, mean, mm", "largest, mm", "largest, voxels",
                    "normal error, mean, °", "largest, °", "n"], rows), ""]


def _forces(results):
    runs = results.runs("accuracy_bench", "force")
    finest = min(runs, key=lambda r: float(r.parts[1])).parts[1]
    balls = {run.parts[1]: run for run in runs if run.parts[2] == "simple"}  # what a voxel's ball gives, by size
    loses = lambda run, key: is_loss(balls[run.parts[1]][key] / run[key]) if run[key] else False
    rows = [[f"`{run.parts[2]}`", run.parts[1], *(bold_if(number(factor * run[key]), loses(run, key)) for key, factor in FORCE_ERRORS),
             f"{run['none']:.0f}"] for run in runs]
    return ["### Forces", "",
            f"The contact force at {runs[0]['n']:.0f} poses, {runs[0]['least_depth_mm']:g} to {runs[0]['most_depth_mm']:g} mm behind first contact, "
            f"compared with the force by voxels of {finest} mm with `slab`. Its length differs at the same pose, because a surface "
            "begins to push a part of a voxel before contact: coarse voxels push earlier, and a hand rests farther out.", "",
            *table(["bounds", "voxel size, mm", "direction off by, median, °", "largest, °",
                    "length off by, median, %", "largest, %", "no force"], rows), "",
            forces_verdict({(run.parts[2], run.parts[1]): (run["angle_p50"], run["angle_max"]) for run in runs}), ""]


def forces_verdict(angles):
    """Where the direction of a force by tight or slab bounds is farther off than by the voxels' balls; (median, largest) in degrees, by
    policy and size."""
    said = []
    for at, name in enumerate(("In the median", "At the most")):
        lost = [(f"`{policy}` at {size} mm, {number(off[at])}° beside {number(angles['simple', size][at])}°", None)
                for (policy, size), off in angles.items()
                if policy in ("tight", "slab") and off[at] and is_loss(angles["simple", size][at] / off[at])]
        said.append(f"{name} the direction is farther off than with `simple` for {by_reason(lost)}." if lost else
                    f"{name} the direction is nowhere farther off than with `simple`.")
    return " ".join(said)
