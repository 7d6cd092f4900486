"""Section: the article's haptic rates by distance, measured again, and a verdict for each of its numbers and each voxel size."""

import json
import pathlib

from report.curves import crossings
from report.draw import style
from report.losses import listing
from report.text import table

POLICIES = ("simple", "table", "tight", "slab")
PUBLISHED = json.loads((pathlib.Path(__file__).parents[2] / "perf/published.json").read_text())
NEAR = 2  # a number agrees with a published one where neither is more than this many times the other
NOISE = 1.05  # a smaller lead does not count
ENGINES = {"reference": "as published", "fast": "on the fast path"}


class Rates:
    """Medians by engine and policy over the distances, of one voxel size, as rate/SIZE names it."""

    def __init__(self, results, size):
        self.size, self.runs = size, {}
        self.before_contact = results.runs("seed_bench", "before_contact", size)[0]["distance"]
        for run in results.runs("seed_bench", "rate", size):
            self.runs.setdefault((run.parts[2], run.parts[3]), []).append(run)
        for of in self.runs.values():
            of.sort(key=lambda run: float(run.parts[4]))
        self.distances = [float(run.parts[4]) for run in self.runs["reference", "simple"]]
        self.n = self.runs["reference", "simple"][0]["n"]

    def micro(self, engine, policy):
        return [run["p50_us"] for run in self.runs[engine, policy]]

    def at(self, engine, policy, distance):
        return self.runs[engine, policy][self.distances.index(distance)]

    def fastest(self, engine):
        """Runs of distances over which one policy is the fastest, and no other within the noise of it: (policy, from, to)."""
        found = []
        for i, distance in enumerate(self.distances):
            best = min(POLICIES, key=lambda p: self.micro(engine, p)[i])
            if found and self.micro(engine, found[-1][0])[i] < NOISE * self.micro(engine, best)[i]:
                best = found[-1][0]
            if found and found[-1][0] == best:
                found[-1][2] = distance
            else:
                found.append([best, distance, distance])
        return found

    def name(self):
        return self.size.replace("scaled", "l/s of ")

    def worst(self, engine, policy):
        return max(self.runs[engine, policy], key=lambda run: run["p50_us"])

    def leads(self, of, over, where):
        """At how many of the distances that `where` chooses the reference is faster with one policy than with another; and of how many."""
        at = [i for i, distance in enumerate(self.distances) if where(distance)]
        return sum(NOISE * self.micro("reference", of)[i] < self.micro("reference", over)[i] for i in at), len(at)


def worst_verdicts(rates):
    """Rows of one voxel size, a policy each, against the article: is the worst case right before collision, and as slow as published?"""
    rows = []
    for policy, published in PUBLISHED["worst_hz"].items():
        worst = rates.worst("reference", policy)
        place, hertz = float(worst.parts[4]), 1e6 / worst["p50_us"]
        # The pose right before contact, or the next one that was measured.
        beyond = rates.distances.index(place) - rates.distances.index(rates.before_contact)
        rows.append([rates.name(), f"`{policy}`", worst.parts[4], f"{rates.before_contact:g}",
                     "*Agrees*" if beyond in (0, 1) else "*Differs:* surfaces overlap there" if beyond < 0 else "*Differs:* farther apart",
                     hertz, str(published), f"{hertz / published:.2f}", "*Agrees*" if 1 / NEAR <= hertz / published <= NEAR else "*Differs*"])
    return rows


def lead_verdict(rates):
    """Whether `simple` is the faster of the two below the published distances, and `table` above them."""
    low, high = PUBLISHED["simple_wins_below"]
    simple, below = rates.leads("simple", "table", lambda d: d < low)
    beyond, above = rates.leads("table", "simple", lambda d: d > high)
    return (f"{'*Agrees:*' if 2 * simple > below and 2 * beyond > above else '*Differs:*'} `simple` is ahead at {simple} of {below} "
            f"distances below {low}, `table` at {beyond} of {above} above {high}.")


def lead_reason(all_rates):
    """Why `table` is ahead below the published distances, where it is."""
    low = PUBLISHED["simple_wins_below"][0]
    wins = [rates.name() for rates in all_rates for ahead, of in [rates.leads("table", "simple", lambda d: d < low)] if 2 * ahead > of]
    return [f"Below {low} `table` is ahead with {listing(wins)}: the table is a constant array that is made at compile time, "
            "so a look-up (see the levels above) costs less than the tests that it saves.", ""] if wins else []


