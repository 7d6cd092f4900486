#!/usr/bin/env python3
"""Holds the areas of `ist occlusion` on a patch of a human jaw against a much finer surface with VTK's distances.

    areas_by_splitting.py IST FOLDER

    IST     the ist command
    FOLDER  for what is made on the way; is emptied first

The patch is cut out of the mandible into an STL of its own, so that its areas are asked for. The reference splits each
triangle that comes within 0.5 mm until no edge is over 0.02 mm (the command: 0.2 mm), takes VTK's signed distances at
all corners, and cuts each triangle where they reach a limit. A triangle whose distances cannot reach a limit is kept whole:
a distance changes by no more than one walks. Without the human jaws the exit code is 77; with IST_REQUIRE_ALL=1 it is 1.
"""
import sys

from oracles import Command, Surface, holds, human_jaws, np, read_stl, welded, write_stl

EDGE = 0.02
NEAR = 0.5
LIMITS = {"owens": (50, 350), "scan": (100,)}  # micrometres, by the preset that asks for them
PATCH = 2000  # triangles
LARGEST_ERROR = 0.01


def patch_of(corners, surface):
    """Returns the triangles nearest to that corner which is deepest in the other jaw."""
    points, triangles = welded(corners)
    close, _ = surface.nearest(points, 2)
    candidates = np.flatnonzero(np.isfinite(close))
    deepest = points[candidates[surface.signed(points[candidates]).argmin()]]
    away = np.linalg.norm(points[triangles].mean(1) - deepest, axis=1)
    return corners[np.argsort(away, kind="stable")[:PATCH]]


def area_of(corners):
    a, b, c = corners.transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def area_below(corners, distances, level):
    """Returns the area where the distance, linear on each triangle, is at most the level."""
    order = np.sort(distances, axis=1)
    low, middle, high = order.T
    with np.errstate(invalid="ignore", divide="ignore"):
        one = (level - low) ** 2 / ((middle - low) * (high - low))
        two = 1 - (high - level) ** 2 / ((high - low) * (high - middle))
    part = np.select([level >= high, level < low, level < middle], [1, 0, one], two)
    return (part * area_of(corners)).sum()


class Splitting:
    """Areas of each limit, mm², by splitting; and how many points were measured."""

    def __init__(self, corners, surface, limits):
        self.surface, self.limits = surface, np.array(limits)
        self.areas, self.measured, self.finest = np.zeros(len(limits)), 0, 0
        corners = corners.astype("f8")
        while len(corners):
            corners = self.step(corners)

    def step(self, corners):
        points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
        distances = self.surface.signed(points)[index].reshape(-1, 3)
        self.measured += len(points)
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        longest = edges.max(1)
        reached = ((distances.min(1)[:, None] - longest[:, None] <= self.limits)
                   & (distances.max(1)[:, None] + longest[:, None] >= self.limits)).any(1)
        split = (longest > EDGE) & (distances.min(1) - longest <= NEAR) & reached
        done = ~split
        self.finest += (done & (longest <= EDGE)).sum()
        for i, limit in enumerate(self.limits):
            self.areas[i] += area_below(corners[done], distances[done], limit)
        # Across the middle of the longest edge: neighbours may split otherwise, which moves no point of the surface.
        turned = np.take_along_axis(corners[split], ((edges[split].argmax(1)[:, None] + np.arange(3)) % 3)[:, :, None], axis=1)
        a, b, c = turned.transpose(1, 0, 2)
        middle = (a + b) / 2
        return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def main(ist, folder):
    command = Command(ist, folder)
    maxilla, mandible = human_jaws()
    surface = Surface(*welded(read_stl(maxilla)))
    patch = patch_of(read_stl(mandible), surface)
    file = command.folder / "patch.stl"
    write_stl(file, patch)
    limits = sorted(limit for of_preset in LIMITS.values() for limit in of_preset)
    reference = Splitting(patch, surface, [limit / 1000 for limit in limits])
    print(f"{len(patch)} triangles of {area_of(patch).sum():.1f} mm², split into {reference.finest} of edges up to {EDGE} mm; "
          f"{reference.measured} distances by VTK")
    found = {}
    for preset, of_preset in LIMITS.items():
        measures = command.measures(maxilla, file, "--preset", preset)
        holds("patch: area and the command's differ by, mm²", abs(measures["moving"]["total_area"] - area_of(patch).sum()), 1e-4)
        found.update({one["micrometres"]: one["area"] for one in measures["moving"]["areas"]})
    for limit, truth in zip(limits, reference.areas):
        assert truth > 1, f"the patch has hardly an area within {limit} µm"
        print(f"within {limit} µm: {found[limit]:.5f} mm², by splitting {truth:.5f}")
        holds(f"within {limit} µm: part by which they differ", abs(found[limit] - truth) / truth, LARGEST_ERROR)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
