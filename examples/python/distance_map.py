"""Draws how far two jaws are from each other, each as the other one sees it, with a colour bar in mm.

    distance_map.py PICTURE.png                     the built-in jaws
    distance_map.py PICTURE.png UPPER LOWER         mesh files, both in the same coordinates, in mm

Run it with a Python that has the packages ist and matplotlib.
"""

import argparse
import sys

import ist
import numpy as np

try:
    import matplotlib
    matplotlib.use("Agg")  # draws into files, and needs no display
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import TwoSlopeNorm
    from matplotlib.figure import Figure
except ImportError as missing:
    sys.exit(f"distance_map: {missing}: install it by apt-get install python3-matplotlib, or by pip install matplotlib")

BEYOND = "#d8d4ca"  # colour of all that is farther away than the reach


def facing(tree, axis, side):
    """The triangles that face along an axis (0, 1 or 2; side is 1 or -1), from the farthest to the nearest for an eye
    there, and the corners as that eye sees them, (n, 3, 2)."""
    corners = tree.vertices[tree.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    faces = np.flatnonzero(side * normals[:, axis] > 0)
    faces = faces[np.argsort(side * corners[faces, :, axis].mean(axis=1), kind="stable")]
    right, up = (axis + 1) % 3, (axis + 2) % 3
    return faces, np.stack([side * corners[faces][..., right], corners[faces][..., up]], axis=-1)


def draw(upper, lower, pose, reach=2.0, axis=2):
    """A figure of two trees. The pose maps the lower jaw's coordinates to the upper's; the upper jaw is above along
    the axis."""
    bodies = (("upper jaw, from below", upper, ist.distance_map(upper, lower, np.linalg.inv(pose), reach=reach), -1),
              ("lower jaw, from above", lower, ist.distance_map(lower, upper, pose, reach=reach), 1))
    deepest = min(np.nanmin(signed["distance"], initial=0.0) for _, _, signed, _ in bodies)
    # Zero has the middle colour, however much deeper or farther the ends are.
    norm = TwoSlopeNorm(0.0, vmin=min(deepest, -0.05 * reach), vmax=reach)
    colours = matplotlib.colormaps["RdYlBu"].with_extremes(bad=BEYOND)
    figure = Figure(figsize=(11, 5.5), dpi=100, layout="constrained")
    figure.suptitle("Signed distance from the other jaw, mm")
    places = figure.subplots(1, 2)
    for place, (name, tree, signed, side) in zip(places, bodies):
        faces, corners = facing(tree, axis, side)
        shown = PolyCollection(corners, array=np.ma.masked_invalid(signed["distance"][tree.faces[faces]].mean(axis=1)),
                               cmap=colours, norm=norm, edgecolors="face", linewidths=0.3)
        place.add_collection(shown)
        place.autoscale_view()
        place.set(title=name, aspect="equal", xlabel="mm", ylabel="mm")
    figure.colorbar(shown, ax=places, label="mm; negative inside the other jaw", format="%.2f",
                    ticks=[norm.vmin, *np.linspace(0.0, reach, 5)])
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", metavar="PICTURE.png")
    parser.add_argument("meshes", nargs="*", metavar="UPPER LOWER")
    parser.add_argument("--move", default="0,0,0", metavar="x,y,z", help="moves the lower jaw, mm")
    parser.add_argument("--reach", type=float, default=2.0, metavar="MM", help="farther distances are not coloured")
    parser.add_argument("--axis", choices="xyz", default="z", help="points from the lower jaw to the upper")
    arguments = parser.parse_args()
    if len(arguments.meshes) not in (0, 2):
        parser.error("name the upper and the lower jaw, or none for the built-in jaws")
    pose = np.eye(4)
    try:
        pose[:3, 3] = [float(number) for number in arguments.move.split(",")]
        meshes = [ist.read_mesh(file) for file in arguments.meshes] or ist.jaws()
        upper, lower = map(ist.build, meshes)
        draw(upper, lower, pose, arguments.reach, "xyz".index(arguments.axis)).savefig(arguments.picture)
    except (ValueError, ist.Error, OSError) as wrong:
        sys.exit(f"distance_map: {wrong}")


if __name__ == "__main__":
    main()
