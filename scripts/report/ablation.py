"""Chapter: what each part of the fast query gives, added one by one and left out one by one."""

from report.ablation_steps import LEFT_OUT, PLACE, POLICIES, POSES, SIZES, Variants, added, main_line, policy_of
from report.losses import NOISE, NOT_EXPLAINED, WHY, factor, is_loss, listing, why
from report.text import number, table

PROGRAMS = ["ablation_bench"]
LOOKS = {"0.0": {"color": "#1f4e79", "marker": "o"}, "-1.5": {"color": "#e6851e", "marker": "D", "linestyle": "--"}}
HATCHES = {"0.0": "", "-1.5": "///"}


def because(variants, before, name, dz):
    """Why a step of the ladder loses against the one before it."""
    return why(name, variants.of(name, "tests", dz) / variants.of(before, "tests", dz), variants.times(before, name, dz))


def ladder_table(variants):
    rows, line = [], main_line(variants)
    head = ["step", "spheres", "MB"]
    for dz in POSES:
        head += [f"µs, dz = {dz}", "tests", "leaf pairs", "times as fast as the step before", f"as `{policy_of(line[0])}` on pointers"]
    for before, name in zip([None] + line, line):
        row = [added(name), f"`{policy_of(name)}`", variants.of(name, "bytes", "0.0") / 1e6]
        for dz in POSES:
            row += [variants.of(name, "p50_us", dz), int(variants.of(name, "tests", dz)), int(variants.of(name, "contacts", dz))]
            row += [factor(variants.times(before, name, dz)) if before else ""]
            row += [factor(variants.times(line[0], name, dz))]
        rows.append(row)
    return table(head, rows)


def same_table(variants):
    """Lines of the published query and the fast one with the same spheres, and the tightest spheres against the published table."""
    head = ["IST against published"]
    for dz in POSES:
        head += [f"published, µs, dz = {dz}", "IST, µs", "times as fast", "leaf pairs: published, IST"]
    rows, losses = [], []
    for of, over in [(policy, policy) for policy in POLICIES] + [("slab", "table")]:
        row = [f"`{of}` against `{over}`"]
        for dz in POSES:
            fast, published = f"fast-{of}", f"published-{over}"
            row += [variants.of(published, "p50_us", dz), variants.of(fast, "p50_us", dz), factor(variants.times(published, fast, dz)),
                    f"{int(variants.of(published, 'contacts', dz)):,}, {int(variants.of(fast, 'contacts', dz)):,}"]
            if is_loss(variants.times(published, fast, dz)):
                losses.append(f"{row[0]} at dz = {dz}")
        rows.append(row)
    return table(head, rows) + (["", f"**Slower than the published query**: {listing(losses)}; {NOT_EXPLAINED}."] if losses else [])


def same_text():
    return ("Both queries list all leaf pairs and sort them by fixed and then by moving leaf, one worker each. With the same spheres they give the "
            "same answer, but for pairs that the guarantee leaves open, and `table`, whose published balls are not nested. The last row compares "
            "different answers: tighter bounds list fewer pairs, and lose none whose surfaces meet. The published query here is `ReferenceQuery`: "
            "the linear octree, depth first, in double.")


def without_table(variants):
    head = ["without", "MB"]
    for dz in POSES:
        head += [f"µs, dz = {dz}", "tests", "times as long"]
    rows = []
    for name in variants.names():
        row = ["nothing" if name == "full" else LEFT_OUT[name], variants.of(name, "bytes", "0.0") / 1e6]
        for dz in POSES:
            row += [variants.of(name, "p50_us", dz), int(variants.of(name, "tests", dz))]
            row += ["" if name == "full" else factor(variants.times(name, "full", dz))]
        rows.append(row)
    return table(head, rows)


def steps_by_factor(variants, dz):
    """(factor, step, the step before) of each step but the first, the largest factor first."""
    line = main_line(variants)
    return sorted(((variants.times(before, name, dz), name, before) for before, name in zip(line, line[1:])), reverse=True)


