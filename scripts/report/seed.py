"""Chapter: the article's own results, measured again."""

import json
import pathlib

from report.curves import crossings, exponent
from report.draw import style
from report.text import number, table

PROGRAMS = ["seed_bench"]
POLICIES = ("simple", "table", "tight", "slab")
PUBLISHED = json.loads(pathlib.Path("perf/published.json").read_text())


def chapter(results, pictures):
    return ["## The article's results again", "", *_meaning(results), *_voxels(results, pictures), *_octree(results, pictures),
            *_volumes(results, pictures), *_saved(results), *_rates(results, pictures)]


def _meaning(results):
    run = results.runs("seed_bench", "voxels")[0]
    extent = PUBLISHED["lower_jaw"]["size"][0]
    return ["Beside each number stands what was published, where the article's text states one; its plots give none. Its lower jaw of "
            f"{PUBLISHED['lower_jaw']['triangles']:,} triangles is {extent:g} units long, this one of {run['triangles']:,.0f} triangles "
            f"{number(run['extent'])} mm: so sizes are compared as they are, and again by l/s, the jaw's length in voxels.", ""]


def _voxels(results, pictures):
    runs = results.runs("seed_bench", "voxels")
    by_size = {run.parts[1]: run for run in runs}
    published = PUBLISHED["voxels_by_size"]
    fine = [(float(size), run["leaves"]) for size, run in by_size.items() if float(size) <= 1]
    times = [(float(size), run["voxels_ms"]) for size, run in by_size.items() if float(size) <= 1]
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
                            f"n = {min(r['n'] for r in runs):.0f} to {max(r['n'] for r in runs):.0f} builds a point, two threads")
    rows = [[size, run["extent"] / float(size), run["leaves"], published.get(size, ""), run["voxels_ms"], run["octree_ms"],
             run["nodes"], PUBLISHED["nodes_at_1"]["all"] if size == "1" else "", run["MB"]] for size, run in by_size.items()]
    scaled = [[run.parts[1], PUBLISHED["lower_jaw"]["size"][0] / float(run.parts[1]), published[run.parts[1]], run["leaves"],
               run["leaves"] / published[run.parts[1]]] for run in results.runs("seed_bench", "scaled")]
    one = by_size["1"]
    return ["### Voxels (figures 4 and 5)", "", picture, "",
            *table(["voxel size", "l/s", "voxels", "published", "voxels, ms", "octree, ms", "nodes", "published", "MB"], rows), "",
            "As many voxels along the jaw as the article's has:", "",
            *table(["published size", "l/s", "published voxels", "voxels here", "ratio"], scaled), "",
            f"*Differs:* neither voxels nor time are cubic in l/s. From 1 mm down voxels grow as (l/s)^{-exponent(fine):.2f} and the time to find "
            f"them as (l/s)^{-exponent(times):.2f}: a surface has two dimensions, and nothing is stored or visited for the space beside it. "
            "The article's own three counts grow so too, by "
            f"(l/s)^{-exponent([(float(s), c) for s, c in published.items()]):.2f}; what is cubic there is the array that it fills and visits. "
            "*Agrees:* at equal l/s the counts are of one magnitude; the two jaws are different ones. "
            f"Nodes: the article estimates {PUBLISHED['nodes_at_1']['least']:,} at least and has {PUBLISHED['nodes_at_1']['all']:,} at size 1, "
            f"{PUBLISHED['nodes_at_1']['all'] / PUBLISHED['voxels_by_size']['1']:.2f} a voxel; here it is {one['nodes'] / one['leaves']:.2f}.", ""]


