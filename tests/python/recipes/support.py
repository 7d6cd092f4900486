"""What tests of recipes share: shapes with known distances, rigid motions, and the recipes as modules."""

import importlib.util
import os
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]
RECIPES = SOURCE / "examples/python"


def skip(reason):
    """Ends a test program as skipped; as failed with IST_REQUIRE_ALL=1."""
    print(f"skipped: {reason}", file=sys.stderr)
    sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)


try:
    import numpy as np
except ImportError:
    skip("/usr/bin/python3 has no numpy: scripts/setup.sh --oracles --python installs it")


def recipe(path):
    """A recipe as a module that nobody has loaded before."""
    spec = importlib.util.spec_from_file_location(pathlib.Path(path).stem, RECIPES / path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def block():
    """A box of 40 x 40 x 10 about the origin, its faces outward: vertices and faces."""
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return signs * (20, 20, 5), np.array(faces, np.uint32)


def ball(height, radius=5.0, rings=24, parts=48):
    """A ball about (0, 0, height) whose poles are vertices, its faces outward. The lowest vertex is the first."""
    down = np.pi * np.arange(1, rings) / rings
    round_ = 2 * np.pi * np.arange(parts) / parts
    ring = np.stack([np.outer(np.sin(down), np.cos(round_)), np.outer(np.sin(down), np.sin(round_)),
                     np.outer(-np.cos(down), np.ones(parts))], axis=-1).reshape(-1, 3)
    vertices = radius * np.vstack([(0, 0, -1), ring, (0, 0, 1)]) + (0, 0, height)
    here = np.arange(parts)
    there = (here + 1) % parts
    top = len(vertices) - 1
    faces = [np.stack([np.zeros(parts, int), 1 + there, 1 + here], axis=1)]
    for i in range(rings - 2):
        low, high = 1 + i * parts, 1 + (i + 1) * parts
        faces += [np.stack([low + here, low + there, high + there], axis=1), np.stack([low + here, high + there, high + here], axis=1)]
    last = 1 + (rings - 2) * parts
    faces.append(np.stack([last + here, last + there, np.full(parts, top)], axis=1))
    return vertices, np.vstack(faces).astype(np.uint32)


def motion(axis, degrees, translation):
    """A turn about an axis through the origin, then a translation: (4, 4), row by row."""
    x, y, z = np.array(axis, float) / np.linalg.norm(axis)
    cross = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    matrix[:3, 3] = translation
    return matrix


def moved(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]
