"""Section of the cost of accuracy: what `ist advise` recommends, held against the measured curve."""

from report.curves import between
from report.losses import NOT_EXPLAINED
from report.text import number, table


def section(results, first):
    rows, beyond, known, sizes = [], [], 0, []
    curves = {"error": first.sized("slab", "error_max"), "budget": first.sized("slab", "p50_us")}
    for run in results.runs("advise_bench", "advise"):
        asked, limit, size = run.parts[1], float(run.parts[2]), run["voxel_size"]
        on_curve = {key: between(curve, size) for key, curve in curves.items()}
        cell = {key: number(value) if value else "beyond what was measured" for key, value in on_curve.items()}
        known += on_curve[asked] is not None
        if on_curve[asked] and on_curve[asked] > limit:
            beyond.append(on_curve[asked] / limit - 1)
            cell[asked] = f"**{cell[asked]}**"
        rows.append([f"{limit:g} µs" if asked == "budget" else f"{limit:g} mm", f"{size:g}", run["error"], cell["error"],
                     run["slowest_us"], cell["budget"], f"{run['sizes']:.0f}", run["seconds"]])
        if asked == "budget" and (allowed := between(first.sizes("slab", "p50_us"), limit)):
            sizes.append(size / allowed)
    verdict = f"Of {known} recommendations on that curve {known - len(beyond) if beyond else 'all'} keep the limit" + (
        f"; **the others exceed it by up to {100 * max(beyond):.0f} %** ({NOT_EXPLAINED})." if beyond else ".")
    some = results.runs("advise_bench", "advise")[0]
    part = f"{100 * some['part_of_limit']:.0f} %"
    return ["### Advice, held against this curve", "",
            f"`ist advise` measures a few voxel sizes on the user's own meshes and recommends one that keeps "
            f"{part} of the limit: its time at {some['poses']:.0f} poses of one straight closing, its error on that path and on "
            f"{some['paths_beside']:.0f} slightly inclined and turned ones. The columns beside show the curve of `slab` above, interpolated, for "
            "other poses, other paths and another time. "
            + size_verdict(sizes, part) + verdict, "",
            *table(["asked for", "recommended, mm", "its error, mm", "curve, mm", "its slowest pose, µs", "curve, µs", "sizes tried", "seconds"],
                   rows), ""]


def size_verdict(sizes, part):
    """How the sizes recommended for budgets compare with those that the curve allows for all of them; `sizes` are their ratios."""
    if not sizes:
        return ""
    smaller = [size for size in sizes if size < 1]
    if not smaller:
        return (f"As only {part} of a budget are used, the recommended voxels are up to {number(max(sizes))} times as large "
                "as the curve allows for all of it. ")
    return f"At **{len(smaller)} of {len(sizes)} budgets the recommended voxels are smaller than the curve allows** ({NOT_EXPLAINED}). "