def verdict(variants, dz):
    """Returns sentences on the steps that gain and lose most at a pose."""
    steps, line = steps_by_factor(variants, dz), main_line(variants)
    gains = listing(f"{added(name)[2:]} ({factor(value)})" for value, name, _ in steps[:3])
    losses = [f"{added(name)[2:]} ({factor(value)}; {because(variants, before, name, dz)})" for value, name, before in steps if is_loss(value)]
    first, last = line[0], line[-1]
    workers = ", two workers," if last == "second_worker" else ""
    return (
        f"At {PLACE[dz]} `{policy_of(last)}` with all steps{workers} is {factor(variants.times(first, last, dz))} times as fast as "
        f"`{policy_of(first)}` on pointers; they list {int(variants.of(last, 'contacts', dz)):,} and {int(variants.of(first, 'contacts', dz)):,} "
        f"leaf pairs. Most give {gains}. " + (f"**These lose**: {'; '.join(losses)}." if losses else "No step loses."))


def without_verdict(variants, size):
    """Which parts the whole would be faster without, and why."""
    found = []
    for dz in POSES:
        for name in variants.names():
            value = variants.times(name, "full", dz)
            if not is_loss(value):
                continue
            reason = why(name, variants.of("full", "tests", dz) / variants.of(name, "tests", dz), value)
            found.append(f"{LEFT_OUT[name]} at dz = {dz} ({factor(value)} times as long; with it {reason})")
    if not found:
        return f"At {size} mm no part is better left out."
    return f"At {size} mm **the query is faster without** {'; '.join(found)}."


def label_down(axes, labels, unit):
    """A logarithmic scale to the right, and a label a row, from the top down."""
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.set_xlabel(unit)
    axes.set_yticks(range(len(labels)))
    axes.set_yticklabels(labels)
    axes.set_ylim(len(labels) - 0.5, -0.5)


def ladder_plot(variants, pictures, size):
    line = main_line(variants)
    figure, (times, tests) = pictures.figure(columns=2, width=10)
    for axes, counter in ((times, "p50_us"), (tests, "tests")):
        for dz in POSES:
            values = [variants.of(name, counter, dz) for name in line]
            axes.plot(values, range(len(line)), label=PLACE[dz], **LOOKS[dz])
    label_down(times, [added(name) for name in line], "median time of a query, µs")
    label_down(tests, [""] * len(line), "pairs of bounds tested in a query")
    times.set_title("Time: each step with all above it")
    tests.set_title("Tests")
    times.set_ylabel("step")
    times.legend(loc="upper left")
    return pictures.save(figure, "ablation_ladder", "Time and tests of a query, part by part",
                         f"Jaws at {size} mm, n = {variants.samples()} queries a dot")


def without_plot(variants, pictures, size):
    names = [name for name in variants.names() if name != "full"]
    figure, axes = pictures.figure(width=7.5)
    for i, dz in enumerate(POSES):
        places = [row + 0.36 * (i - 0.5) for row in range(len(names))]
        beyond = [variants.times(name, "full", dz) - 1 for name in names]
        axes.barh(places, beyond, 0.36, left=1, color=LOOKS[dz]["color"], hatch=HATCHES[dz], edgecolor="white",
                  label=PLACE[dz])
    axes.axvline(1, color="black", linewidth=0.8)
    label_down(axes, [LEFT_OUT[name] for name in names], "times as long as the whole query")
    axes.set_ylabel("left out")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncol=2)
    return pictures.save(figure, "ablation_without", "How much longer a query takes without each part",
                         f"Jaws at {size} mm, n = {variants.samples()} queries a bar")


def layout_text(variants):
    """Returns sentences on the speed and the memory of the layout alone."""
    bases = {"linear_table": "pointers_table", "linear_simple": "pointers_simple"}
    gain = lambda name: listing(f"{factor(variants.times(bases[name], name, dz))} at dz = {dz}" for dz in POSES)
    loses = any(is_loss(variants.times(base, name, dz)) for name, base in bases.items() for dz in POSES)
    ratio = variants.of("pointers_table", "bytes", "0.0") / variants.of("linear_table", "bytes", "0.0")
    return (
        f"The linear layout gives a factor of {gain('linear_table')} with the table, and of "
        f"{gain('linear_simple')} with circumspheres. "
        + (f"Where it loses, {WHY['linear_table']}. " if loses else "") +
        f"The nodes with pointers take {number(ratio)} times its memory. "
        "The nodes with pointers lie on a fresh heap in the order of a depth-first search, which is the best locality that "
        "pointers allow. Batches and saved bounds also build on the layout.")


