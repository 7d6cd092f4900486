"""Chapter: the article's own results, measured again."""

import json
import pathlib

from report.curves import crossings, power
from report.draw import style
from report.text import number, table

PROGRAMS = ["seed_bench"]
POLICIES = ("simple", "table", "tight", "slab")
PUBLISHED = json.loads(pathlib.Path("perf/published.json").read_text())


NEAR = 2  # a number agrees with a published one where neither is more than this many times the other
SURFACE, SPACE = 2, 3  # what counts grow as, by the dimensions of what is counted


def _cubic_verdict(grows):
    cubic = [name for name, power in (("voxels", grows["leaves"]), ("time", grows["voxels_ms"])) if power > (SURFACE + SPACE) / 2]
    if not cubic:
        return "*Differs:* neither voxels nor time are cubic in l/s."
    return f"*Agrees:* cubic in l/s, more than square, {'is' if len(cubic) == 1 else 'are'} {' and '.join(cubic)}."


def chapter(results, pictures):
    return ["## The article's results again", "", *_meaning(results), *_voxels(results, pictures), *_octree(results, pictures),
            *_volumes(results, pictures), *_saved(results), *_rates(results, pictures)]


def _meaning(results):
    run = results.runs("seed_bench", "voxels")[0]
    extent = PUBLISHED["lower_jaw"]["size"][0]
    return ["Beside each number stands the published one, if the article's text states it; its plots give no numbers. The article's lower jaw of "
            f"{PUBLISHED['lower_jaw']['triangles']:,} triangles is {extent:g} units long, this one of {run['triangles']:,.0f} triangles "
            f"{number(run['extent'])} mm: so sizes are compared as they are, and again by l/s, the jaw's length in voxels.", ""]


def _voxels(results, pictures):
    runs = results.runs("seed_bench", "voxels")
    by_size = {run.parts[1]: run for run in runs}
    published = PUBLISHED["voxels_by_size"]
    fine = {float(size): run for size, run in by_size.items() if float(size) <= 1}
    grows = {key: -power(list(fine), [run[key] for run in fine.values()])[0] for key in ("leaves", "voxels_ms")}
    figure, (counts, clock) = pictures.figure(2, height=3.6)
    sizes = [float(size) for size in by_size]
    counts.plot(sizes, [r["cells"] ** 3 for r in runs], color="#888888", linestyle="--", label="all cells of a cubic grid, (l/s)³")
    counts.plot(sizes, [r["nodes"] for r in runs], color="#7570b3", marker="^", label="nodes of the octree")
    counts.plot(sizes, [r["leaves"] for r in runs], color="#1b9e77", marker="D", label="surface voxels, its leaves")
    counts.plot([float(size) for size in published], list(published.values()), color="black", marker="x", linestyle="", label="published voxels")
    counts.set(xscale="log", yscale="log", xlabel="voxel size, mm", ylabel="count")
    clock.plot(sizes, [r["voxels_ms"] for r in runs], color="#1b9e77", marker="D", label="voxels")
    clock.plot(sizes, [r["octree_ms"] for r in runs], color="#7570b3", marker="^", label="octree")
    clock.set(xscale="log", yscale="log", xlabel="voxel size, mm", ylabel="time, ms (median)")
    for axes in (counts, clock):
        axes.invert_xaxis()
        axes.legend(fontsize=7)
    picture = pictures.save(figure, "seed_voxels", "Voxels, nodes and times by voxel size",
                            f"n = {min(r['n'] for r in runs):.0f} to {max(r['n'] for r in runs):.0f} builds a point, on all cores")
    rows = [[size, run["extent"] / float(size), run["leaves"], published.get(size, ""), run["voxels_ms"], run["octree_ms"],
             run["nodes"], PUBLISHED["nodes_at_1"]["all"] if size == "1" else "", run["MB"]] for size, run in by_size.items()]
    scaled_runs = {run.parts[1]: run for run in results.runs("seed_bench", "scaled")}
    nodes = PUBLISHED["nodes_at_1"]
    scaled = [[size, PUBLISHED["lower_jaw"]["size"][0] / float(size), published[size], run["leaves"], run["leaves"] / published[size],
               nodes["all"] if size == "1" else "", run["nodes"]] for size, run in scaled_runs.items()]
    one = scaled_runs["1"]
    return ["### Voxels (figures 4 and 5)", "", picture, "",
            *table(["voxel size", "l/s", "voxels", "published", "voxels, ms", "octree, ms", "nodes", "published", "MB"], rows), "",
            "With the same number of voxels along the jaw as the article's:", "",
            *table(["published size", "l/s", "published voxels", "voxels here", "ratio", "published nodes", "nodes here"], scaled), "",
            f"{_cubic_verdict(grows)} From 1 mm down voxels grow as (l/s)^{grows['leaves']:.2f}, because a surface has two "
            f"dimensions and the space beside it is neither stored nor visited. The time to find them grows as (l/s)^{grows['voxels_ms']:.2f}: a part of it "
            f"depends on the triangles, {number(min(r['voxels_ms'] for r in runs))} ms at any voxel size. The article's own three counts grow as "
            f"(l/s)^{-power([float(size) for size in published], list(published.values()))[0]:.2f}; only the array that it fills and visits is cubic. "
            f"{'*Agrees:*' if all(1 / NEAR <= row[4] <= NEAR for row in scaled) else '*Differs:*'} at equal l/s this other jaw has {min(row[4] for row in scaled):.2f} to {max(row[4] for row in scaled):.2f} times as many voxels, and at size 1 "
            f"{one['nodes'] / nodes['all']:.2f} times as many nodes: {one['nodes'] / one['leaves']:.2f} a voxel instead of {nodes['all'] / published['1']:.2f}; the article "
            f"estimates {nodes['least'] / published['1']:.2f} at least.", ""]