def _octree(results, pictures):
    runs = sorted(results.runs("seed_bench", "octree"), key=lambda r: r["cells"])
    figure, axes = pictures.figure(width=6, height=3.2)
    axes.plot([r["cells"] for r in runs], [r["octree_ms"] for r in runs], color="#7570b3", marker="^")
    for power in (128, 256):
        axes.axvline(power, color="black", linestyle=":", linewidth=1)
    axes.set(xlabel="voxels along the jaw, l/s (dotted: powers of two)", ylabel="octree, ms (median)", ylim=(0, None))
    picture = pictures.save(figure, "seed_octree", "Time to fold the octree by the number of voxels along the jaw",
                            f"n = {min(r['n'] for r in runs):.0f} to {max(r['n'] for r in runs):.0f} builds a point")
    said = []
    for power in (128, 256):
        below = max((r for r in runs if r["cells"] <= power), key=lambda r: r["cells"])
        above = min((r for r in runs if r["cells"] > power), key=lambda r: r["cells"])
        said.append(f"from {below['cells']:.0f} to {above['cells']:.0f} voxels by {100 * (above['octree_ms'] / below['octree_ms'] - 1):+.0f} %, "
                    f"where voxels change by {100 * (above['leaves'] / below['leaves'] - 1):+.0f} %")
    return ["### The octree (figures 7 and 8)", "", picture, "",
            "*Differs:* the published time jumps at powers of two, where the cubic array doubles and every cell of it is visited. "
            f"Here only occupied voxels are folded: the time changes {'; '.join(said)}.", ""]


def _volumes(results, pictures):
    runs = results.runs("seed_bench", "levels", "scaled1")
    figure, (volume, time) = pictures.figure(2, height=3.6)
    by_policy = {policy: [r for r in runs if r.parts[2] == policy] for policy in POLICIES}
    for policy, of in by_policy.items():
        levels = [int(r.parts[3]) for r in of]
        volume.plot(levels, [r["leaf_balls"] for r in of], **style(policy))
        time.plot(levels, [r["make_us"] for r in of], **style(policy))
    volume.set(yscale="log", xlabel="level (0: leaves)", ylabel="volume of all spheres, in unit balls of a leaf")
    time.set(yscale="log", xlabel="level (0: leaves)", ylabel="time to make all spheres, µs (least)")
    volume.legend(fontsize=8)
    picture = pictures.save(figure, "seed_volumes", "Volume of all spheres of a level, and the time to make them, by policy",
                            f"n = {runs[0]['n']:.0f} times")
    simple = {r.parts[3]: r for r in by_policy["simple"]}
    rows = [[level, simple[level]["nodes"], simple[level]["leaf_balls"],
             *(f"{next(r for r in by_policy[p] if r.parts[3] == level)['leaf_balls'] / simple[level]['leaf_balls']:.3f}" for p in POLICIES[1:])]
            for level in simple]
    made = {policy: sum(r["make_us"] for r in of) for policy, of in by_policy.items()}
    table_is_dearer = made["table"] > made["simple"]
    return ["### Spheres by level (figure 9)", "", picture, "",
            "At the article's l/s of size 1. The unit is the ball round a leaf, (√3/2) π s³; at level L the article's is 8^L times as large, "
            "counted from the leaf as level 0 (its formula's L-1 counts it as 1). Of `table`, `tight` and `slab` the volume by that of `simple`; "
            "`slab` has the balls of `tight`, and its slabs cut them further.", "",
            *table(["level", "nodes", "`simple`, unit balls", "`table`", "`tight`", "`slab`"], rows), "",
            "All spheres of the tree once take " + ", ".join(f"`{p}` {number(t)} µs" for p, t in made.items()) + ". "
            + ("*Agrees:* spheres by the table are dearer to make than simple ones, " if table_is_dearer else
               "*Differs:* spheres by the table are no dearer to make than simple ones, ")
            + f"{made['table'] / made['simple']:.2f} times. `tight` and `slab` are read, not made.", ""]