def spheres_text(results):
    runs = results.runs("ablation_bench", "ablation", "spheres")
    cost = {run.parts[2].split("-", 1)[1]: run["ns_a_sphere"] for run in runs}
    ratio = cost["enclosing_ball"] / cost["lookup"]
    return (
        f"A sphere looked up by its mask takes {number(cost['lookup'], 2)} ns. Computed at run time, with the same "
        f"result, it takes {number(cost['enclosing_ball'], 2)} ns by the smallest enclosing ball of the children's "
        f"corners, {number(ratio, 2)} times as long, and {number(cost['search'], 2)} ns by the search that makes the table "
        "at compile time.")


def leaf_pairs_text(variants):
    found = listing(f"{int(variants.of(step, 'contacts', '0.0')):,} with {name}" for step, name in (
        ("pointers_simple", "circumspheres"), ("pointers_table", "the table"), ("batches", "the table in batches"),
        ("tight", "tight balls"), ("slab", "slabs")))
    return (
        "Steps that change the bounds change the answer too, within the guarantee: they drop pairs of leaves "
        f"whose surfaces do not meet. Leaf pairs at dz = 0: {found}. Later steps keep each of them, and their "
        "order.")


def chapter(results, pictures):
    """One table and plot a voxel size for what is added, and for what is left out."""
    ladders = {size: Variants(results, "ladder", size) for size in SIZES}
    withouts = {size: Variants(results, "without", size) for size in SIZES}
    first = results.runs("ablation_bench", "ablation", "ladder")[0]
    finest = SIZES[0]
    lines = [
        "## What each part gives", "",
        "Several parts distinguish the fast query from the published one. The article does not say how its nodes are linked: pointers are assumed. "
        f"Here the parts are added one by one, and then left out one by one. All variants query the same trees of the {first['label']} jaws at the "
        "same poses in one process, in turns, so that other load on the machine affects all of them. Each answer is checked: variants "
        "with the same search and the same bounds give the same leaf pairs and make the same number of tests, and the two "
        "searches differ only in pairs that the guarantee leaves open. Times run from the pose to the sorted leaf pairs: "
        f"medians of n = {listing(f'{ladders[size].samples()} queries at {size} mm' for size in SIZES)}, the fewest for "
        "the slowest variants. A test compares the bounds of two nodes. Losses are bold: factors below "
        f"{1 - NOISE:.2f}, since smaller deviations from 1 are noise. "
        "The reason of a loss is the work that the part adds, in the code; nothing here measures it alone.", "",
        "The search of the published query and of the linear layout is depth first, in double, with spheres made on "
        "the fly; from the batches on it is breadth first, in float. Each SIMD step is compared with the narrower "
        "instruction set before it. Queries follow back to back, which suits the second worker best. MB counts the parts of both trees that the "
        "query reads, and its own memory.", "",
    ]
    for size in SIZES:
        lines += [f"### Added one by one, at {size} mm", ""] + ladder_table(ladders[size]) + [""]
        if size == finest:
            lines += [ladder_plot(ladders[size], pictures, size), ""]
        for dz in POSES:
            lines += [verdict(ladders[size], dz), ""]
    for size in SIZES:
        lines += [f"### The same spheres on both sides, at {size} mm", "", *same_table(Variants(results, "same", size)), ""]
    lines += [same_text(), ""]
    lines += [layout_text(ladders[finest]), "", leaf_pairs_text(ladders[finest]), "", spheres_text(results), ""]
    for size in SIZES:
        lines += [f"### Left out one by one, at {size} mm", ""] + without_table(withouts[size]) + [""]
        lines += [without_verdict(withouts[size], size), ""]
        if size == finest:
            lines += [without_plot(withouts[size], pictures, size), ""]
    lines += [
        "Leaving out a part leaves out all parts that build on it: slabs need the tight balls, vectors and the second worker "
        "need batches, and batches need the linear layout. So the last two rows are depth-first "
        "searches with slabs, by one worker, and the last row compares with the row above it, not with the whole: "
        f"at {finest} mm the pointers alone take "
        + listing(f"{factor(withouts[finest].times('layout', 'batches', dz))} times as long at dz = {dz}"
                  for dz in POSES) + ".", "",
    ]
    return lines
