"""The certified interval of a distance by the limit of tests, and the distance that it holds."""
from pictures.how.command import NAMES
from pictures.how.style import INK, POLICY, plt, save

MOVE = "0,0,-3"
LIMITS = [round(100 * 10 ** (step / 4)) for step in range(17)]  # 100 to a million
SHARP = 1e-4  # mm
HIGHEST = 5  # mm, of the plots


def distances(command, files, tolerance):
    """Returns the intervals by the limit of tests, and the last one, of a query without a limit."""

    def ask(*options):
        return command.answer("collide", *files, "--move", MOVE, "--distance", tolerance, *options)

    limited = [ask("--max-tests", limit) for limit in LIMITS]
    return [(answer["distance_lower"], answer["distance_upper"]) for answer in limited], ask()


def draw(command, file):
    exact = distances(command, [command.tree(name) for name in NAMES], SHARP)
    voxels = distances(command, [command.tree(name, "--no-triangles") for name in NAMES], SHARP)
    truth = exact[1]["distance_lower"], exact[1]["distance_upper"]
    if truth[1] - truth[0] > 2 * SHARP:
        raise SystemExit(f"intervals: the distance is known from {truth[0]} to {truth[1]} alone")
    figure, places = plt.subplots(1, 2, figsize=(11, 3.6), sharey=True)
    figure.subplots_adjust(left=0.055, right=0.985, top=0.90, bottom=0.15, wspace=0.06)
    for place, (intervals, whole), title, colour in zip(
            places, (voxels, exact), ("voxels alone, by slab", "triangles, in clusters"), (POLICY["slab"], POLICY["tight"])):
        for lower, upper in [*intervals, (whole["distance_lower"], whole["distance_upper"])]:
            if lower > truth[1] or upper < truth[0]:
                raise SystemExit(f"intervals: from {lower} to {upper} there is no distance of {truth[0]}")
        lower, upper = zip(*intervals)
        place.fill_between(LIMITS, lower, upper, step="post", color=colour, alpha=0.22, linewidth=0)
        place.step(LIMITS, upper, where="post", color=colour, linewidth=1.4)
        place.step(LIMITS, lower, where="post", color=colour, linewidth=1.4, label="the certified interval")
        place.axhline(truth[0], color=INK, linewidth=1, linestyle="--", label="the distance")
        place.set(xscale="log", xlim=(LIMITS[0], LIMITS[-1]), ylim=(-0.15, HIGHEST), xlabel="limit of tests", title=title)
    places[0].set_ylabel("mm")
    places[0].legend(loc="upper right")
    save(figure, file)
    low, high = voxels[1]["distance_lower"], voxels[1]["distance_upper"]
    return (f"The distance of the same jaws, 3 mm before they close, by the limit of tests: every interval holds it. Without a limit "
            f"voxels alone tell {low:.2f} to {high:.2f} mm, and triangles {truth[0]:.4f} to {truth[1]:.4f} mm.")
