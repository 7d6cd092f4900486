"""Sweeps of two boxes, and their poses by numpy's own Philox, for the tests of sweeps from Python."""

import pathlib
import tempfile

import numpy as np
from support import Refusals, box

import ist

ANSWERS = ("intersects", "leaf_pairs", "distance", "contacts", "penetration")
BODIES = '[fixed]\ntree = "upper.ist"\n[moving]\ntree = "lower.ist"\n'
BOX = """[poses.box]
seed = {seed}
count = {count}
from = [-1.5, -1, -3.25]
to = [1, 1.75, 0.1]
"""
ABOUT = np.array([3.0, -20.0, 7.5])
GRID = """[[poses.axes]]
turn = [1, 2, -2]
about = [3, -20, 7.5]
from = -4
to = 3
count = 3
[[poses.axes]]
move = [0, 0, 1]
from = -3
to = 0.3
count = 4
[[poses.axes]]
move = [0, -2, 0]
from = 0
to = 1
count = 2
"""


def box_poses(seed, count):
    return BOX.format(seed=seed, count=count)


class Moved:
    """The oracle: pose i of a box, by numpy's generator."""

    def __init__(self, seed, index):
        self.random = np.random.Generator(np.random.Philox(key=seed, counter=[0, index, 0, 0])).random
        low, high = np.array([-1.5, -1, -3.25]), np.array([1, 1.75, 0.1])
        self.move = low + np.array([self.random() for _ in range(3)]) * (high - low)

    def pose(self, quaternion=(1, 0, 0, 0)):
        w, *v = np.array(quaternion) / np.linalg.norm(quaternion)
        x, y, z = v
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        pose = np.eye(4)
        pose[:3, :3] = np.eye(3) + 2 * w * cross + 2 * cross @ cross
        pose[:3, 3] = ABOUT - pose[:3, :3] @ ABOUT + self.move
        return pose

    def within(self, degrees):
        w = (2 * np.array([self.random() for _ in range(3)]) - 1) * np.radians(degrees)
        return self.pose([1, *(w / 2)])

    def disc(self):
        while True:
            x, y = 2 * self.random() - 1, 2 * self.random() - 1
            if 0 < x * x + y * y < 1:
                return x, y, x * x + y * y

    def any(self):
        (x, y, s), (z, w, t) = self.disc(), self.disc()
        return self.pose([x, y, z * np.sqrt((1 - s) / t), w * np.sqrt((1 - s) / t)])


class Sweeps(Refusals):
    """Two boxes, one with a roof, as trees in a folder."""

    @classmethod
    def setUpClass(cls):
        made = tempfile.TemporaryDirectory()
        cls.addClassCleanup(made.cleanup)
        cls.place = pathlib.Path(made.name)
        cls.upper = ist.build(box([-2, -2, 0], [2, 2, 1.5]), 0.25)
        cls.lower = ist.build(box([-1, -1.5, -2], [1.2, 1, 0]), 0.25)
        cls.upper.save(cls.place / "upper.ist")
        cls.lower.save(cls.place / "lower.ist")
        cls.jobs = 0

    def job(self, poses, answers=("intersects",), settings="rows_per_part = 10", bodies=BODIES):
        """A sweep of a file, and of a folder, that no other test uses."""
        type(self).jobs += 1
        file = self.place / f"{self.jobs}.toml"
        file.write_text(f"answers = {list(answers)}\n{settings}\n{bodies}{poses}")
        return ist.Sweep(file)
