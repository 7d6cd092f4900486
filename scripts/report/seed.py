"""Tables and plots of the article's own results, measured again."""

import json
import pathlib

from report.draw import DOTTED, LOG, line, panel, plot, style
from report.results import Run
from report.tables import POLICIES, Table, code, factor, part, runs

PUBLISHED = json.loads((pathlib.Path(__file__).parents[2] / "perf/published.json").read_text())
VOXELS, NODES, LENGTH = PUBLISHED["voxels_by_size"], PUBLISHED["nodes_at_1"], PUBLISHED["lower_jaw"]["size"][0]
TWOS = [2**n for n in range(32)]
VOXEL_SIZE = ("voxel size", lambda r: r.parts[1].replace("scaled", "l/s of "))
NEAR = 2  # a number agrees with a published one if neither is more than this many times the other


def published_nodes(run):
    return NODES["all"] if run.parts[1] == "1" else ""


def by_distance(results, program, *engine):
    """Yields each voxel size, engine and policy with its runs, ordered by distance. Sizes of the article's l/s are the last."""
    found = {}
    for run in results.runs(program, "rate"):
        if not engine or run.parts[2] in engine:
            found.setdefault(tuple(run.parts[1:4]), []).append(run)
    sizes = sorted(dict.fromkeys(size for size, _, _ in found), key=lambda size: size.startswith("scaled"))
    for key in sorted(found, key=lambda key: (sizes.index(key[0]), key[1] == "fast", POLICIES.index(key[2]))):
        yield key, sorted(found[key], key=part(4))


def worst_rates(results, program, *engine):
    """For each size, engine and policy the slowest distance, and the pose before contact."""
    made = []
    for (size, _, _), of in by_distance(results, program, *engine):
        contact = results.runs(program, "before_contact", size)[0]["distance"]
        worst = max(of, key=lambda run: run["p50_us"])
        at = list(map(part(4), of))
        made.append(Run(worst | {"contact": f"{contact:g}", "before": of[at.index(contact)],
                                 "beyond": at.index(float(worst.parts[4])) - at.index(contact)}))
    return made


def worst_cases(results, program):
    rates = worst_rates(results, program, "reference")
    return [r for size in dict.fromkeys(r.parts[1] for r in rates) for policy in PUBLISHED["worst_hz"]
            for r in rates if r.parts[1:4:2] == [size, policy]]


def place(r):
    return "*Agrees*" if r["beyond"] in (0, 1) else "*Differs:* surfaces overlap there" if r["beyond"] < 0 else "*Differs:* farther apart"


def hertz(r):
    return 1e6 / r["p50_us"]


def published_hertz(r):
    return hertz(r) / PUBLISHED["worst_hz"][r.parts[3]]


def saved(results, program):
    found = {tuple(run.parts[1:]): run for run in results.runs(program, "saved")}
    return [Run(found[size, policy, "saved", at] | {"fly": fly["p50_us"], "tested": fly["tests"]})
            for (size, policy, source, at), fly in found.items() if source == "on_the_fly"]


TABLES = {
    "voxels": Table("seed_bench", runs("voxels"), [
        ("voxel size", 1), ("l/s", lambda r: r["extent"] / float(r.parts[1])), ("voxels", "leaves"),
        ("published", lambda r: VOXELS.get(r.parts[1], "")), ("voxels, ms", "voxels_ms"), ("octree, ms", "octree_ms"), ("nodes", "nodes"),
        ("published", published_nodes), ("MB", "MB")]),
    "voxels at equal l/s": Table("seed_bench", runs("scaled"), [
        ("published size", 1), ("l/s", lambda r: LENGTH / float(r.parts[1])), ("published voxels", lambda r: VOXELS[r.parts[1]]),
        ("voxels here", "leaves"), ("ratio", lambda r: r["leaves"] / VOXELS[r.parts[1]]), ("published nodes", published_nodes),
        ("nodes here", "nodes")]),
    "spheres by level": Table("seed_bench", runs("levels", by=1), [
        ("level", 2), ("nodes", "simple:nodes"), ("`simple`, unit balls", "simple:leaf_balls"),
        *((f"`{p}`", lambda r, p=p: f"{r[p + ':leaf_balls'] / r['simple:leaf_balls']:.3f}") for p in POLICIES[1:])]),
    "saved spheres": Table("seed_bench", saved, [
        ("voxel size", 1), ("spheres", code(2)), ("distance", 4), ("sphere tests", "tested"), ("on the fly, µs", "fly"), ("saved, µs", "p50_us"),
        ("times as fast", lambda r: factor(r["fly"] / r["p50_us"])), ("octree, MB", "octree_MB"), ("saved spheres, MB", "saved_MB")]),
    "rates": Table("seed_bench", worst_rates, [
        VOXEL_SIZE, ("engine", 2), ("spheres", code(3)), ("worst rate, Hz", hertz), ("at distance", 4), ("sphere tests", "tests"),
        ("rate before contact, Hz", lambda r: hertz(r["before"])), ("sphere tests", lambda r: r["before"]["tests"])]),
    "worst cases": Table("seed_bench", worst_cases, [
        VOXEL_SIZE, ("spheres", code(3)), ("worst at", 4), ("before contact", "contact"), ("right before collision", place),
        ("worst rate, Hz", hertz), ("published, Hz", lambda r: PUBLISHED["worst_hz"][r.parts[3]]), ("ratio", lambda r: f"{published_hertz(r):.2f}"),
        ("as published", lambda r: "*Agrees*" if 1 / NEAR <= published_hertz(r) <= NEAR else "*Differs*")]),
}


