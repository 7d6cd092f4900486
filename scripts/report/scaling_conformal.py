"""Section of scaling: time against the area of bodies that lie along each other."""

from report.curves import power
from report.scaling_asked import COLOURS, PROGRAM, queries
from report.text import number, table

TICK = 1000  # µs, of a haptic loop at 1 kHz


def section(results, pictures):
    runs = results.runs(PROGRAM, "conformal")
    figure, (time, pairs) = pictures.figure(2)
    rows = []
    kinds = [(kind, gap) for kind in ("plates", "shells") for gap in ("0.05", "0.5")]
    for (kind, gap), colour, mark in zip(kinds, COLOURS, "DosP"):
        own = [run for run in runs if run.parts[1:3] == [kind, gap]]
        area, times = [run["area_mm2"] for run in own], [run["p50_us"] for run in own]
        exponent, factor = power(area, times)
        time.loglog(area, times, "-" + mark, color=colour, label=f"{kind}, {gap} mm apart: area^{exponent:.2f}")
        met = [(run["area_mm2"], run["contacts"]) for run in own if run["contacts"] > 0]
        if met:
            pairs.loglog(*zip(*met), "-" + mark, color=colour, label=f"{kind}, {gap} mm apart")
        last = own[-1]
        rows.append([f"{kind}, {gap} mm", f"area^{exponent:.2f}", last["area_mm2"], last["leaves"], last["contacts"],
                     last["tests"], 1e-3 * last["p50_us"], 1e3 * last["p50_us"] / last["tests"],
                     (TICK / factor) ** (1 / exponent)])
    time.axhline(TICK, color="#555555", linestyle=":", label="1 ms")
    time.set(ylabel="time of a query, µs", title="Time against area (medians)")
    pairs.set(ylabel="leaf pairs", title="Leaf pairs against area")
    for axes in (time, pairs):
        axes.set_xlabel("area that lies along the other body, mm²")
        axes.legend(fontsize=7)
    picture = pictures.save(figure, "scaling_conformal", "Time and leaf pairs against conformal area, log-log",
                            queries(runs))
    worst = max(runs, key=lambda run: run["p50_us"])
    lines = ["### Against conformal area", "",
             "Surfaces that lie along each other have the most leaf pairs: two square plates, and a sphere in "
             "a shell. Leaves whose bounds overlap are leaf pairs, so the nearer surface has many times more. The "
             f"worst here, {worst.parts[1]} {worst.parts[2]} mm apart on {number(worst['area_mm2'])} mm², takes "
             f"{verdict(worst)} The last column gives the area at which the "
             "fitted power reaches 1 ms.", ""]
    lines += table(["bodies", "time grows as", "largest area, mm²", "leaves", "leaf pairs", "tests", "median, ms",
                    "ns a test", "1 ms by the fit, mm²"], rows)
    return lines + ["", picture]


def verdict(worst):
    """Whether the worst query lasts longer than a tick."""
    time = f"{number(1e-3 * worst['p50_us'])} ms"
    if worst["p50_us"] > TICK:
        return f"**{time}**, longer than a tick of {number(1e-3 * TICK)} ms: such a query needs a budget."
    return f"{time}, within a tick of {number(1e-3 * TICK)} ms."
