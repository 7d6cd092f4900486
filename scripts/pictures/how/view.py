"""How the pictures of docs/how-it-works.md look: on a white ground, so that a dark page shows them as a light one does; and an eye far
away, which sees cubes, balls, discs and faces."""
import pathlib

import numpy as np
from matplotlib.patches import Circle, Polygon

from pictures.drawing import eye_axes, normals_of, plt

# As in the plots of perf/REPORT.md.
POLICY = {"simple": "#888888", "table": "#d95f02", "tight": "#7570b3", "slab": "#1b9e77"}
FIXED, MOVING, INK, PALE = "#1f618d", "#b03a2e", "#333333", "#c9c9c9"

plt.rcParams.update({
    "svg.hashsalt": "ist", "svg.fonttype": "path", "font.size": 10, "axes.titlesize": 10, "text.color": INK,
    "axes.edgecolor": INK, "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False,
})
SKIN, CUBE = (0.93, 0.86, 0.70), (0.80, 0.87, 0.94)
BACK = np.array([0.55, -0.75, 0.42])  # towards the eye
LIGHT = np.array([0.15, -0.55, 0.80])
SHADES = (0.80, 0.90, 1.0)  # of a cube's faces across x, y and z


def save(figure, file):
    """Writes an SVG without a date, and without the spaces at the ends of lines."""
    file = pathlib.Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, metadata={"Date": None}, facecolor="white")
    file.write_text("\n".join(line.rstrip() for line in file.read_text().splitlines()) + "\n")
    plt.close(figure)


def face_of_cube(axis, side):
    """Returns the corners of a face of the unit cube."""
    corners = np.zeros((4, 3))
    corners[:, axis] = side
    corners[1:3, (axis + 1) % 3] = 1
    corners[2:4, (axis + 2) % 3] = 1
    return corners


def light_on(normals):
    """Returns the light on surfaces, which are lit from both sides."""
    return np.abs(normals @ LIGHT) / np.linalg.norm(LIGHT)


class View:
    def __init__(self, place, centre=(0, 0, 0)):
        self.place, self.centre, self.axes = place, np.asarray(centre, float), eye_axes(BACK)

    def near_side(self, axis):
        """Returns the side of a cube that looks at the eye: 0 or 1."""
        return int(self.axes[2][axis] > 0)

    def add(self, patch):
        patch.set_clip_on(False)
        self.place.add_patch(patch)

    def seen(self, points):
        return (np.asarray(points, float) - self.centre) @ self.axes.T

    def cube(self, low, edge, colour, face=None, zorder=1, width=0.9):
        """A cube; with a face colour its faces that look at the eye, else all its edges, those behind dotted."""
        for axis in range(3):
            for side in (0, 1):
                looks = side == self.near_side(axis)
                points = self.seen(low + edge * face_of_cube(axis, side))[:, :2]
                if face and looks:
                    fill = tuple(SHADES[axis] * np.array(face))
                    self.add(Polygon(points, facecolor=fill, edgecolor=colour, linewidth=width, zorder=zorder + 0.1))
                elif not face:
                    self.add(Polygon(points, fill=False, edgecolor=colour, linewidth=width if looks else 0.6 * width,
                                     linestyle="-" if looks else ":", zorder=zorder + (0.1 if looks else 0)))

    def ball(self, centre, radius, colour, zorder=3, alpha=0.13, width=1.3):
        at = self.seen(centre)[:2]
        self.add(Circle(at, radius, facecolor=colour, alpha=alpha, linewidth=0, zorder=zorder))
        self.add(Circle(at, radius, fill=False, edgecolor=colour, linewidth=width, zorder=zorder + 0.1))

    def faces(self, polygons, face, edge, zorder=2):
        """Polygons, those that are far first, lit from both sides."""
        for points in sorted(polygons, key=lambda each: self.seen(each)[:, 2].mean()):
            lit, = light_on(normals_of(points[None, [0, 1, -1]]))
            self.add(Polygon(self.seen(points)[:, :2], facecolor=tuple((0.62 + 0.38 * lit) * np.array(face)),
                             edgecolor=edge, linewidth=0.5, zorder=zorder))

    def disc(self, centre, normal, radius, colour, zorder=3, alpha=0.28):
        normal = normal / np.linalg.norm(normal)
        one = np.cross(normal, [1, 0, 0] if abs(normal[0]) < 0.8 else [0, 1, 0])
        one /= np.linalg.norm(one)
        turn = np.linspace(0, 2 * np.pi, 73)[:, None]
        rim = centre + radius * (np.cos(turn) * one + np.sin(turn) * np.cross(normal, one))
        points = self.seen(rim)[:, :2]
        self.add(Polygon(points, facecolor=colour, alpha=alpha, linewidth=0, zorder=zorder))
        self.add(Polygon(points, fill=False, edgecolor=colour, linewidth=1.1, zorder=zorder + 0.1))

    def show(self, reach):
        self.place.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
        self.place.axis("off")
