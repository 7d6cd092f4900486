"""Tables and plots of what each part of the fast query gives, added one by one and left out one by one."""

from report.draw import line, panel, plot
from report.tables import POLICIES, Table, factor, is_loss, number, row, runs

SIZES = ("0.2", "0.8")
POSES = {"0.0": "full occlusion (dz = 0)", "-1.5": "near contact (dz = -1.5)"}
LOOKS = {"0.0": {"color": "#1f4e79", "marker": "o"}, "-1.5": {"color": "#e6851e", "marker": "D", "linestyle": "--"}}
HATCHES = {"0.0": "", "-1.5": "///"}
# A step of the ladder: its words and its spheres. A step that is not here adds an instruction set to the slabs.
ADDED = {"pointers_simple": ("published, its nodes as pointers: circumspheres", "simple"), "pointers_table": ("+ lookup table", "table"),
         "linear_table": ("+ linear layout", "table"), "batches": ("+ breadth-first batches", "table"), "tight": ("+ tight balls", "tight"),
         "slab": ("+ slabs", "slab"), "second_worker": ("+ second worker", "slab")}
INSTRUCTIONS = {"ssse3": "SSSE3", "sse4": "SSE4", "avx2": "AVX2", "avx3": "AVX-512"}
LEFT_OUT = {"full": "nothing", "second_worker": "second worker", "simd": "SIMD", "simd_and_worker": "SIMD and second worker", "slab": "slabs",
            "tight": "tight balls, slabs (so: table)", "table": "tight balls, slabs, table (so: circumspheres)",
            "batches": "batches, SIMD, second worker", "layout": "linear layout, batches, SIMD, second worker"}
# The fast and the published spheres that are compared.
COMPARED = [*((policy, policy) for policy in POLICIES), ("slab", "table")]
# docs/performance.md compares these, with so many workers, at these poses.
CLOSING = (("table", 1, "table"), ("tight", 1, "tight"), ("slab", 1, "slab"), ("slab", 1, "table"), ("slab", 2, "table"))
CLOSING_POSES = {"0.0": "closed, dz = 0", "-0.5": "dz = -0.5", "-1.0": "dz = -1", "-1.5": "dz = -1.5, before contact", "-2.0": "dz = -2"}


def step(run):
    return run.parts[2].split("-", 1)[1]


def added(run):
    name, spheres = ADDED.get(step(run), (f"+ SIMD: {INSTRUCTIONS.get(step(run), step(run))}", "slab"))
    return name, f"`{spheres}`"


def variants(kind, size):
    """The variants of a kind at a voxel size, one row each; linear_simple stands beside the ladder."""
    return runs("ablation", kind, by=4, keep=lambda run: run.parts[3] == size and step(run) != "linear_simple")


def gain(dz, before):
    """How many times as fast as another row; empty for the first row."""
    return lambda r: factor(before(r)[f"{dz}:p50_us"] / r[f"{dz}:p50_us"]) if before(r) else ""


MB = ("MB", lambda r: r["0.0:bytes"] / 1e6)


def ladder(size):
    columns = [("step", lambda r: added(r)[0]), ("spheres", lambda r: added(r)[1]), MB]
    for dz in POSES:
        columns += [(f"µs, dz = {dz}", f"{dz}:p50_us"), ("tests", f"{dz}:tests"), ("leaf pairs", f"{dz}:contacts"),
                    ("times as fast as the step before", gain(dz, lambda r: r.before)), ("as `simple` on pointers", gain(dz, lambda r: r.rows[0]))]
    return Table("ablation_bench", variants("ladder", size), columns)


def without(size):
    columns = [("without", lambda r: LEFT_OUT[step(r)]), MB]
    for dz in POSES:
        columns += [(f"µs, dz = {dz}", f"{dz}:p50_us"), ("tests", f"{dz}:tests"),
                    ("times as long", lambda r, dz=dz: factor(r[f"{dz}:p50_us"] / r.rows[0][f"{dz}:p50_us"]) if r.before else "")]
    return Table("ablation_bench", variants("without", size), columns)


def same(size):
    def rows(results, program):
        found = {(run.parts[2], run.parts[4]): run for run in results.runs(program, "ablation", "same") if run.parts[3] == size}
        return [row(f"`{fast}` against `{published}`", **{f"{side}{dz}": found[name, dz] for dz in POSES
                    for side, name in (("fast", f"fast-{fast}"), ("published", f"published-{published}"))}) for fast, published in COMPARED]

    def of(side, dz, counter="p50_us"):
        return lambda r: r[side + dz][counter]

    columns = [("IST against published", 0)]
    for dz in POSES:
        columns += [(f"published, µs, dz = {dz}", of("published", dz)), ("IST, µs", of("fast", dz)),
                    ("times as fast", lambda r, dz=dz: factor(of("published", dz)(r) / of("fast", dz)(r))),
                    ("leaf pairs: published, IST", lambda r, dz=dz: ", ".join(number(of(side, dz, "contacts")(r)) for side in ("published", "fast")))]
    return Table("ablation_bench", rows, columns)