def _lead_lines(rates):
    lines = []
    for engine, said in ENGINES.items():
        crossing = crossings(rates.distances, rates.micro(engine, "simple"), rates.micro(engine, "table"), NOISE)
        ahead = sum(a > b for a, b in zip(rates.micro(engine, "simple"), rates.micro(engine, "table")))
        parts = ", ".join(f"`{p}` " + (f"from {low:g} to {high:g}" if low < high else f"at {low:g}") for p, low, high in rates.fastest(engine))
        lines.append(f"- {rates.name()}, {said}: `simple` and `table` "
                     + (f"change places at {', '.join(f'{c:.1f}' for c in crossing)}" if crossing else "do not change places")
                     + f", `table` is ahead at {ahead} of {len(rates.distances)} distances; fastest of all: {parts}."
                     + (f" {lead_verdict(rates)}" if engine == "reference" else ""))
    return lines


def _picture(own, pictures):
    figure, plots = pictures.figure(2, width=10.5, height=4.2)
    for plot, rates in zip(plots, own):
        for engine, line, said in (("reference", "--", "as published"), ("fast", "-", "fast path")):
            for policy in POLICIES:
                plot.plot([d + 0.25 for d in rates.distances], [1e6 / t for t in rates.micro(engine, policy)],
                          **style(policy, linestyle=line, label=f"{policy}, {said}"))
        plot.axhline(1000, color="black", linestyle=":", linewidth=1)
        plot.set(xscale="log", yscale="log", xlabel="distance opened + 0.25, mm (0.25: full occlusion)", title=f"voxels of {rates.size} mm")
    plots[0].set_ylabel("queries a second, Hz (median)")
    plots[1].legend(fontsize=7, loc="lower right")
    return pictures.save(figure, "seed_rates",
                         f"Queries a second by distance, policy and engine, for voxels of {' and '.join(rates.size for rates in own)} mm",
                         f"n = {', '.join(f'{rates.n:.0f} queries a point at {rates.size} mm' for rates in own)}, one worker; dotted: 1000 Hz")


def rates(results, pictures):
    sizes = list(dict.fromkeys(run.parts[1] for run in results.runs("seed_bench", "rate")))
    all_rates = [Rates(results, size) for size in sorted(sizes, key=lambda size: size.startswith("scaled"))]
    own = [rates for rates in all_rates if not rates.size.startswith("scaled")]  # the others are left out of a quick run
    rows, verdicts, leads = [], [], []
    for rates in all_rates:
        for engine in ENGINES:
            for policy in POLICIES:
                worst, before = rates.worst(engine, policy), rates.at(engine, policy, rates.before_contact)
                rows.append([rates.name(), engine, f"`{policy}`", 1e6 / worst["p50_us"], worst.parts[4], worst["tests"],
                             1e6 / before["p50_us"], before["tests"]])
        verdicts += worst_verdicts(rates)
        leads += _lead_lines(rates)
    low, high = PUBLISHED["simple_wins_below"]
    agree = [sum(row[column] == "*Agrees*" for row in verdicts) for column in (4, 8)]
    return ["### Haptic rates by distance (figure 10)", "", _picture(own, pictures), "",
            f"Published are {PUBLISHED['worst_hz']['table']} Hz with `table` and {PUBLISHED['worst_hz']['simple']} Hz with `simple` "
            "in the worst case, which is *right before collision*; the text does not name which of its two voxel sizes this is. Here the pose before "
            "contact is the first distance at which no triangles meet. Rows with l/s have the same number of voxels along the jaw as the article at "
            "that size, and distances in its units.", "",
            *table(["voxel size", "engine", "spheres", "worst rate, Hz", "at distance", "sphere tests",
                    "rate before contact, Hz", "sphere tests"], rows), "",
            "The article's worst case against the depth-first query with the same spheres, on another machine. "
            f"A place agrees where it is that pose or the next one, a rate where neither is over {NEAR} times the other:", "",
            *table(["voxel size", "spheres", "worst at", "before contact", "right before collision",
                    "worst rate, Hz", "published, Hz", "ratio", "as published"], verdicts), "",
            f"The place agrees in {agree[0]} of {len(verdicts)} rows, the rate in {agree[1]}.", "",
            f"Policies: the article says that below a distance of {low} to {high} `simple` is faster than `table`, since spheres by the table "
            f"cost more to make than they save. Here, where a lead is {100 * (NOISE - 1):.0f} % or more:", "", *leads, "", *lead_reason(all_rates)]
