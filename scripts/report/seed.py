"""Chapter: the article's own results, measured again."""

from report.curves import power
from report.draw import style
from report.losses import factor, is_loss, listing
from report.seed_rates import NEAR, POLICIES, PUBLISHED, rates
from report.text import number, table

PROGRAMS = ["seed_bench"]
SURFACE, SPACE = 2, 3  # what counts grow as, by the dimensions of what is counted
SAVED = 1.1  # saving pays where the least gain is no less


def _is_cubic(power):
    return power > (SURFACE + SPACE) / 2


def _cubic_verdict(leaves, time, least_ms, published):
    """Whether voxels, the time to find them, and the article's own counts grow as the cube of l/s, and why where they do not."""
    cubic = [name for name, power in (("voxels", leaves), ("time", time)) if _is_cubic(power)]
    said = [f"*Agrees:* cubic in l/s, more than square, {'is' if len(cubic) == 1 else 'are'} {' and '.join(cubic)}." if cubic else
            "*Differs:* neither voxels nor time are cubic in l/s.",
            f"From 1 mm down voxels grow as (l/s)^{leaves:.2f}"
            + ("." if _is_cubic(leaves) else ", because a surface has two dimensions and the space beside it is neither stored nor visited."),
            f"The time to find them grows as (l/s)^{time:.2f}"
            + ("." if time >= SURFACE else f": a part of it depends on the triangles, {number(least_ms)} ms at any voxel size."),
            f"The article's own three counts grow as (l/s)^{published:.2f}"
            + ("." if _is_cubic(published) else "; only the array that it fills and visits is cubic.")]
    return " ".join(said)


def chapter(results, pictures):
    return ["## The article's results again", "", *_meaning(results), *_voxels(results, pictures), *_octree(results, pictures),
            *_volumes(results, pictures), *_saved(results), *rates(results, pictures)]


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
            _cubic_verdict(grows["leaves"], grows["voxels_ms"], min(r["voxels_ms"] for r in runs),
                           -power([float(size) for size in published], list(published.values()))[0]) + " "
            f"{'*Agrees:*' if all(1 / NEAR <= row[4] <= NEAR for row in scaled) else '*Differs:*'} "
            f"at equal l/s this other jaw has {min(row[4] for row in scaled):.2f} to {max(row[4] for row in scaled):.2f} times as many voxels, and "
            f"at size 1 {one['nodes'] / nodes['all']:.2f} times as many nodes: {one['nodes'] / one['leaves']:.2f} a voxel instead of "
            f"{nodes['all'] / published['1']:.2f}; the article estimates {nodes['least'] / published['1']:.2f} at least.", ""]


def _octree(results, pictures):
    runs = sorted(results.runs("seed_bench", "octree"), key=lambda r: r["cells"])
    figure, axes = pictures.figure(width=6, height=3.2)
    axes.plot([r["cells"] for r in runs], [r["octree_ms"] for r in runs], color="#7570b3", marker="^")
    twos = [2**n for n in range(32) if runs[0]["cells"] < 2**n < runs[-1]["cells"]]
    for two in twos:
        axes.axvline(two, color="black", linestyle=":", linewidth=1)
    axes.set(xlabel="voxels along the jaw, l/s (dotted: powers of two)", ylabel="octree, ms (median)", ylim=(0, None))
    picture = pictures.save(figure, "seed_octree", "Time to fold the octree by the number of voxels along the jaw",
                            f"n = {runs[0]['n']:.0f} foldings a point, in turns")
    said, jumps = [], False
    for two in twos:
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
            "Measured at the article's l/s of size 1. The unit is the ball round a leaf, (√3/2) π s³; at level L the article's ball is 8^L "
            "times as large, with the leaf as level 0 (its formula's L-1 counts it as 1). The columns of `table`, `tight` and `slab` are their "
            "volumes divided by the volume of `simple`; `slab` has the balls of `tight`, and its slabs cut them further.", "",
            *table(["level", "nodes", "`simple`, unit balls", "`table`", "`tight`", "`slab`"], rows), "",
            f"All spheres above the leaves, {number(sum(r['nodes'] for r in by_policy['simple'] if r.parts[2] != '0'))} of them, take "
            + ", ".join(f"`{p}` {number(t)} µs" for p, t in made.items()) + ", from known centres, as in a query. "
            + (f"*Agrees:* spheres by the table take {dearer:.2f} times as long to make as simple ones. " if dearer > 1.1 else
               f"*Differs:* spheres by the table take no longer to make than simple ones, {dearer:.2f} times as long. ")
            + "`tight` and `slab` are read and unpacked, not made. The children's offset, s·2^(L-1) on each axis with L the child's level, "
            "is the one that the article corrects; the earlier s·2^(L-2) is the same with L counted at the parent.", ""]


def _saved(results):
    runs = {tuple(run.parts[1:]): run for run in results.runs("seed_bench", "saved")}
    rows, gains, sizes, losses = [], [], [], []
    for size, policy, source, place in runs:
        if source != "on_the_fly":
            continue
        fly, saved = (runs[size, policy, of, place] for of in ("on_the_fly", "saved"))
        gain = fly["p50_us"] / saved["p50_us"]
        gains.append(gain)
        sizes.append(f"{saved['saved_MB'] / saved['octree_MB']:.1f}")
        if is_loss(gain):
            losses.append(f"`{policy}` at {size} mm and distance {place} ({factor(gain)})")
        rows.append([size, f"`{policy}`", place, fly["tests"], fly["p50_us"], saved["p50_us"], factor(gain), saved["octree_MB"], saved["saved_MB"]])
    verdict = "*Agrees:* saving pays." if min(gains) >= SAVED else "*Differs:* saving does not always pay."
    # A ball that is read costs memory, and one that is made costs arithmetic.
    lost = (f" **With saved spheres these are slower**: {listing(losses)}; a saved ball is read from memory, "
            f"{number(saved['ball_bytes'])} bytes a node." if losses else "")
    return ["### Spheres on the fly, or saved", "",
            f"The article's first proposal, for its own depth-first query in double: a ball of {number(saved['ball_bytes'])} bytes a node, "
            "read instead of made. "
            "Both sides have the same spheres and list the same leaf pairs. The distance is the opening of the lower jaw, in mm.", "",
            *table(["voxel size", "spheres", "distance", "sphere tests", "on the fly, µs", "saved, µs", "times as fast",
                    "octree, MB", "saved spheres, MB"], rows), "",
            f"{verdict} The query is {factor(min(gains))} to {factor(max(gains))} times as fast, and takes "
            f"{min(sizes, key=float)} to {max(sizes, key=float)} times the octree's bytes on top.{lost} Bounds that are "
            "better than any derived from the octree (`tight`, `slab`) can only be saved: the chapter on the query's parts has their gain.", ""]
