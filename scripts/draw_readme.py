#!/usr/bin/env python3
"""Draws README's first screen, to the end of the output of its first commands, as a picture for pages elsewhere.

    scripts/draw_readme.py [OUTPUT.png]     build/readme.png, if none is named

It is a part of the site that scripts/docs.sh makes of the same README. Chromium draws it (IST_CHROMIUM; by default /usr/bin/chromium). The script
needs Debian's python3-matplotlib for its Pillow, so run it with the system's python3.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from PIL import Image, ImageChops

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "build/docs"
WIDTH, HEIGHT, MARGIN = 1000, 2000, 24  # pixels; the white part below is cut off
STYLE = (f"body {{background: white; padding: {MARGIN}px}} pre, pre code {{white-space: pre-wrap !important; background: white}}"
         ".rst-content img {display: block; margin: auto; max-width: 80%}")


def first_screen():
    """Returns a page of README up to its first output, the first block of code without a language."""
    copy = DOCS / "pages/README.md"
    if not copy.is_file() or copy.read_bytes() != (ROOT / "README.md").read_bytes():
        sys.exit("draw_readme: the site is not of this README: run scripts/docs.sh")
    site = (DOCS / "site/index.html").read_text()
    shown = re.search(r'<h1 id="ist">.*?<pre><code>.*?</code></pre>', site, re.DOTALL)
    if shown is None:
        sys.exit("draw_readme: README has no title and output: see first_screen()")
    styles = "".join(re.findall(r'<link rel="stylesheet"[^>]*>', site))
    return (f'<meta charset="utf-8"><base href="{(DOCS / "site").as_uri()}/">{styles}<style>{STYLE}</style>'
            f'<div class="rst-content">{shown[0]}</div>')


def main(output=ROOT / "build/readme.png"):
    with tempfile.TemporaryDirectory() as folder:
        page, drawn = pathlib.Path(folder, "page.html"), pathlib.Path(folder, "page.png")
        page.write_text(first_screen())
        subprocess.run([os.environ.get("IST_CHROMIUM", "/usr/bin/chromium"), "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                        f"--window-size={WIDTH},{HEIGHT}", f"--screenshot={drawn}", page.as_uri()], check=True, capture_output=True)
        image = Image.open(drawn).convert("RGB")
    below = ImageChops.invert(image).getbbox()[3]
    if below == HEIGHT:
        sys.exit(f"draw_readme: the first screen is higher than {HEIGHT} pixels")
    image.crop((0, 0, WIDTH, below + MARGIN)).save(output, optimize=True)


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