def layout(results, program):
    """The linear layout alone against nodes with pointers, with circumspheres and with the table."""
    found = {step(run): run for run in runs("ablation", "ladder", by=4, keep=lambda run: run.parts[3] == SIZES[0])(results, program)}
    return [row(name, pointers=found[f"pointers_{policy}"], linear=found[f"linear_{policy}"])
            for policy, name in (("simple", "circumspheres"), ("table", "the table"))]


def closing(results, program):
    """What docs/performance.md compares: rows with the published and the fast run of each pose, and the run of one worker less."""
    def run(*name):
        return results.runs(program, "ablation", *name)[0]
    return [row(f"`{of}`{', two workers' if workers == 2 else ''} against `{over}`", **{dz: (
        run("same", f"published-{over}", "0.2", dz), run(*(("same", f"fast-{of}") if workers == 1 else ("without", "0-full")), "0.2", dz),
        run("same", f"fast-{of}", "0.2", dz)) for dz in CLOSING_POSES}) for of, workers, over in CLOSING]


def closing_cell(dz):
    def cell(r):
        published, fast, alone = r[dz]
        times = published["p50_us"] / fast["p50_us"]
        bold = "**" if is_loss(times) or is_loss(alone["p50_us"] / fast["p50_us"]) else ""
        return (f"{number(published['p50_us'])} → {number(fast['p50_us'])}: {bold}{times:.1f}{bold}<br>"
                f"{published['contacts']:,.0f} → {fast['contacts']:,.0f}")
    return cell


MADE = {"added": ladder, "same spheres": same, "left out": without}
TABLES = {f"{name} at {size} mm": make(size) for name, make in MADE.items() for size in SIZES} | {
    "layout": Table("ablation_bench", layout, [
        ("spheres", 0), *((f"times as fast, dz = {dz}", lambda r, dz=dz: factor(r["pointers"][f"{dz}:p50_us"] / r["linear"][f"{dz}:p50_us"]))
                          for dz in POSES), ("memory of pointers / linear", lambda r: r["pointers"]["0.0:bytes"] / r["linear"]["0.0:bytes"])]),
    "one sphere": Table("ablation_bench", runs("ablation", "spheres"), [
        ("way", lambda r: {"lookup": "looked up by its mask", "enclosing_ball": "smallest ball around the children's corners",
                           "search": "the search that makes the table"}[step(r)]), ("ns a sphere", "ns_a_sphere")]),
    "closing": Table("ablation_bench", closing, [("IST against published", 0), *((place, closing_cell(dz)) for dz, place in CLOSING_POSES.items())]),
}


def samples(found):
    counts = [int(r[f"{dz}:n"]) for r in found for dz in POSES]
    return f"{min(counts):,} to {max(counts):,}"


def label_down(axes, labels, unit):
    """A logarithmic scale to the right, and a label a row, from the top down."""
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.set_xlabel(unit)
    axes.set_yticks(range(len(labels)))
    axes.set_yticklabels(labels)
    axes.set_ylim(len(labels) - 0.5, -0.5)


@plot("ablation_bench")
def ablation_ladder(results):
    steps = variants("ladder", SIZES[0])(results, "ablation_bench")

    def label(_, all_axes):
        label_down(all_axes[0], [added(r)[0] for r in steps], "median time of a query, µs")
        label_down(all_axes[1], [""] * len(steps), "pairs of bounds tested in a query")
    return {"width": 10, "n": f"Jaws at {SIZES[0]} mm, n = {samples(steps)} queries a dot", "then": label, "panels": [
        panel([line(steps, f"{dz}:{counter}", steps.index, label=words, **LOOKS[dz]) for dz, words in POSES.items()], legend=legend, title=title,
              ylabel=name) for counter, title, name, legend in (
            ("p50_us", "Time: each step with all above it", "step", {"loc": "upper left"}), ("tests", "Tests", "", None))]}


@plot("ablation_bench")
def ablation_without(results):
    full, *others = variants("without", SIZES[0])(results, "ablation_bench")

    def bars(_, all_axes):
        axes, = all_axes
        for i, dz in enumerate(POSES):
            axes.barh([place + 0.36 * (i - 0.5) for place in range(len(others))], [r[f"{dz}:p50_us"] / full[f"{dz}:p50_us"] - 1 for r in others],
                      0.36, left=1, color=LOOKS[dz]["color"], hatch=HATCHES[dz], edgecolor="white", label=POSES[dz])
        label_down(axes, [LEFT_OUT[step(r)] for r in others], "times as long as the whole query")
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncol=2)
    return {"width": 7.5, "n": f"Jaws at {SIZES[0]} mm, n = {samples([full, *others])} queries a bar", "then": bars,
            "panels": [panel([], [("axvline", 1, {"color": "black", "linewidth": 0.8})], ylabel="left out")]}
