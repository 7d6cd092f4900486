"""How late the loop's ticks begin and how long they take, idle and beside a noisy neighbour."""

from report.losses import is_loss
from report.text import number, table

PROGRAMS = ["loop_bench"]
PROGRAM = PROGRAMS[0]

QUANTILES = ("p50", "p90", "p99", "p99.9", "max")
# Of each kind of run: name for people, colour, mark.
KINDS = {
    ("loop", "1"): ("the loop, 1 worker", "#1b9e77", "D"),
    ("loop", "2"): ("the loop, 2 workers", "#7570b3", "^"),
    ("bare", "clock"): ("nothing, by the loop's clock", "#d95f02", "o"),
    ("bare", "timer"): ("nothing, a timer at the loop's priority", "#888888", "s"),
    ("bare", "plain"): ("nothing, an ordinary thread's sleep", "#e7298a", "*"),
}
CONDITIONS = {"idle": "idle", "noisy": "beside a noisy neighbour"}


def chapter(results, pictures):
    """The markdown of the chapter."""
    runs = {tuple(run.parts[:3]): run for kind in ("loop", "bare") for run in results.runs(PROGRAM, kind)}
    loop = runs["loop", "1", "idle"]
    period = loop["period_us"]
    lines = ["## The loop's latency", "",
             f"The servo loop turns the simulation of two jaws every {number(period)} µs: a simulated hand closes them and "
             f"holds them closed, with contact, friction and damping, in voxels of {number(loop['voxel_size'])} mm. The lateness of a "
             "tick is the time from its scheduled to its actual begin. Its execution lasts until the wrench is written to "
             "the device. The neighbour is one thread for each core, of ordinary priority, that streams "
             f"through {number(loop['neighbour_MB'])} MB of memory and computes. Three empty loops stand beside the loop: the first uses the loop's "
             f"own clock, which wakes {number(loop['awake_us'])} µs before a tick and waits awake; the second sleeps until the tick, by a timer at "
             "the loop's priority; the third sleeps in an ordinary thread. The last two show the machine's own wake-up "
             "latency.", "", _permitted(loop), ""]
    late = _picture(pictures, runs, "late", KINDS, "loop_late", "began late by more than, µs")
    loops = {kind: KINDS[kind] for kind in KINDS if kind[0] == "loop"}
    took = _picture(pictures, runs, "execution", loops, "loop_execution", "took more than, µs", period)
    lines += ["### When ticks begin", "", *_late_in_words(runs), "", *_table(runs, "late", KINDS), "", late, "",
              "### How long they take", "", *_taken_in_words(runs), "", *_table(runs, "execution", loops), "", took]
    return lines


def _permitted(run):
    if run["denied"] == 0:
        return "The system permitted all that the loop asks for: SCHED_FIFO and locked memory."
    return f"**The system did not permit all that the loop asks for**: {run['label'].split('; ', 1)[1]}"


def _tail(run, what):
    """Times, and the part of all ticks that were longer: from where that falls below 1 down to the longest tick."""
    count = run[what + "_count"]
    points = sorted((float(key[len(what) + 6:-2]), 1 - value / count) for key, value in run.items()
                    if key.startswith(what + "_upto_"))
    before = [time for time, part in points if part == 1][-1:]
    points = [(time, part) for time, part in points if 0 < part < 1 and time < run[what + "_max_us"]]
    return [(time, 1) for time in before] + points + [(run[what + "_max_us"], 1 / count)]


def _picture(pictures, runs, what, kinds, name, label, deadline=None):
    figure, panels = pictures.figure(2)
    for axes, (condition, title) in zip(panels, CONDITIONS.items()):
        for kind, (people, colour, mark) in kinds.items():
            times, parts = zip(*_tail(runs[kind + (condition,)], what))
            axes.loglog(times, parts, "-" + mark, color=colour, label=people, markersize=3)
        if deadline:
            axes.axvline(deadline, color="#555555", linestyle=":", label="the period")
        axes.set(xlabel=label, ylabel="part of all ticks (1 - CDF)", title=title.capitalize())
        axes.legend(fontsize=6.5)
    low = min(axes.get_xlim()[0] for axes in panels), min(axes.get_ylim()[0] for axes in panels)
    high = max(axes.get_xlim()[1] for axes in panels)
    for axes in panels:
        axes.set(xlim=(low[0], high), ylim=(low[1], 1.5))
    counts = sorted(int(runs[kind + (condition,)][what + "_count"]) for kind in kinds for condition in CONDITIONS)
    return pictures.save(figure, name, f"Complementary distribution: part of all ticks that {label}",
                         f"n = {counts[0]:,} to {counts[-1]:,} ticks a line, in buckets of 1/32 of the time; the last "
                         "point of a line is its longest tick")


def _table(runs, what, kinds):
    rows = []
    for kind, (people, _, _) in kinds.items():
        for condition, place in CONDITIONS.items():
            run = runs[kind + (condition,)]
            missed = number(run["missed"])
            rows.append([people, place, *(run[f"{what}_{quantile}" + "_us"] for quantile in QUANTILES),
                         f"**{missed}**" if run["missed"] else missed, run["ticks"]])
    return table(["", "machine", *(f"{quantile}, µs" for quantile in QUANTILES), "missed", "ticks"], rows)


