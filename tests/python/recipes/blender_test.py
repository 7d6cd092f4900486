"""Tests the logic of the add-on for Blender, without Blender: blender_itself.py runs the add-on in it."""

import ast
import sys
import unittest
from unittest import mock

from support import RECIPES, ball, block, motion, np, recipe

ADD_ON = "blender/ist_distance_colours.py"


class Logic(unittest.TestCase):
    def setUp(self):
        self.add_on = recipe(ADD_ON)

    def test_meshes_are_measured_where_they_stand(self):
        place = motion((1, 2, 3), 40, (10, -20, 30))
        scale = np.diag([2.0, 2.0, 2.0, 1.0])  # the block's top is at 10
        surface = self.add_on.placed(*block(), place @ scale)
        points, _ = self.add_on.placed(*ball(14.6), place)
        heights = ball(14.6)[0][:, 2] - 10
        np.testing.assert_allclose(self.add_on.distances(points, *surface, 2.0), np.where(heights <= 2, heights, np.nan), atol=1e-9)

    def test_a_mirror_leaves_the_inside_inside(self):
        vertices, faces = block()
        open_block = vertices, faces[1:]  # of an open surface nobody can tell that it is inside out
        mirror = np.diag([-1.0, 1.0, 1.0, 1.0])
        inside = np.array([[3.0, 2.0, -4.5]])
        self.assertAlmostEqual(self.add_on.distances(inside, *self.add_on.placed(*open_block, mirror), 2.0)[0], -0.5)

    def test_colours(self):
        found = self.add_on.colours(np.array([-9, -2, -1, 0, 1, 2, np.nan]), 2.0)
        inside, surface, far, beyond = self.add_on.INSIDE, self.add_on.SURFACE, self.add_on.FAR, self.add_on.BEYOND
        np.testing.assert_allclose(found, [inside, inside, (inside + surface) / 2, surface, (surface + far) / 2, far, beyond])

    def test_bad_input(self):
        with self.assertRaisesRegex(ValueError, "the active mesh has no faces"):
            self.add_on.distances(np.zeros((1, 3)), block()[0], np.empty((0, 3), np.int32), 2.0)
        with self.assertRaises(ValueError):
            self.add_on.distances(np.zeros((1, 3)), *block(), reach=-1.0)
        with mock.patch.dict(sys.modules, {"ist": None}), self.assertRaisesRegex(ImportError, "install its wheel"):
            recipe(ADD_ON)

    def test_blender_reads_its_info_without_running_it(self):
        tree = ast.parse((RECIPES / ADD_ON).read_text())
        info = next(each.value for each in tree.body if isinstance(each, ast.Assign) and each.targets[0].id == "bl_info")
        self.assertLessEqual({"name", "blender", "category"}, set(ast.literal_eval(info)))


if __name__ == "__main__":
    unittest.main()
