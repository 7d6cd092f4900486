"""The look and the files of all plots of the report. A plot is a function that gives panels of lines as data."""

import math
import pathlib
import textwrap
import xml.etree.ElementTree as ElementTree

from report.tables import value_of

# Each policy and engine has one colour and one mark in all plots, so that they differ without colours too.
STYLE = {"simple": ("#888888", "s"), "table": ("#d95f02", "o"), "tight": ("#7570b3", "^"), "slab": ("#1b9e77", "D"), "exact": ("#e7298a", "*"),
         "touches": ("#e6ab02", "P")}
LOG = {"xscale": "log", "yscale": "log"}
DOTTED = {"color": "black", "linestyle": ":", "linewidth": 1}
PLOTS = {}  # by the name of the picture: the program that measures it, and the function that gives it


def plot(program):
    """Registers a function of the results that returns `panels`, `n` (how often each point was measured), and sizes in inches. A panel has
    lines, rules (axvline or axhline), what Axes.set() takes, and what legend() takes. `then` changes the axes after that."""
    def add(function):
        PLOTS[function.__name__] = program, function
        return function
    return add


def style(name, **more):
    """Returns colour and mark of a policy or engine."""
    colour, mark = STYLE[name]
    return {"color": colour, "marker": mark, "label": name} | more


def line(rows, x, y, **look):
    """Returns a line through two values of each row."""
    return [value_of(r, x) for r in rows], [value_of(r, y) for r in rows], look


def panel(lines, rules=(), legend=None, **settings):
    return {"lines": lines, "rules": rules, "legend": legend, "settings": settings}


def plain_ticks(axes):
    """Writes numbers in decimals on logarithmic axes: at each decade, and at 2 and 5 if there are few decades."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if axis.get_scale() == "log":
            axis.set_major_locator(LogLocator(subs=(1, 2, 5) if abs(math.log10(high / low)) < 2.4 else (1,), numticks=20))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}" if 1e-4 < value < 1e6 else f"{value:.0e}"))
            axis.set_minor_formatter(NullFormatter())


def pyplot():
    """Returns matplotlib's pyplot, which writes SVG with the same bytes each time. machine.build() has installed it."""
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt  # after the backend is chosen

    plt.rcParams.update({"svg.hashsalt": "ist", "svg.fonttype": "none"})
    return plt


def draw(folder, machine_of, results):
    """Writes each plot as NAME.svg. Below it stand how often its points were measured, and the machine."""
    plt = pyplot()
    plt.rcParams.update({
        "svg.fonttype": "path", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False,
        "axes.spines.right": False, "legend.frameon": False, "lines.markersize": 4.5, "lines.linewidth": 1.3, "figure.constrained_layout.use": True})
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    for name, (program, function) in PLOTS.items():
        made = function(results)
        panels = made["panels"]
        width = made.get("width", 4.6 * len(panels) + 1)
        figure, (all_axes,) = plt.subplots(1, len(panels), figsize=(width, made.get("height", 3.6)), squeeze=False)
        for axes, each in zip(all_axes, panels):
            for xs, ys, look in each["lines"]:
                axes.plot(xs, ys, **look)
            for kind, at, look in each["rules"]:
                getattr(axes, kind)(at, **look)
            axes.set(**each["settings"])
            if each["legend"] is not None:
                axes.legend(**{"fontsize": 8} | each["legend"])
        if "then" in made:
            made["then"](figure, all_axes)
        for axes in all_axes:
            plain_ticks(axes)
        # 6.5 points are some 20 letters an inch.
        figure.supxlabel(textwrap.fill(f"{made['n']}. {machine_of(program)}", int(20 * width)), fontsize=6.5, color="#555555", x=0.01, ha="left")
        figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
        plt.close(figure)
        ElementTree.parse(folder / f"{name}.svg")
