"""Draws the pictures of the pages anew, and compares them with those that are there.

    pictures.py NAME PATH/TO/ist PATH/TO/libist_loop.so FOLDER

NAME says which script: how, tree, bite or closing. A picture of pixels may differ in 1 % of them, and one of lines by a
hundredth of a unit of its numbers, since other versions of what draws them round otherwise. Where matplotlib is missing, that
is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it is 1."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# The script, its arguments behind the command, and the pictures of docs/pictures that it draws.
SCRIPTS = {
    "how": ("draw_how.py", ["{library}", "{folder}", "--check"],
            ["octree.png", "table.svg", "bounds.svg", "frontiers.png", "pair_cache.svg", "clusters.png", "intervals.svg"]),
    "tree": ("draw_tree.py", ["{folder}/tree.png"], ["tree.png"]),
    "bite": ("draw_bite.py", ["{folder}/bite.png"], ["bite.png"]),
    "closing": ("draw_closing.py", ["{folder}/closing.svg"], []),  # no page shows it
}
MADE_IDS = re.compile(r"\b[a-z][0-9a-f]{10}\b")  # matplotlib's, hashes of what they name
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
NEAR = 0.01
MOST_PIXELS, FAINT = 0.01, 24  # the share of pixels that may differ, by more than this of 255


def flaw_of_lines(drawn, kept):
    """Says how two SVG differ, or nothing."""
    texts = [MADE_IDS.sub("id", re.sub(r"(?s)<metadata>.*?</metadata>", "", file.read_text())) for file in (drawn, kept)]
    words = [NUMBER.sub("#", text) for text in texts]
    if words[0] != words[1]:
        return "other things are drawn"
    largest = max((abs(float(a) - float(b)) for a, b in zip(*(NUMBER.findall(text) for text in texts))), default=0)
    return f"a number differs by {largest:g}" if largest > NEAR else ""


def flaw_of_pixels(drawn, kept):
    """Says how two PNG differ, or nothing."""
    import numpy as np
    from PIL import Image

    images = [np.asarray(Image.open(file).convert("RGB"), int) for file in (drawn, kept)]
    if images[0].shape != images[1].shape:
        return f"it has {images[0].shape[:2]} pixels, not {images[1].shape[:2]}"
    share = (np.abs(images[0] - images[1]).max(2) > FAINT).mean()
    return f"{share:.1%} of the pixels differ" if share > MOST_PIXELS else ""


def main(name, command, library, folder):
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        print("pictures: skipped: matplotlib is not installed: scripts/setup.sh --python does that", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    script, arguments, pictures = SCRIPTS[name]
    filled = [each.format(library=library, folder=folder) for each in arguments]
    ran = subprocess.run([sys.executable, "-B", ROOT / "scripts" / script, command, *filled], check=False)
    if ran.returncode != 0:
        return ran.returncode
    wrong = 0
    for picture in pictures:
        kept = ROOT / "docs/pictures" / picture
        flaw = (flaw_of_lines if kept.suffix == ".svg" else flaw_of_pixels)(folder / picture, kept)
        if flaw:
            wrong += 1
            print(f"{picture}: {flaw}: draw it again by scripts/{script}, and look at it", file=sys.stderr)
    drawn = sum(1 for file in folder.iterdir() if file.stat().st_size > 1000)
    print(f"{drawn} pictures, {len(pictures)} compared, {wrong} differ")
    return 1 if wrong or drawn < max(1, len(pictures)) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4], pathlib.Path(sys.argv[4]).resolve()))
