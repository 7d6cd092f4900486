"""A tree as the command exports it: nodes by level, whose children they are, and the bounds that a query tests."""
import struct

import numpy as np

from pictures.how.command import VOXEL_SIZE

VERSION = 4  # of tree files, whose layout src/ist/tree/tree_file.cpp describes
SECTIONS = 1 | 2 | 8  # balls, triangles, slabs
# By how much the table's balls are larger in a query, in voxels, at level 1 and above it, by 36 times the square of the
# radius in half edges: docs/guarantees.md, Nested bounds, derives it.
EXCESS = {27: (0, 0), 54: (0.1413, 0.0749), 81: (0.0732, 0.0455), 96: (0.0991, 0.0665), 108: (0, 0)}


class Bounds:
    """The bounds of one level: balls, and slabs where the policy has them."""

    def __init__(self, spheres, slabs=None):
        self.centre, self.radius = spheres[:, :3], spheres[:, 3]
        self.normal, self.offset, self.half = slabs if slabs is not None else (None, None, None)


class Octree:
    """The levels of a tree file, the leaves first."""

    def __init__(self, command, file):
        self.command, self.file = command, file
        self.depth, self.counts, self.slabs = read_tree(file)
        self.cubes = [command.spheres(file, "simple", level) for level in range(self.depth + 1)]
        corner = self.cubes[-1][0, :3] - VOXEL_SIZE * 2 ** (self.depth - 1)
        self.children = [None]  # of each node at a level: the first child's index, and how many there are
        for level in range(1, self.depth + 1):
            cells = [np.floor((self.cubes[at][:, :3] - corner) / (VOXEL_SIZE * 2**at)).astype(int) for at in (level - 1, level)]
            new = np.any(np.diff(cells[0] // 2, axis=0) != 0, axis=1)  # siblings follow each other
            first = np.concatenate([[0], 1 + np.flatnonzero(new)])
            if len(first) != len(cells[1]) or (cells[0][first] // 2 != cells[1]).any():
                raise SystemExit(f"{file}: the children of level {level} are not in the order of their parents")
            self.children.append((first, np.diff(np.append(first, len(cells[0])))))

        half = VOXEL_SIZE * 2 ** (self.depth - 1)
        self.bounding_radius = (12**0.5 + 96**0.5) / 6 * half + EXCESS[96][1] * VOXEL_SIZE  # of any policy's: guarantees.md
        self.made = {}

    def bounds(self, policy, level):
        """Returns the bounds of a level, which are made once."""
        if (policy, level) not in self.made:
            self.made[policy, level] = self.make(policy, level)
        return self.made[policy, level]

    def make(self, policy, level):
        if policy == "simple":
            return Bounds(self.cubes[level])
        spheres = self.command.spheres(self.file, policy, level)
        if policy == "table" and level > 0:
            half = VOXEL_SIZE * 2 ** (level - 1)
            squares = np.rint(36 * (spheres[:, 3] / half) ** 2).astype(int)
            spheres[:, 3] += VOXEL_SIZE * np.array([EXCESS[square][min(level, 2) - 1] for square in squares])
        return Bounds(spheres, self.slabs[level] if policy == "slab" else None)


def read_tree(file):
    """Returns a tree file's depth, its nodes a level, and its slabs a level: normals, offsets, half widths, mesh units."""
    data = file.read_bytes()
    version, = struct.unpack_from("<I", data, 8)
    size, _, depth, _, sections, _, _, name = struct.unpack_from("<dIIIIQII", data, 32 + 24)
    if version != VERSION or sections & SECTIONS != SECTIONS:
        raise SystemExit(f"{file}: no tree file of version {VERSION} with balls, slabs and triangles")
    at = 32 + 64 + name
    *above, leaves = struct.unpack_from(f"<{depth + 1}I", data, at)
    counts = [leaves, *above]
    at += 4 * len(counts) + sum(above) + 4 * leaves + 8 * sum(counts)
    rows = np.frombuffer(data, np.dtype([("normal", "i1", 3), ("offset", "i1"), ("half", "u1")]), sum(counts), at)
    slabs = []
    for level, part in enumerate(np.split(rows, np.cumsum(counts)[:-1])):
        unit = size * 2**level / 256
        slabs.append((part["normal"] / 128, part["offset"] * unit, part["half"] * unit))
    return depth, counts, slabs