@plot("seed_bench")
def seed_voxels(results):
    found, fine = results.runs("seed_bench", "voxels"), {"legend": {"fontsize": 7}, **LOG, "xlabel": "voxel size, mm"}

    def of(counter, **look):
        return line(found, part(1), counter, **look)
    return {"n": f"n = {min(r['n'] for r in found):.0f} to {max(r['n'] for r in found):.0f} builds a point, on all cores",
            "then": lambda _, all_axes: [axes.invert_xaxis() for axes in all_axes], "panels": [
                panel([of(lambda r: r["cells"] ** 3, color="#888888", linestyle="--", label="all cells of a cubic grid, (l/s)³"),
                       of("nodes", color="#7570b3", marker="^", label="nodes of the octree"),
                       of("leaves", color="#1b9e77", marker="D", label="surface voxels, its leaves"),
                       ([float(at) for at in VOXELS], list(VOXELS.values()),
                        {"color": "black", "marker": "x", "linestyle": "", "label": "published voxels"})],
                      ylabel="count", **fine),
                panel([of("voxels_ms", color="#1b9e77", marker="D", label="voxels"), of("octree_ms", color="#7570b3", marker="^", label="octree")],
                      ylabel="time, ms (median)", **fine)]}


@plot("seed_bench")
def seed_octree(results):
    found = sorted(results.runs("seed_bench", "octree"), key=lambda r: r["cells"])
    return {"width": 6, "height": 3.2, "n": f"n = {found[0]['n']:.0f} foldings a point, in turns", "panels": [panel(
        [line(found, "cells", "octree_ms", color="#7570b3", marker="^")],
        [("axvline", two, DOTTED) for two in TWOS if found[0]["cells"] < two < found[-1]["cells"]], ylim=(0, None),
        xlabel="voxels along the jaw, l/s (dotted: powers of two)", ylabel="octree, ms (median)")]}


@plot("seed_bench")
def seed_volumes(results):
    levels = results.runs("seed_bench", "levels")
    return {"n": f"n = {levels[0]['n']:.0f} times", "panels": [
        panel([line([r for r in levels if r.parts[1] == policy], lambda r: int(r.parts[2]), counter, **style(policy)) for policy in POLICIES],
              legend=legend, yscale="log", xlabel="level (0: leaves)", ylabel=label)
        for counter, legend, label in (("leaf_balls", {}, "volume of all spheres, in unit balls of a leaf"),
                                       ("make_us", None, "time to make all spheres, µs (least)"))]}


@plot("seed_bench")
def seed_rates(results):
    rates = {key: of for key, of in by_distance(results, "seed_bench") if not key[0].startswith("scaled")}
    sizes = list(dict.fromkeys(size for size, _, _ in rates))
    n = ", ".join(f"{rates[size, 'reference', 'simple'][0]['n']:.0f} queries a point at {size} mm" for size in sizes)
    return {"width": 10.5, "height": 4.2, "n": f"n = {n}, one worker; dotted: 1000 Hz", "panels": [panel(
        [line(rates[size, engine, policy], lambda r: float(r.parts[4]) + 0.25, hertz,
              **style(policy, linestyle=dashes, label=f"{policy}, {said}"))
         for engine, dashes, said in (("reference", "--", "as published"), ("fast", "-", "fast path")) for policy in POLICIES],
        [("axhline", 1000, DOTTED)], {"fontsize": 7, "loc": "lower right"} if place else None, **LOG, title=f"voxels of {size} mm",
        xlabel="distance opened + 0.25, mm (0.25: full occlusion)", ylabel="" if place else "queries a second, Hz (median)")
        for place, size in enumerate(sizes)]}
