"""Chapter: what a tick takes whose leaf pairs are kept from the last one, beside a fresh query, by motion."""

from report.losses import NOISE, bold_if, by_reason, is_loss
from report.styles import style
from report.text import number, table

PROGRAMS = ["coherent_bench"]
# The search for a front takes at most this many times a plain one (perf/NOTES.md, A front kept): it explains no more.
MOST_OF_A_FRONT = 2
KINDS = {"median": "p50_us", "slowest": "max_us"}


class Motion:
    """A motion, voxel size and number of workers: times of its ticks, afresh and by what is kept."""

    def __init__(self, run):
        self.run = run
        self.size, self.workers = run.parts[1], int(run.parts[-1])
        self.name = " ".join(run.parts[2:-1]).replace("_s", "/s").replace("_", " ").replace("mm/s", " mm/s")
        self.step = run["step_p50_voxels"]

    @property
    def title(self):
        return f"{self.name} at {self.size} mm" + (" with two workers" if self.workers == 2 else "")

    def times(self, kind):
        """Of a fresh query, and of a tick by kept pairs, µs."""
        return self.run[f"fresh_{KINDS[kind]}"], self.run[f"kept_{KINDS[kind]}"]

    def ratio(self, kind):
        fresh, kept = self.times(kind)
        return kept / fresh

    def loses(self, kind):
        return is_loss(1 / self.ratio(kind))

    def reason(self, kind):
        """Why it loses; None where that is not known."""
        if self.ratio(kind) > MOST_OF_A_FRONT:
            return None
        if 2 * self.run["by_search"] > self.run["ticks"]:
            return "most of its ticks are searches: it moves by more than the slack of a front lasts for"
        if kind == "slowest" and self.workers == 1:
            return "the tick that makes the next front searches farther than a query does"
        return None


def chapter(results, pictures):
    motions = sorted((Motion(run) for run in results.runs("coherent_bench", "ticks")), key=lambda one: (one.workers, one.step))
    some = motions[0].run
    return ["## Answers of a hand that moves", "",
            "A *coherent* query keeps the leaf pairs that are nearly near enough, its *front*, and tests them again at the next pose in place of a "
            f"search; its answers are those of a fresh query, bit by bit, or the program that measures fails. Both answer every tick in turn, with "
            f"`slab`, one worker unless stated otherwise, and room for {number(some['room'])} pairs: contacts with their sums, pose in, sums out. "
            f"Of each tick the least of {some['rounds']:.0f} rounds counts; times within {100 * NOISE:.0f} % of each other are equal. "
            "*Motion* is the median motion of a tick, at the corner of the moving jaw's box that moves most.", "",
            "### Coherent ticks by motion", "", _plot(motions, pictures), "", *_table(motions), "", *verdicts(motions)]


def _plot(motions, pictures):
    figure, panels = pictures.figure(2, height=3.8)
    colours = {1: style("slab")["color"], 2: style("table")["color"]}
    for axes, kind in zip(panels, KINDS):
        for workers, mark in ((1, "D"), (2, "o")):
            of = [one for one in motions if one.workers == workers]
            axes.plot([one.step for one in of], [one.ratio(kind) for one in of], linestyle="", marker=mark, color=colours[workers],
                      label=f"{workers} worker{'s' if workers > 1 else ''}")
        axes.axhline(1, color="black", linestyle=":", linewidth=1)
        axes.set(xscale="log", yscale="log", xlabel="motion of a tick, voxels", title=f"{kind} tick", ylabel="time by kept pairs / fresh")
    panels[0].legend(fontsize=8)
    ticks = [one.run["ticks"] for one in motions]
    return pictures.save(figure, "coherent_by_motion", "Time of a tick by kept pairs, as a part of a fresh query's, over the motion of a tick",
                         f"n = {number(min(ticks))} to {number(max(ticks))} ticks a point; above the dotted line keeping pairs loses")


def _table(motions):
    rows = []
    for one in motions:
        (fresh, kept), (worst_fresh, worst_kept) = one.times("median"), one.times("slowest")
        rows.append([one.title, one.step, fresh, bold_if(number(kept), one.loses("median")),
                     worst_fresh, bold_if(number(worst_kept), one.loses("slowest")),
                     *(f"{one.run[key]:,.0f}" for key in ("by_search", "among_kept", "in_clearance"))])
    return table(["motion, voxels", "motion a tick, voxels", "fresh, median, µs", "kept, median, µs", "fresh, slowest, µs", "kept, slowest, µs",
                  "ticks by search", "by kept pairs", "in a clearance"], rows)


def verdicts(motions):
    """A sentence for the median tick, and one for the slowest: where keeping pairs pays, and where it loses."""
    return [text for kind in KINDS for text in (_verdict(motions, kind), "")]


def _verdict(motions, kind):
    lost = [one for one in motions if one.loses(kind)]
    won = [one for one in motions if not one.loses(kind)]
    text = f"The {kind} tick"
    if won:
        ratios = [one.ratio(kind) for one in won]
        text += (f" by kept pairs takes {number(min(ratios))} to {number(max(ratios))} of a fresh query's time at {len(won)} of {len(motions)} "
                 f"motions, of up to {number(max(one.step for one in won), 2)} voxels a tick")
    if not lost:
        return text + ": it loses at none."
    worst = max(lost, key=lambda one: one.ratio(kind))
    named = by_reason([(one.title, one.reason(kind)) for one in lost])
    return (text + ("." if won else " gains at no motion.")
            + f" **It takes longer at {len(lost)}, by up to {number(worst.ratio(kind))} times**: {named}.")
