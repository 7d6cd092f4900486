"""How the pictures of docs/how-it-works.md look: on a white ground, so that a dark page shows them as a light one does."""
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  after the backend is chosen

# As in the plots of perf/REPORT.md.
POLICY = {"simple": "#888888", "table": "#d95f02", "tight": "#7570b3", "slab": "#1b9e77"}
FIXED, MOVING, INK, PALE = "#1f618d", "#b03a2e", "#333333", "#c9c9c9"

plt.rcParams.update({
    "svg.hashsalt": "ist", "svg.fonttype": "path", "font.size": 10, "axes.titlesize": 10, "text.color": INK,
    "axes.edgecolor": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False,
})


def save(figure, file):
    """Writes an SVG without a date, and without the spaces at the ends of lines."""
    file = pathlib.Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, metadata={"Date": None}, facecolor="white")
    file.write_text("\n".join(line.rstrip() for line in file.read_text().splitlines()) + "\n")
    plt.close(figure)
