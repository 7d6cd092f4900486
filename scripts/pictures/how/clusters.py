"""The tree of triangle clusters: a jaw coloured by the nodes of three levels, and the bounds of one cluster.

No public function returns the nodes, so the triangles of each follow from the rule of the library's order."""
import colorsys

import numpy as np

from pictures.drawing import DepthBuffer, normals_of, plt, read_stl, save_small_png
from pictures.how.triangle_order import WIDTH, frame_of, order_of
from pictures.how.view import INK, POLICY, SKIN, View, light_on

PANEL = 1080, 800  # samples, two to a pixel
NEAR = 110  # samples a mm
LINE, EDGE = 0.25, 0.72  # the light on the lines between nodes, and between triangles


def borders(labels):
    """Returns the samples whose neighbour to the right or above has another label."""
    found = np.zeros(labels.shape, bool)
    found[:, :-1] |= labels[:, :-1] != labels[:, 1:]
    found[:-1] |= labels[:-1] != labels[1:]
    return found


def seen(triangles, view, scale):
    """Returns the triangle at each sample, or -1."""
    buffer = DepthBuffer(*PANEL)
    points = view.seen(triangles.reshape(-1, 3)) * scale + (PANEL[0] / 2, PANEL[1] / 2, 0)
    buffer.draw(points, np.arange(len(points)).reshape(-1, 3))
    return buffer.nearest.reshape(PANEL[::-1])


def draw_nodes(place, triangles, found, nodes, with_edges):
    """Draws the visible triangles, coloured by their nodes. Nodes that follow each other differ in colour."""
    palette = np.array([colorsys.hsv_to_rgb(0.618034 * node % 1, 0.22 + 0.12 * (node % 3), 0.95) for node in range(nodes.max() + 1)])
    colours = palette[nodes] * (0.55 + 0.45 * light_on(normals_of(triangles)))[:, None]
    image = np.where((found >= 0)[..., None], colours[found], 1.0)
    if with_edges:
        image[borders(found)] *= EDGE
    image[borders(np.where(found >= 0, nodes[found], -1))] *= LINE
    image = image.reshape(PANEL[1] // 2, 2, PANEL[0] // 2, 2, 3).mean((1, 3))
    place.imshow(image, origin="lower", interpolation="antialiased")
    place.axis("off")


def draw_bounds(place, triangles, axes):
    """Draws the box, the disc and the ball of a cluster. Returns the ball's radius and how thick the disc is."""
    corners = triangles.reshape(-1, 3)
    along = corners @ axes
    low, high = along.min(0), along.max(0)
    centre = axes @ ((low + high) / 2)
    away = corners - centre
    radius = np.linalg.norm(away, axis=1).max()
    normal = np.linalg.eigh(np.cov(corners.T))[1][:, 0]
    heights = away @ normal
    rim = np.sqrt(((away**2).sum(1) - heights**2).max())
    view = View(place, centre)
    view.faces(list(triangles), SKIN, INK)
    box = axes @ (np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * (high - low) + low).T
    for one in range(8):
        for other in (one ^ 1, one ^ 2, one ^ 4):
            if one < other:
                place.plot(*view.seen(box.T[[one, other]])[:, :2].T, color=INK, linewidth=1.0, zorder=3)
    for height in (heights.min(), heights.max()):
        view.disc(centre + height * normal, normal, rim, POLICY["slab"], alpha=0.10)
    view.ball(centre, radius, POLICY["tight"], alpha=0.08)
    view.show(1.03 * radius)
    return radius, np.ptp(heights)


def draw(command, file):
    triangles = read_stl(command.mesh("lower"))
    order = order_of(triangles)
    rank = np.empty(len(order), int)
    rank[order] = np.arange(len(order))
    middle, axes = frame_of(triangles)
    figure = plt.figure(figsize=(11, 8.6))
    places = figure.subplots(2, 2).flat
    figure.subplots_adjust(left=0.005, right=0.995, top=0.965, bottom=0.005, wspace=0.02, hspace=0.07)
    whole = View(places[0], middle)
    along = whole.seen(triangles.reshape(-1, 3))
    whole.centre = middle + (along.min(0) + along.max(0)) / 2 @ whole.axes
    found = seen(triangles, whole, 0.97 * (PANEL / np.ptp(along, axis=0)[:2]).min())
    counts = {}
    for place, level in zip(places, (2, 1)):
        nodes = rank // WIDTH ** (level + 1)
        counts[level] = nodes.max() + 1
        draw_nodes(place, triangles, found, nodes, False)
        place.set_title(f"level {level}: {counts[level]:,} nodes of {WIDTH ** (level + 1):,} triangles")
    near = View(places[2], triangles[whole.seen(triangles)[..., 2].mean(1).argmax()].mean(0))
    found, nodes = seen(triangles, near, NEAR), rank // WIDTH
    draw_nodes(places[2], triangles, found, nodes, True)
    chosen = nodes[found[PANEL[1] // 2, PANEL[0] // 2]]
    places[2].set_title(f"level 0: some of {nodes.max() + 1:,} clusters of sixteen triangles")
    radius, thick = draw_bounds(places[3], triangles[order[WIDTH * chosen:WIDTH * (chosen + 1)]], axes)
    places[3].set_title("the cluster in the middle of the picture on the left, in its box, disc and ball")
    save_small_png(figure, file)
    return (f"The {len(triangles):,} triangles of the lower jaw in the library's order, which this picture computes by the same rule: {counts[2]} "
            f"nodes of 4,096 triangles, {counts[1]} of 256 and {nodes.max() + 1:,} clusters of sixteen. One cluster lies in a box, in a ball with a "
            f"radius of {radius:.2f} mm, and between two discs {thick:.2f} mm apart.")