def _late_in_words(runs):
    """Yields sentences with the distribution's values at 99 and at 99.9 of 100 ticks."""
    at = lambda kind, name, condition, quantile: number(runs[kind, name, condition][f"late_{quantile}_us"])
    for condition, title in CONDITIONS.items():
        place = title.capitalize()
        yield (f"{place}, 99 of 100 ticks of the loop with one worker begin within {at('loop', '1', condition, 'p99')} "
               f"µs and 99.9 within {at('loop', '1', condition, 'p99.9')} µs; ticks of the empty loop with the same clock begin "
               f"within {at('bare', 'clock', condition, 'p99')} and {at('bare', 'clock', condition, 'p99.9')} µs. The "
               f"machine itself wakes a thread {at('bare', 'timer', condition, 'p50')} µs late in the median, and "
               f"within {at('bare', 'timer', condition, 'p99')} and {at('bare', 'timer', condition, 'p99.9')} µs; an "
               f"ordinary thread within {at('bare', 'plain', condition, 'p99')} and "
               f"{at('bare', 'plain', condition, 'p99.9')} µs.")
    yield from _later_idle(runs)


def _later_idle(runs):
    """Yields what begins later idle than beside the neighbour, and why where the empty loops show it."""
    later = [kind for kind in KINDS if is_loss(runs[kind + ("noisy",)]["late_p99_us"] / runs[kind + ("idle",)]["late_p99_us"])]
    if not later:
        return
    cause = ("An empty loop is among them, so the machine is a cause: resting cores take time to wake, and a virtual machine's cores may be lent "
             "to others meanwhile; a busy neighbour of lower priority keeps them awake." if any(kind[0] == "bare" for kind in later) else
             "No empty loop is among them: not explained.")
    yield f"**At p99 these begin later idle than beside the neighbour**: {'; '.join(KINDS[kind][0] for kind in later)}. {cause}"


def _over(run, what):
    """The bucket of a time that the period reaches first, in µs, and the number of ticks whose time is longer."""
    uptos = {float(key[len(what) + 6:-2]): value for key, value in run.items() if key.startswith(what + "_upto_")}
    bound = min(upto for upto in uptos if upto >= run["period_us"])
    return bound, run[what + "_count"] - uptos[bound]


def why_missed(run, bare):
    """Why a loop missed ticks: some took longer than the period, before others the loop slept or waited too long."""
    (bound, long), (_, late), period = _over(run, "execution"), _over(run, "late"), run["period_us"]
    causes = []
    if run["execution_max_us"] >= period:
        cause = ("its thread had the processor all that time: not explained" if run["cpu_max_us"] >= 0.99 * run["execution_max_us"] else
                 f"its thread had the processor for {number(run['cpu_max_us'])} µs at most: "
                 + ("not explained" if run["cpu_max_us"] >= period else "it was off its core"))
        causes.append(f"{number(long)} took over {number(bound)} µs; the longest took {number(run['execution_max_us'])} µs, and {cause}")
    else:
        causes.append(f"no tick took as long as the period, {number(run['execution_max_us'])} µs at most")
    causes.append(f"{number(late)} began over {number(bound)} µs late, by up to {number(run['late_max_us'])} µs, "
                  "and each of these skipped the ticks before it"
                  if late else f"none began over {number(bound)} µs late")
    return f"{'; '.join(causes)}; the empty loop by the same clock missed {number(bare['missed'])}"


def _missed_in_words(runs):
    """Yields a verdict on the ticks that the loop missed."""
    missed = []
    for kind in KINDS:
        for at, place in CONDITIONS.items():
            run = runs[kind + (at,)]
            if kind[0] == "loop" and run["missed"]:
                missed.append(f"{KINDS[kind][0]}, {place}, {number(run['missed'])} beside {number(run['ticks'])} ticks "
                              f"({why_missed(run, runs['bare', 'clock', at])})")
    yield f"**Deadlines were missed**: {'; '.join(missed)}." if missed else "The loop missed no deadline."


def _taken_in_words(runs):
    for workers in ("1", "2"):
        idle, noisy = (runs["loop", workers, condition] for condition in CONDITIONS)
        yield (f"With {workers} worker{'s' * (workers == '2')} a tick takes {number(idle['execution_p50_us'])} µs in "
               f"the median and {number(idle['execution_p99.9_us'])} µs at 99.9 of 100; beside the neighbour "
               f"{number(noisy['execution_p50_us'])} and {number(noisy['execution_p99.9_us'])} µs. Its processor time "
               f"is {number(idle['cpu_p50_us'])} and {number(noisy['cpu_p50_us'])} µs in the median. Answers that were not complete "
               f"in time: {number(idle['held'])} and {number(noisy['held'])}.")
    yield from _missed_in_words(runs)
