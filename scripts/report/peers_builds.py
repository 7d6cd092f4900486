"""Section of peers: what it takes to build each library's structures, and to hold them."""

from report.losses import by_reason
from report.text import number, table


def section(results):
    runs = results.runs("peers_bench", "peers", "build")
    least = {key: min(run[key] for run in runs) for key in ("p50_us", "held_mb", "peak_mb")}

    def cell(run, key, scale=1):
        text = number(run[key] * scale)
        return f"**{text}**" if run[key] == least[key] else text

    rows = [[run.parts[2], cell(run, "p50_us", 1e-3), number(run["max_us"] / 1000), number(run["n"]),
             cell(run, "held_mb"), number(run["grown_mb"]), cell(run, "peak_mb")] for run in runs]
    return ["### Build and memory", "",
            "Time from both meshes in memory to structures that answer queries, in one thread. Held: the increase of malloc's memory in use "
            "(mallinfo2); grown: the increase of the process's resident memory, free pages "
            "given back; peak: the largest such increase while building.", "",
            *table(["", "median (ms)", "worst (ms)", "n", "held (MB)", "grown (MB)", "peak (MB)"], rows), "",
            verdict(runs, cheapest_bounds(results)), ""]


def cheapest_bounds(results):
    """What share of the time and of the memory of both trees with `slab` trees with `simple` take, at the voxels of peers."""
    size = f"{float(results.context('peers_bench')['voxel_size']):g}"
    if not all(results.has("accuracy_bench", "first", size, policy) for policy in ("simple", "slab")):
        return {}
    simple, slab = (results.runs("accuracy_bench", "first", size, policy)[0] for policy in ("simple", "slab"))
    return {"p50_us": simple["build_ms"] / slab["build_ms"], "held_mb": simple["MB"] / slab["MB"]}


COSTS = {"p50_us": "time to build", "held_mb": "memory held", "peak_mb": "peak memory"}


def verdict(runs, bounds):
    """Where another library is built with less: `bounds` has the share that stays with the cheapest bounds, by cost."""
    (ist,), others = [run for run in runs if run.parts[2] == "ist"], [run for run in runs if run.parts[2] != "ist"]
    lost = []
    for key, cost in COSTS.items():
        less = [run for run in others if run[key] < ist[key]]
        if less:
            best = min(less, key=lambda run: run[key])
            lost.append((f"{cost}: {len(less)} of {len(others)} need less, {best.parts[2]} {number(ist[key] / best[key])} times less",
                         reason(key, ist, bounds)))
    if not lost:
        return "IST builds in the least time, and holds the least memory."
    return f"IST loses in {by_reason(lost)}."


def reason(key, ist, bounds):
    """Why IST needs more of a cost; None where that is not known. `bounds` is what cheapest_bounds returns."""
    if key == "peak_mb":
        held = ist["held_mb"] / ist["peak_mb"]
        return f"{100 * held:.0f} % of it is the memory held" if held > 0.5 else None
    share = bounds.get(key, 1)
    if share > 0.5:
        return None
    return f"tight bounds of every voxel, which queries gain by: with `simple` the trees need {100 * share:.0f} % of that in the first chapter"