def _octree(results, pictures):
    runs = sorted(results.runs("seed_bench", "octree"), key=lambda r: r["cells"])
    figure, axes = pictures.figure(width=6, height=3.2)
    axes.plot([r["cells"] for r in runs], [r["octree_ms"] for r in runs], color="#7570b3", marker="^")
    for power in (128, 256):
        axes.axvline(power, color="black", linestyle=":", linewidth=1)
    axes.set(xlabel="voxels along the jaw, l/s (dotted: powers of two)", ylabel="octree, ms (median)", ylim=(0, None))
    picture = pictures.save(figure, "seed_octree", "Time to fold the octree by the number of voxels along the jaw",
                            f"n = {runs[0]['n']:.0f} foldings a point, in turns")
    said, jumps = [], False
    for two in (128, 256):
        below = max((r for r in runs if r["cells"] <= two), key=lambda r: r["cells"])
        above = min((r for r in runs if r["cells"] > two), key=lambda r: r["cells"])
        jumps |= above["octree_ms"] / below["octree_ms"] > 1.5 * above["leaves"] / below["leaves"]
        said.append(f"from {below['cells']:.0f} to {above['cells']:.0f} voxels by {100 * (above['octree_ms'] / below['octree_ms'] - 1):+.0f} %, "
                    f"where voxels change by {100 * (above['leaves'] / below['leaves'] - 1):+.0f} %")
    return ["### The octree (figures 7 and 8)", "", picture, "",
            "The published time jumps at powers of two, where the cubic array doubles and every cell of it is visited. "
            f"{'*Agrees, though' if jumps else '*Differs:'}* here only occupied voxels are folded: the time changes {'; '.join(said)}.", ""]


def _volumes(results, pictures):
    runs = results.runs("seed_bench", "levels")
    figure, (volume, time) = pictures.figure(2, height=3.6)
    by_policy = {policy: [r for r in runs if r.parts[1] == policy] for policy in POLICIES}
    for policy, of in by_policy.items():
        levels = [int(r.parts[2]) for r in of]
        volume.plot(levels, [r["leaf_balls"] for r in of], **style(policy))
        time.plot(levels, [r["make_us"] for r in of], **style(policy))
    volume.set(yscale="log", xlabel="level (0: leaves)", ylabel="volume of all spheres, in unit balls of a leaf")
    time.set(yscale="log", xlabel="level (0: leaves)", ylabel="time to make all spheres, µs (least)")
    volume.legend(fontsize=8)
    picture = pictures.save(figure, "seed_volumes", "Volume of all spheres of a level, and the time to make them, by policy",
                            f"n = {runs[0]['n']:.0f} times")
    simple = {r.parts[2]: r for r in by_policy["simple"]}
    rows = [[level, simple[level]["nodes"], simple[level]["leaf_balls"],
             *(f"{next(r for r in by_policy[p] if r.parts[2] == level)['leaf_balls'] / simple[level]['leaf_balls']:.3f}" for p in POLICIES[1:])]
            for level in simple]
    # A leaf has no children: there both are the ball of its cube.
    made = {policy: sum(r["make_us"] for r in of if r.parts[2] != "0") for policy, of in by_policy.items()}
    dearer = made["table"] / made["simple"]
    return ["### Spheres by level (figure 9)", "", picture, "",
            "Measured at the article's l/s of size 1. The unit is the ball round a leaf, (√3/2) π s³; at level L the article's ball is 8^L times as large, "
            "with the leaf as level 0 (its formula's L-1 counts it as 1). The columns of `table`, `tight` and `slab` are their volumes divided by the volume of `simple`; "
            "`slab` has the balls of `tight`, and its slabs cut them further.", "",
            *table(["level", "nodes", "`simple`, unit balls", "`table`", "`tight`", "`slab`"], rows), "",
            f"All spheres above the leaves, {number(sum(r['nodes'] for r in by_policy['simple'] if r.parts[2] != '0'))} of them, take "
            + ", ".join(f"`{p}` {number(t)} µs" for p, t in made.items()) + ", from known centres, as in a query. "
            + (f"*Agrees:* spheres by the table take {dearer:.2f} times as long to make as simple ones. " if dearer > 1.1 else
               f"*Differs:* spheres by the table take no longer to make than simple ones, {dearer:.2f} times as long. ")
            + "`tight` and `slab` are read and unpacked, not made. The children's offset, s·2^(L-1) on each axis with L the child's level, is the one "
            "that the article corrects; the earlier s·2^(L-2) is the same with L counted at the parent.", ""]


