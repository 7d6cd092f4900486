#!/usr/bin/env python3
"""Draws the pictures of docs/how-it-works.md, and says the sentence below each of them, whose numbers are measured with it.

    scripts/draw_how.py PATH/TO/ist PATH/TO/libist_loop.so FOLDER             draws, and prints the sentences
    scripts/draw_how.py PATH/TO/ist PATH/TO/libist_loop.so FOLDER --check     draws, and fails if the page has another sentence

The command gives the data, with two exceptions: the Python package asks the library for the pair cache of a query, and the nodes of triangle clusters
follow from the library's rule. The script computes the steps of a query itself, and fails if the command's counts differ. It needs Debian's
python3-matplotlib, so run it with the system's python3.
"""
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/how-it-works.md"


def pictures(command, ist, folder):
    """Draws each picture; yields its name and its sentence."""
    from pictures.how import bounds, clusters, curves, search

    yield "octree", search.draw_octree(command, folder / "octree.png")
    yield "table", bounds.draw_table(command, folder / "table.svg")
    yield "bounds", bounds.draw_bounds(command, folder / "bounds.svg")
    yield "frontiers", search.draw_frontiers(command, folder / "frontiers.png")
    yield "pair_cache", curves.draw_pair_cache(command, folder / "pair_cache.svg", ist)
    yield "clusters", clusters.draw(command, folder / "clusters.png")
    yield "intervals", curves.draw_intervals(command, folder / "intervals.svg")


def main(ist, library, folder, *options):
    os.environ["IST_LIBRARY"] = str(pathlib.Path(library).resolve())
    sys.path.append(str(ROOT / "src/python"))
    import ist as package

    from pictures.drawing import Command

    missing = 0
    with tempfile.TemporaryDirectory() as name:
        command = Command(pathlib.Path(ist).resolve(), pathlib.Path(name))
        for picture, sentence in pictures(command, package, pathlib.Path(folder)):
            known = sentence in " ".join(PAGE.read_text().split())
            missing += not known
            if not known or "--check" not in options:
                print(f"{picture}: {sentence}", file=sys.stderr if "--check" in options else sys.stdout)
    if "--check" in options and missing:
        sys.exit(f"draw_how: {PAGE.name} lacks {missing} of these sentences: draw its pictures again, and write them there")


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5) or sys.argv[4:] not in ([], ["--check"]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
