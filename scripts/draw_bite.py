#!/usr/bin/env python3
"""Draws the picture of docs/occlusion.md: both distance maps of a report by `ist occlusion`, and their legend.

    scripts/draw_bite.py PATH/TO/ist OUTPUT.png

The command makes the built-in jaws, the maps and the words of the legend. The script needs Debian's python3-matplotlib, so run it
with the system's python3.
"""
import base64
import io
import json
import pathlib
import re
import sys
import tempfile

from matplotlib.patches import Rectangle
from pictures.drawing import NAMES, Command, plt, save_small_png

BITE = ["--move", "0,0,-0.6", "--preset", "stl"]
IMAGE = re.compile(r'src="data:image/png;base64,([^"]+)"')
ENTRY = re.compile(r'<li><svg class="swatch"[^>]*>(.*?)</svg>(.*?)</li>')
COLOUR = re.compile(r'fill="rgb\((\d+),(\d+),(\d+)\)"')


def draw_legend(place, entries):
    """Draws the swatch and the words of each entry, in two columns."""
    half = (len(entries) + 1) // 2
    for at, (swatch, words) in enumerate(entries):
        x, y = divmod(at, half)
        if rgb := COLOUR.search(swatch):
            colour = [int(part) / 255 for part in rgb.groups()]
            hatch = "//" if "<path" in swatch else None
            place.add_patch(Rectangle((x, -y), 0.06, 0.7, facecolor=colour, edgecolor="white", linewidth=0, hatch=hatch))
        else:
            core, ring = re.search(r'fill="(\w+)" stroke="(\w+)"', swatch).groups()
            place.scatter([x + 0.03], [0.35 - y], s=60, c=core, edgecolors=ring, linewidths=1.5)
        place.text(x + 0.075, 0.35 - y, words, fontsize=16, va="center")
    place.set(xlim=(-0.05, 2), ylim=(0.6 - half, 1))
    place.axis("off")


def main(ist, output):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        command = Command(pathlib.Path(ist).resolve(), folder)
        files = folder / "bite.report.html", folder / "bite.json"
        command.lines("occlusion", *map(command.mesh, NAMES), *BITE, "-o", files[0], "-o", files[1])
        page, report = files[0].read_text(), json.loads(files[1].read_text())
    figure = plt.figure(figsize=(18, 9.4), dpi=100)
    for at, (image, key, jaw) in enumerate(zip(IMAGE.findall(page), ("fixed", "moving"), NAMES)):
        within, contacts = report[key]["areas"][0], len(report[key]["regions"])
        place = figure.add_axes((at / 2, 2 / 9.4, 0.5, 7 / 9.4))
        place.imshow(plt.imread(io.BytesIO(base64.b64decode(image))))
        near = f"{within['area']:.1f} mm² within {within['micrometres'] / 1000:g} mm or overlapping"
        place.set_title(f"{jaw} jaw: {near}; {contacts} contacts", fontsize=16)
        place.axis("off")
    draw_legend(figure.add_axes((0.02, 0, 0.96, 0.2)), ENTRY.findall(page))
    save_small_png(figure, output)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
