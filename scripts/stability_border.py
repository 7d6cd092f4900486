#!/usr/bin/python3
"""Makes perf/HAPTIC_STABILITY.md and its plots: presses walls with stiffer and stiffer couplings, and shows the energy that comes back
and the stiffness at which that begins, beside the border that the loop computes. Walls are a constraint or springs. It times nothing.
Some three minutes on one core, once built.

    scripts/stability_border.py"""
import collections
import json
import subprocess
import sys

from machine import build, machine, refuse
from report.draw import pyplot
from report.figures import ROOT, here, stamp
from report.tables import fill, markdown

PAGE = ROOT / "perf/HAPTIC_STABILITY.md"
USED = 0.8  # of the computed border: what clamp_coupling() leaves
HIGHEST = 4  # times the computed border: measured_border() searches up to there
UNITS = {"push": ("N/m", "N s/m"), "turn": ("N m/rad", "N m s/rad")}


def panel(axes, key, presses, borders, norm):
    _, wall, delay, rate = key
    stiffness, damping = UNITS[wall]
    drawn = axes.scatter([p["damping"] for p in presses], [p["stiffness"] for p in presses], s=26, cmap="RdBu_r", norm=norm,
                         c=[1e6 * p["returned"] for p in presses], edgecolors="0.5", linewidths=0.3)
    dampings = [b["damping"] for b in borders]
    axes.plot(dampings, [b["computed"] for b in borders], "k-", linewidth=1, label="computed border")
    axes.plot(dampings, [USED * b["computed"] for b in borders], "k--", linewidth=1, label="80 %, used")
    axes.plot(dampings, [b["measured"] for b in borders], "x", color="tab:green", markersize=7, markeredgewidth=1.6, label="measured border")
    axes.set_yscale("log")
    axes.set_title(f"{wall}, {rate:g} Hz, delay {1e3 * delay:g} ms", fontsize=8)
    axes.set_xlabel(f"device damping, {damping}", fontsize=7)
    axes.set_ylabel(f"coupling stiffness, {stiffness}", fontsize=7)
    axes.tick_params(labelsize=7)
    return drawn


def plot(groups, file):
    rates = sorted({key[-1] for key in groups})
    rows = list(dict.fromkeys(key[:-1] for key in groups))
    plt = pyplot()
    figure, axes = plt.subplots(len(rows), len(rates), figsize=(10, 2.6 * len(rows)), squeeze=False, layout="constrained")
    norm = plt.matplotlib.colors.SymLogNorm(linthresh=10, vmin=-1e4, vmax=1e4)
    for key, (presses, borders) in groups.items():
        drawn = panel(axes[rows.index(key[:-1])][rates.index(key[-1])], key, presses, borders, norm)
    axes[0][0].legend(fontsize=6, loc="lower right")
    figure.colorbar(drawn, ax=axes, shrink=0.5, label="energy returned by a press, µJ: above 0 the wall is active")
    figure.savefig(file, metadata={"Date": None})


def table(groups):
    """Returns the lines of the table, the number of presses within the part used, and how many of these exceed their allowance."""
    rows, used, broken = [], 0, 0
    for (stop, wall, delay, rate), (presses, borders) in groups.items():
        inside = [p for p in presses if p["stiffness"] <= (USED + 1e-9) * p["computed"]]
        used += len(inside)
        broken += sum(p["returned"] > p["allowance"] for p in inside)
        worst = max(inside, key=lambda p: p["returned"] - p["allowance"])
        growing = min((p["stiffness"] / p["computed"] for p in presses if p["growth"] > 1), default=None)
        ratios = [b["measured"] / b["computed"] for b in borders]
        most = "none found" if max(ratios) >= 0.99 * HIGHEST else f"{max(ratios):.2f}"
        rows.append([stop, wall, f"{rate:g}", f"{1e3 * delay:g}", str(len(presses)),
                     f"{1e6 * worst['returned']:.1f} / {1e6 * worst['allowance']:.1f}",
                     f"{growing:.2f}" if growing else "nowhere", f"{min(ratios):.2f} to {most}"])
    return markdown(["stop", "wall", "rate, Hz", "delay, ms", "presses", "within 80 %: worst returned / allowance, µJ", "grows from",
                     "measured / computed"], rows, right=range(2, 8)), used, broken


def main():
    refuse(sys.argv[1:], __doc__)
    build("bench", "stability_border", needs=["--bench"])
    on = machine()
    on.results.mkdir(parents=True, exist_ok=True)
    lines = subprocess.run(["build/bench/bench/stability_border"], check=True, stdout=subprocess.PIPE, text=True).stdout
    (on.results / "stability_border.jsonl").write_text(lines)
    groups = collections.defaultdict(lambda: ([], []))  # presses and borders by stop, wall, delay and rate, in the order of the sweep
    for line in map(json.loads, lines.splitlines()):
        groups[line["stop"], line["wall"], line["delay"], line["rate"]]["measured" in line].append(line)
    for stop in {key[0] for key in groups}:
        plot({key: group for key, group in groups.items() if key[0] == stop}, PAGE.parent / f"pictures/stability_border_{stop}.svg")
    rows, used, broken = table(groups)
    text = (f"{on.model}; {on.compiler}; commit {on.commit}. {sum(len(p) for p, _ in groups.values())} presses; of the {used} within "
            f"{100 * USED:.0f} % of the border, the part that the loop uses, {broken} returned more than their allowance.")
    fill(PAGE, "presses", "\n".join([text, "", *rows, "", stamp(*here(), "stability_border.py")]))
    if broken:
        sys.exit(f"stability_border: {broken} presses within the part used returned more than their allowance")


if __name__ == "__main__":
    main()