def _saved(results):
    rows, said = [], []
    for size in ("0.8", "0.2"):
        for policy in ("simple", "table"):
            for place in ("0", "1.5"):
                fly, saved = (results.runs("seed_bench", "saved", size, policy, source, place)[0] for source in ("on_the_fly", "saved"))
                rows.append([size, f"`{policy}`", f"{place}", fly["tests"], fly["p50_us"], saved["p50_us"], f"{fly['p50_us'] / saved['p50_us']:.2f}",
                             saved["octree_MB"], saved["saved_MB"]])
                said.append(fly["p50_us"] / saved["p50_us"])
    return ["### Spheres on the fly, or saved", "",
            "The article's first proposal, for its own depth-first query in double: a ball of 32 bytes a node, read instead of made. The distance is the "
            "opening of the lower jaw, in mm.", "",
            *table(["voxel size", "spheres", "distance", "sphere tests", "on the fly, µs", "saved, µs", "times as fast", "octree, MB", "saved spheres, MB"], rows), "",
            f"{'*Agrees:* saving pays. It' if min(said) >= SAVED else '*Differs:* saving does not always pay. It'} makes the query {min(said):.2f} to {max(said):.2f} times as fast, and takes "
            f"{rows[-1][-1] / rows[-1][-2]:.1f} times the octree's bytes on top. Bounds that are better than any derived from the octree (`tight`, `slab`) "
            "can only be saved: the chapter on the query's parts has their gain.", ""]


def _rate_verdict(slow):
    published = PUBLISHED["worst_hz"]["table"]
    ratio = slow / published
    agrees = 1 / NEAR <= ratio <= NEAR
    return (f"{'*Agrees:*' if agrees else '*Differs:*'} with `table` the depth-first query reaches {number(slow)} Hz there at best, {number(ratio, 2)} times the published "
            f"{published}, on another machine.")


SAVED = 1.1  # saving pays where the least gain is no less


class Rates:
    """Medians by engine and policy over the distances, of one voxel size, as rate/SIZE names it."""

    def __init__(self, results, size):
        self.size, self.runs = size, {}
        for run in results.runs("seed_bench", "rate", size):
            self.runs.setdefault((run.parts[2], run.parts[3]), []).append(run)
        for of in self.runs.values():
            of.sort(key=lambda run: float(run.parts[4]))
        self.distances = [float(run.parts[4]) for run in self.runs["reference", "simple"]]
        self.n = self.runs["reference", "simple"][0]["n"]

    def micro(self, engine, policy):
        return [run["p50_us"] for run in self.runs[engine, policy]]

    def at(self, engine, policy, distance):
        return self.runs[engine, policy][self.distances.index(distance)]

    def fastest(self, engine, noise=1.05):
        """Runs of distances over which one policy is the fastest, and no other within the noise of it: (policy, from, to)."""
        found = []
        for i, distance in enumerate(self.distances):
            best = min(POLICIES, key=lambda p: self.micro(engine, p)[i])
            if found and self.micro(engine, found[-1][0])[i] < noise * self.micro(engine, best)[i]:
                best = found[-1][0]
            if found and found[-1][0] == best:
                found[-1][2] = distance
            else:
                found.append([best, distance, distance])
        return found


