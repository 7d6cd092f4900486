"""What sweeps cost: rows a second by threads, beside loops in C and in Python, and what 10⁹ poses take by these rates."""

from report.losses import by_reason, is_loss
from report.text import number, table

PROGRAMS = ["sweep_bench"]

MANY = 1e9
SECONDS_AN_HOUR = 3600
BYTES_A_GIGABYTE = 1e9
CORES = (1, 2, 16, 128)  # that share 10⁹ poses


def chapter(results, _pictures):
    """The markdown of the chapter."""
    run = results.runs("sweep_bench", "sweep", "rates")[0]
    ways = {f"`ist sweep`, {name.split('_')[1]} thread{'s' if name != 'threads_1' else ''}": run[name]
            for name in sorted((key for key in run.keys() if key.startswith("threads_")), key=lambda key: int(key.split("_")[1]))}
    ways |= {"a loop over the single calls in C": run["loop_in_c"], "the same loop in Python": run["loop_in_python"]}
    most = max(int(key.split("_")[1]) for key in run.keys() if key.startswith("threads_"))
    alone = run["threads_1"]
    hours = MANY / alone / SECONDS_AN_HOUR
    return ["## Sweeps", "",
            f"Whether two jaws intersect, and how far apart they are, to {run['tolerance']:g} mm: {number(run['poses'])} poses a round, turned by up "
            f"to {run['turned_degrees']:g} degrees about each axis, up to {run['beside_mm']:g} mm beside occlusion and {run['below_mm']:g} below it, "
            f"voxels of {run['voxel_size']:g} mm, the {run['label']} pair. Each way answers the same poses, in turns; medians of "
            f"{number(run['rounds'])} rounds. A sweep computes its poses, and stores its rows on the disk; the loops keep nothing.", "",
            *table(["way", "poses a second", "times one thread of `ist sweep`"],
                   [[name, rate, f"{rate / alone:.2f}"] for name, rate in ways.items()]), "",
            verdict(run), "",
            f"So 10⁹ poses take {hours:.0f} hours of one core, and {MANY * run['row_bytes'] / BYTES_A_GIGABYTE:.0f} GB for rows of "
            f"{number(run['row_bytes'])} bytes: " +
            ", ".join(f"{_time(hours / cores)} on {cores} core{'s' if cores > 1 else ''}" for cores in CORES) +
            f", where each does as much. Here {most} threads did {run[f'threads_{most}'] / alone:.2f} times as much as one; "
            "cores beyond were not measured."]


def verdict(run):
    """Whether a loop answers more than one thread of a sweep, or a thread more answers less."""
    alone = run["threads_1"]
    lost = [(f"a loop in {language} answers {number(run[key] / alone)} times as many poses",
             "a sweep also computes its poses, and stores its rows on the disk")
            for key, language in (("loop_in_c", "C"), ("loop_in_python", "Python")) if is_loss(alone / run[key])]
    counts = sorted(int(key.split("_")[1]) for key in run.keys() if key.startswith("threads_"))
    lost += [(f"{more} threads answer less than {fewer}", None)
             for fewer, more in zip(counts, counts[1:]) if is_loss(run[f"threads_{more}"] / run[f"threads_{fewer}"])]
    if not lost:
        return "No loop answers 3 % more poses than one thread of a sweep, and no step to more threads answers 3 % fewer."
    return f"A sweep loses: {by_reason(lost)}."


def _time(hours):
    """Hours as people read them."""
    return f"{hours:.0f} h" if hours >= 2 else f"{60 * hours:.0f} min"
