"""Chapter: what exact touch, distance and penetration depth take, by how accurate they are."""

from report.losses import bold_if, by_reason, is_loss
from report.styles import style
from report.text import number, table

PROGRAMS = ["measure_bench"]
TICK = 1000  # µs, of a haptic loop at 1 kHz
QUESTIONS = {"distance": "distance of the surfaces", "depth": "penetration depth"}
# Why a question is too slow for a tick to any tolerance (perf/NOTES.md, Measures), where that is known.
TOO_SLOW = {"depth": "most of the points that it measures only show that nothing else is deeper"}
STYLES = {"distance": "slab", "depth": "tight"}


class Asked:
    """A question to within a tolerance: the run of the pose that took longest."""

    def __init__(self, runs):
        self.slowest = max(runs, key=lambda run: run["p50_us"])
        self.tolerance, self.time = float(runs[0].parts[2]), self.slowest["p50_us"]
        self.width = max(run["upper"] - run["lower"] for run in runs)


def by_tolerance(results, question):
    """The question's answers, from the coarsest tolerance to the finest."""
    runs = {}
    for run in results.runs("measure_bench", "by_accuracy", question):
        runs.setdefault(run.parts[2], []).append(run)
    return sorted((Asked(of) for of in runs.values()), key=lambda one: -one.tolerance)


def chapter(results, pictures):
    (touch,) = by_tolerance(results, "touch")
    asked = {question: by_tolerance(results, question) for question in QUESTIONS}
    poses = len(results.runs("measure_bench", "by_accuracy", "touch"))
    return ["## How deep, how far", "",
            "Exact touch, the distance and the depth are of triangles, so they depend on no voxels; the last two are intervals as wide as a "
            "*tolerance*. The depth is that of the deepest point of either surface inside the other body. Each is asked afresh, by one worker. The "
            f"**time** is the median ({touch.slowest['n']:.0f} rounds) of the slowest pose, among {poses} of the closing. Every interval agrees with "
            "that of the finest tolerance, or the program that measures fails.", "",
            "### Time by tolerance", "", _plot(touch, asked, pictures), "", *_table(touch, asked), "",
            *verdicts(asked), "", *_beside(touch, asked), "",
            "### Depth from the last answer", "", *_warm(results), "", "### Other measures", "", *_others(results)]


def _plot(touch, asked, pictures):
    figure, axes = pictures.figure(width=7, height=3.8)
    for question, answers in asked.items():
        axes.plot([one.tolerance for one in answers], [one.time for one in answers], **style(STYLES[question], label=QUESTIONS[question]))
    axes.axhline(touch.time, label="exact touch", color=style("touches")["color"])
    axes.axhline(TICK, color="black", linestyle=":", linewidth=1, label=f"a tick of {TICK:,} µs")
    axes.set(xscale="log", yscale="log", xlabel="tolerance, mm", ylabel="slowest pose, µs (median, one worker)", title="What an accuracy takes")
    axes.legend(fontsize=8)
    return pictures.save(figure, "measures_by_tolerance", "Time of the distance and of the depth over their tolerance, exact touch beside them",
                         f"n = {touch.slowest['n']:.0f} rounds a pose")


def _table(touch, asked):
    rows = [["exact touch", "0", touch.slowest.parts[3], touch.time, touch.slowest["p99_us"], 1e6 / touch.time, "0"]]
    for question, answers in asked.items():
        rows += [[QUESTIONS[question], number(one.tolerance), one.slowest.parts[3], bold_if(number(one.time), one.time > TICK),
                  one.slowest["p99_us"], 1e6 / one.time, one.width] for one in answers]
    return table(["question", "tolerance, mm", "slowest at dz, mm", "slowest pose, µs", "its 99 of 100, µs", "rate, Hz", "widest interval, mm"], rows)


def verdicts(asked):
    """Which tolerance of each question fits into a tick, and by how much one that does not is too slow."""
    return [_verdict(question, answers) for question, answers in asked.items()]


def _verdict(question, answers):
    name = QUESTIONS[question]
    fit, late = [one for one in answers if one.time <= TICK], [one for one in answers if one.time > TICK]
    if not late:
        return f"The {name} fits into a tick of {TICK:,} µs to every tolerance measured, down to {number(answers[-1].tolerance)} mm."
    worst = max(late, key=lambda one: one.time)
    reason = "the finer the tolerance, the fewer candidates its bounds rule out" if fit else TOO_SLOW.get(question)
    lost = by_reason([(f"to {number(one.tolerance)} mm", reason) for one in late])
    if fit:
        begin = f"The {name} fits into a tick of {TICK:,} µs to {number(fit[-1].tolerance)} mm."
    else:
        begin = f"**The {name} fits into a tick of {TICK:,} µs to no tolerance.**"
    return f"{begin} It takes up to {number(worst.time / TICK)} times as long {lost}."


def _beside(touch, asked):
    said = []
    for question, answers in asked.items():
        ends = sorted({number(answers[i].time / touch.time): None for i in (0, -1)}, key=lambda text: float(text.replace(",", "")))
        said.append(f"the {QUESTIONS[question]} {' to '.join(ends)} times as long")
    return [f"Exact touch takes {number(touch.time)} µs at its slowest pose; " + ", ".join(said) + "."]


def _warm(results):
    times = {way: {run.parts[3]: run for run in results.runs("measure_bench", "measure", "depth", way)} for way in ("cold", "warm")}
    met = [pose for pose, run in times["cold"].items() if run["upper"] > 0]
    tolerance = times["cold"][met[0]]["tolerance"]
    rows = [[pose, times["cold"][pose]["real_time"],
             bold_if(number(times["warm"][pose]["real_time"]), is_loss(times["cold"][pose]["real_time"] / times["warm"][pose]["real_time"])),
             times["cold"][pose]["points"], times["warm"][pose]["points"], times["cold"][pose]["lower"]] for pose in met]
    return [*table(["dz, mm", "afresh, µs", "from the last answer, µs", "points afresh", "points from it", "depth at least, mm"], rows), "",
            warm_verdict([(pose, *(times[way][pose] for way in ("cold", "warm"))) for pose in met], tolerance)]


def warm_verdict(runs, tolerance):
    """Whether a search for the depth gains by the last answer; runs are a pose's name, its cold and its warm run."""
    ratios = {pose: warm["real_time"] / cold["real_time"] for pose, cold, warm in runs}
    text = (f"The depth to {number(tolerance)} mm, begun with the answer at a pose beside it, takes {number(min(ratios.values()))} to "
            f"{number(max(ratios.values()))} of the time afresh")
    lost = [(f"dz = {pose}", "it measures nearly as many points: most show that nothing else is deeper"
             if warm["points"] > 0.9 * cold["points"] else None) for pose, cold, warm in runs if is_loss(1 / ratios[pose])]
    return text + (f". It is slower at {by_reason(lost)}." if lost else ", and is at no pose slower by 3 % or more.")


def _others(results):
    rows = []
    for kind, name in (("distances", "vertices of both jaws within {reach:g} mm, with their distances"),
                       ("first_contact", "first contact, to {tolerance:g} mm"),
                       ("occlusion", "occlusion: areas, regions and depths")):
        slowest = max(results.runs("measure_bench", "measure", kind), key=lambda run: run["real_time"])
        rows.append([name.format(**slowest), slowest.parts[2], slowest["real_time"] / 1e3])
    return [*table(["question", "slowest at dz, mm, or motion", "slowest, ms (mean)"], rows), ""]
