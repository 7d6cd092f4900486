#!/usr/bin/env python3
"""Draws the picture of docs/occlusion.md: the figure that `ist occlusion` makes of the built-in jaws, in 256 colours.

    scripts/draw_bite.py PATH/TO/ist OUTPUT.png

It needs Debian's python3-pil, so run it with the system's python3.
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

BITE = ["--move", "0,0,-0.6", "--preset", "stl", "--no-names"]


def main(ist, output):
    with tempfile.TemporaryDirectory() as folder:
        ist = pathlib.Path(ist).resolve()
        subprocess.run([ist, "demo", "--voxel-size", "0.8", "--keep", folder], check=True, capture_output=True)
        jaws = [f"{folder}/{name}_jaw.stl" for name in ("upper", "lower")]
        figure = f"{folder}/bite.png"
        subprocess.run([ist, "occlusion", *jaws, *BITE, "-o", figure], check=True, capture_output=True)
        picture = Image.open(figure).convert("RGB")
        # The version of the program stands in the last line, and would differ with each commit.
        picture = picture.crop((0, 0, picture.width, picture.height - 43))
        picture.quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=4, dither=Image.Dither.NONE).save(output, optimize=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
