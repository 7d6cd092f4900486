"""How every plot of the report looks, and where it goes."""

import math
import pathlib
import textwrap
import xml.etree.ElementTree as ElementTree

# matplotlib is imported by what draws alone: the verdicts of chapters are tested where it is missing.

from report.styles import style  # noqa: E402, F401  for those who draw


def plain_ticks(axes):
    """Numbers as people write them, on axes in logarithms: at each decade, and at 2 and 5 where there are few."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        if axis.get_scale() != "log":
            continue
        decades = abs(math.log10(high / low))
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if decades < 2.4 else (1,), numticks=20))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}" if 1e-4 < value < 1e6 else f"{value:.0e}"))
        axis.set_minor_formatter(NullFormatter())


class Pictures:
    """Makes plots and keeps them, each with what it takes to read it on paper."""

    def __init__(self, folder, machine):
        import matplotlib

        matplotlib.use("svg")
        import matplotlib.pyplot as plt  # after the backend is chosen

        self.folder, self.machine, self.plt = pathlib.Path(folder), machine, plt
        self.folder.mkdir(parents=True, exist_ok=True)
        plt.rcParams.update({
            "svg.hashsalt": "ist", "svg.fonttype": "path", "font.size": 9, "axes.grid": True, "grid.alpha": 0.3,
            "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.markersize": 4.5,
            "lines.linewidth": 1.3, "figure.constrained_layout.use": True,
        })

    def figure(self, columns=1, width=None, height=3.6):
        """A figure and its axes, side by side; one axes alone where there is one column."""
        return self.plt.subplots(1, columns, figsize=(width or 4.6 * columns + 1, height))

    def save(self, figure, name, alt, n):
        """Writes NAME.svg, under it `n` (what was measured how often) and the machine; gives the markdown."""
        for axes in figure.axes:
            plain_ticks(axes)
        # 6.5 points are some 20 letters an inch.
        caption = textwrap.fill(f"{n}. {self.machine}", int(20 * figure.get_figwidth()))
        figure.supxlabel(caption, fontsize=6.5, color="#555555", x=0.01, ha="left")
        file = self.folder / f"{name}.svg"
        figure.savefig(file, metadata={"Date": None})
        self.plt.close(figure)
        ElementTree.parse(file)
        return f"![{alt}](pictures/{self.folder.name}/{name}.svg)"
