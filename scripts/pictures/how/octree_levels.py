"""The octree: its nodes, level by level, and the way down to one leaf with the children's bits of each node on it."""
import numpy as np
from matplotlib.collections import PolyCollection

from pictures.how.style import INK, MOVING, plt
from pictures.how.view import SHADES, View
from pictures.small_png import save_small_png

VOXEL = 4  # mm: the whole octree is seen
FACE = (0.80, 0.87, 0.94)


def nodes_of(command, tree, level):
    """Returns the centres of the nodes of a level, and the edge of their cubes."""
    spheres = command.spheres(tree, "simple", level)
    return spheres[:, :3], 2 * spheres[0, 3] / 3**0.5


def draw_cubes(place, view, centres, edge):
    """Draws cubes of one grid, those that are far first, by the faces that look at the eye."""
    corners = np.array([[[0, 0], [1, 0], [1, 1], [0, 1]]] * 3) - 0.5
    faces = []
    for axis in range(3):
        face = np.full((4, 3), 0.5 * np.sign(view.axes[2][axis]))
        face[:, [(axis + 1) % 3, (axis + 2) % 3]] = corners[axis]
        faces.append(view.seen(view.centre + edge * face)[:, :2])
    at = view.seen(centres)
    at = at[np.argsort(at[:, 2], kind="stable")]
    polygons = (at[:, None, None, :2] + np.array(faces)).reshape(-1, 4, 2)
    colours = np.tile([np.array(FACE) * shade for shade in SHADES], (len(at), 1))
    place.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors=INK, linewidths=0.4))


def way_down(levels, view):
    """Returns the node of each level that holds the leaf nearest to the eye, the leaf last."""
    leaf = levels[0][0][view.seen(levels[0][0])[:, 2].argmax()]
    return [int(np.abs(centres - leaf).max(1).argmin()) for centres, _ in levels][::-1]


def mask_of(parent, centres, edge):
    """Returns the bits of a node's children, octant 7 first; `edge` is a child's."""
    below = centres[(np.abs(centres - parent) < edge).all(1)]
    octants = {int(k) for k in ((below > parent) @ [1, 2, 4])}
    return "".join("1" if k in octants else "0" for k in range(7, -1, -1))


def draw(command, file):
    tree = command.tree("lower", voxel_size=VOXEL)
    depth = command.answer("info", tree)["depth"]
    levels = [nodes_of(command, tree, level) for level in range(depth + 1)]
    figure = plt.figure(figsize=(11, 7.4))
    places = figure.subplots(2, (depth + 2) // 2).flat
    figure.subplots_adjust(left=0.005, right=0.995, top=0.94, bottom=0.005, wspace=0.02, hspace=0.12)
    for place in places:
        place.axis("off")
    places = figure.axes
    (root,), edge = levels[depth]
    body = (levels[0][0].min(0) + levels[0][0].max(0)) / 2
    way = way_down(levels, View(places[0], root))
    for place, level, node in zip(places, range(depth, -1, -1), way):
        centres, size = levels[level]
        whole = size > edge / 8  # below, the body is all that is left
        view = View(place, root if whole else body)
        draw_cubes(place, view, centres, size)
        view.cube(centres[node] - size / 2, size, MOVING, zorder=3, width=1.8)
        view.show((0.83 if whole else 0.60) * edge)
        bits = f", {mask_of(centres[node], *levels[level - 1])}" if level else ""
        place.set_title(f"level {level}: {len(centres):,} node{'s' * (len(centres) > 1)}{bits}")
    save_small_png(figure, file)
    count = sum(len(centres) for centres, _ in levels)
    return (f"The octree of the lower jaw in voxels of {VOXEL} mm: {count:,} nodes, of {(8 ** (depth + 1) - 1) // 7:,} that fill space at this "
            "depth. Red is the way down to one voxel, with the eight bits of each node on it, octant 7 first.")