def _rates(results, pictures):
    own = [Rates(results, size) for size in ("0.8", "0.2")]
    try:
        scaled = [Rates(results, f"scaled{size}") for size in ("0.8", "0.2")]
    except SystemExit:  # left out of a quick run
        scaled = []
    figure, plots = pictures.figure(2, width=10.5, height=4.2)
    for plot, rates in zip(plots, own):
        for engine, line, said in (("reference", "--", "as published"), ("fast", "-", "fast path")):
            for policy in POLICIES:
                plot.plot([d + 0.25 for d in rates.distances], [1e6 / t for t in rates.micro(engine, policy)],
                          **style(policy, linestyle=line, label=f"{policy}, {said}"))
        plot.axhline(1000, color="black", linestyle=":", linewidth=1)
        plot.set(xscale="log", yscale="log", xlabel="distance opened + 0.25, mm (0.25: full occlusion)", title=f"voxels of {rates.size} mm")
    plots[0].set_ylabel("queries a second, Hz (median)")
    plots[1].legend(fontsize=7, loc="lower right")
    picture = pictures.save(figure, "seed_rates", "Queries a second by distance, policy and engine, for voxels of 0.8 and 0.2 mm",
                            f"n = {own[0].n:.0f} queries a point at 0.8 mm, {own[1].n:.0f} at 0.2 mm, one worker; dotted: 1000 Hz")
    rows, places = [], []
    for rates in own + scaled:
        for engine in ("reference", "fast"):
            for policy in POLICIES:
                worst = max(rates.runs[engine, policy], key=lambda run: run["p50_us"])
                places.append(float(worst.parts[4]))
                before = rates.at(engine, policy, 1.5)
                rows.append([rates.size.replace("scaled", "l/s of "), engine, f"`{policy}`", 1e6 / worst["p50_us"], worst.parts[4], worst["tests"],
                             1e6 / before["p50_us"], before["tests"]])
    text, ahead = [], []
    for rates in own + scaled:
        for engine, said in (("reference", "as published"), ("fast", "on the fast path")):
            crossing = crossings(rates.distances, rates.micro(engine, "simple"), rates.micro(engine, "table"))
            behind = sum(a > b for a, b in zip(rates.micro(engine, "simple"), rates.micro(engine, "table")))
            parts = ", ".join(f"`{p}` " + (f"from {low:g} to {high:g}" if low < high else f"at {low:g}") for p, low, high in rates.fastest(engine))
            ahead.append(behind / len(rates.distances))
            text.append(f"- {rates.size.replace('scaled', 'at the l/s of ')}, {said}: `simple` and `table` "
                        + (f"change places at {', '.join(f'{c:.1f}' for c in crossing)}" if crossing else "do not change places")
                        + f", `table` is ahead at {behind} of {len(rates.distances)} distances; fastest of all: {parts}.")
    low, high = PUBLISHED["simple_wins_below"]
    slow = max(1e6 / own[0].at("reference", "table", 0)["p50_us"], 1e6 / own[1].at("reference", "table", 0)["p50_us"])
    contact = all(place <= 1 for place in places)
    return ["### Haptic rates by distance (figure 10)", "", picture, "",
            f"Published are {PUBLISHED['worst_hz']['table']} Hz with `table` and {PUBLISHED['worst_hz']['simple']} Hz with `simple` in the worst case, which "
            "is *right before collision*; the text does not name which of its two voxel sizes this is. Here the pose before contact is at distance 1.5. "
            "Rows with l/s have the same number of voxels along the jaw as the article at that size, and distances in its units.", "",
            *table(["voxel size", "engine", "spheres", "worst rate, Hz", "at distance", "sphere tests", "rate before contact, Hz", "sphere tests"], rows), "",
            ("*Differs:* the worst case is where surfaces overlap, not right before. " if contact else
             "*Agrees:* the worst case is not where surfaces overlap most. ")
            + _rate_verdict(slow),
            "", f"Policies: the article says that below a distance of {low} to {high} `simple` is faster than `table`, since spheres by the table cost more to make "
            "than they save. Here, where a lead is 5 % or more:", "", *text, "",
            ("*Differs:* the table is a constant array of 256 entries made at compile time, so a look-up (see the levels above) costs less than "
             "the tests that it saves." if min(ahead) > 0.5 else "*Agrees:* making the table's spheres does not always cost less than the tests that they save.")]