def _saved(results):
    rows, said = [], []
    for size in ("0.8", "0.2"):
        for policy in POLICIES:
            for place in ("0", "1.5"):
                fly, saved = (results.runs("seed_bench", "saved", size, policy, source, place)[0] for source in ("on_the_fly", "saved"))
                rows.append([size, f"`{policy}`", f"{place}", fly["tests"], fly["p50_us"], saved["p50_us"], f"{fly['p50_us'] / saved['p50_us']:.2f}",
                             saved["octree_MB"], saved["saved_MB"]])
                said.append(fly["p50_us"] / saved["p50_us"])
    return ["### Spheres on the fly, or saved", "",
            "The article's first proposal, for its own depth-first query in double: a ball of 32 bytes a node, read instead of made. Distance is how "
            "far the lower jaw is opened, in mm.", "",
            *table(["voxel size", "spheres", "distance", "sphere tests", "on the fly, µs", "saved, µs", "times as fast", "octree, MB", "saved spheres, MB"], rows), "",
            f"Saving pays by {min(said):.2f} to {max(said):.2f} times, for several times the octree's bytes. What it opened the way to pays more: "
            "bounds that are *better* than any that follows from the octree (`tight`, `slab`), in 16-bit numbers.", ""]


def _rates(results, pictures):
    figure, plots = pictures.figure(2, width=10.5, height=4.2)
    rows, text = [], []
    for plot, size in zip(plots, ("0.8", "0.2")):
        micro = {}
        for engine, line in (("reference", "--"), ("fast", "-")):
            for policy in POLICIES:
                runs = sorted(results.runs("seed_bench", "rate", size, engine, policy), key=lambda r: float(r.parts[4]))
                distances = [float(r.parts[4]) for r in runs]
                micro[engine, policy] = [r["p50_us"] for r in runs]
                look = style(policy, linestyle=line)
                look["label"] = f"{policy}, {'as published' if engine == 'reference' else 'fast path'}"
                plot.plot([d + 0.25 for d in distances], [1e6 / t for t in micro[engine, policy]], **look)
                worst = max(runs, key=lambda r: r["p50_us"])
                published = PUBLISHED["worst_hz"].get(policy, "") if engine == "reference" else ""
                rows.append([size, engine, f"`{policy}`", 1e6 / worst["p50_us"], published, worst.parts[4], worst["tests"]])
        for engine in ("reference", "fast"):
            crossing = crossings(distances, micro[engine, "simple"], micro[engine, "table"])
            ahead = sum(a < b for a, b in zip(micro[engine, "simple"], micro[engine, "table"]))
            best = {min(POLICIES, key=lambda p: micro[engine, p][i]) for i in range(len(distances))}
            text.append(f"at {size} mm, {'as published' if engine == 'reference' else 'on the fast path'}, "
                        + (f"`simple` and `table` change places at {', '.join(f'{c:.1f}' for c in crossing)} mm" if crossing else
                           f"`simple` is {'never' if ahead == 0 else 'always'} the faster of the two")
                        + f" and the fastest of all is {' or '.join(f'`{p}`' for p in POLICIES if p in best)}")
        plot.axhline(1000, color="black", linestyle=":", linewidth=1)
        plot.set(xscale="log", yscale="log", xlabel="distance opened + 0.25, mm (0.25: full occlusion)", title=f"voxels of {size} mm")
    plots[0].set_ylabel("queries a second, Hz (median)")
    plots[1].legend(fontsize=7, loc="lower right")
    some = results.runs("seed_bench", "rate", "0.2", "reference")[0]
    picture = pictures.save(figure, "seed_rates", "Queries a second by distance, policy and engine, for voxels of 0.8 and 0.2 mm",
                            f"n = {some['n']:.0f} at 0.2 mm, one worker; dotted: 1000 Hz")
    low, high = PUBLISHED["simple_wins_below"]
    return ["### Haptic rates by distance (figure 10)", "", picture, "",
            *table(["voxel size", "engine", "spheres", "worst rate, Hz", "published", "at distance", "sphere tests there"], rows), "",
            f"*Published:* below a distance of {low} to {high} `simple` is faster than `table`, since making spheres by the table costs more than "
            "it saves. *Here:* " + "; ".join(text) + ". "
            "The table is a constant array of 256 entries made at compile time, so that looking a sphere up costs next to nothing and the tests "
            "it saves are a gain. *Agrees:* the worst case is where bodies are in contact, and there the depth-first query is far from 1000 Hz."]
