"""Section of scaling: one worker and two."""

from report.losses import bold_if, by_reason, is_loss
from report.scaling_asked import COLOURS, PROGRAM, queries
from report.text import number, table

NAMES = {"row": "back to back", "paced": "paced"}


def section(results, pictures):
    runs = {tuple(run.parts[1:]): run for run in results.runs(PROGRAM, "workers")}
    places = [key[2] for key in runs if key[:2] == ("1", "row")]
    figure, panels = pictures.figure(2)
    rows = []
    for axes, pace, title in zip(panels, ("row", "paced"), ("Back to back", "Paced at 1 kHz")):
        for workers, colour, mark in (("1", COLOURS[2], "^"), ("2", COLOURS[0], "D")):
            own = [runs[workers, pace, dz] for dz in places]
            name = f"{workers} worker" + "s" * (workers == "2")
            axes.plot([float(dz) for dz in places], [run["p50_us"] for run in own], "-" + mark, color=colour,
                      label=f"{name}: median")
            axes.plot([float(dz) for dz in places], [run["p99_us"] for run in own], "--", color=colour,
                      label=f"{name}: 99 of 100")
        axes.set(xlabel="dz, mm (0: full occlusion)", ylabel="time of a query, µs", title=title, ylim=0)
        axes.legend(fontsize=7)
        for dz in places:
            one, two = runs["1", pace, dz], runs["2", pace, dz]
            gain = one["p50_us"] / two["p50_us"]
            rows.append([NAMES[pace], dz, one["p50_us"],
                         bold_if(number(two["p50_us"]), is_loss(gain)), gain, one["p99_us"],
                         bold_if(number(two["p99_us"]), is_loss(one["p99_us"] / two["p99_us"])), f"{100 * two['worth']:.0f} %",
                         f"{100 * two['shared']:.0f} %"])
    picture = pictures.save(figure, "scaling_workers", "Time of a query by workers, along the closing",
                            queries(runs.values()))
    lines = ["### One worker and two", "",
             "The second worker polls when a query is expected, and no query waits for it. Queries with too little work "
             "are not offered to it. Where two are slower by 3 % or more, their time is bold.", ""]
    lines += table(["queries", "dz, mm", "one, µs", "two, µs", "times faster", "one, 99 of 100", "two, 99 of 100",
                    "worth sharing", "shared"], rows)
    return lines + ["", verdict(runs), "", picture]


def verdict(runs):
    """Where two workers are slower than one, in the median or in 99 of 100; runs by workers, pace and place."""
    said = []
    for key, name in (("p50_us", "median"), ("p99_us", "99 of 100")):
        both = [(pace, dz) for workers, pace, dz in runs if workers == "1"]
        times = {(pace, dz): runs["2", pace, dz][key] / runs["1", pace, dz][key] for pace, dz in both}
        lost = [(f"{NAMES[pace]} at {dz}", None) for pace, dz in both if is_loss(1 / times[pace, dz])]
        if lost:
            said.append(f"In the {name} two workers are slower than one at {len(lost)} of {len(both)}, "
                        f"by up to {number(max(times.values()))} times: {by_reason(lost)}.")
        else:
            said.append(f"In the {name} two workers are at no place slower than one by 3 % or more.")
    return " ".join(said)
