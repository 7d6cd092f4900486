"""Tests distance_map.py: the figure against closed forms, the picture by its pixels, bad input by what is said of it."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import RECIPES, ball, block, motion, np, recipe, skip

try:
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb
    from matplotlib.image import imread
except ImportError:
    skip("/usr/bin/python3 has no matplotlib: scripts/setup.sh --python installs it")

import ist

SCRIPT = RECIPES / "distance_map.py"
# Runs the script as if a module were not installed.
WITHOUT = "import runpy, sys; sys.modules[sys.argv.pop(1)] = None; sys.argv.pop(0); runpy.run_path(sys.argv[0], run_name='__main__')"


class Figure(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recipe = recipe("distance_map.py")
        cls.ball, cls.block = map(ist.build, (ball(9.5), block()))
        # The block, turned by a quarter, is 0.25 lower: its top is at 4.75 of the ball's coordinates, 0.25 above the pole.
        cls.figure = cls.recipe.draw(cls.ball, cls.block, motion((0, 0, 1), 90, (0, 0, -0.25)), reach=2.0)
        cls.upper, cls.lower, cls.bar = cls.figure.axes

    def shown(self, axes):
        return next(each for each in axes.collections if isinstance(each, PolyCollection))

    def test_colours_are_the_mean_distances_of_triangles(self):
        heights = self.ball.vertices[self.ball.faces[self.recipe.facing(self.ball, 2, -1)[0]]][..., 2] - 4.75
        signed = np.where(heights <= 2, heights, np.nan).mean(axis=1)
        found = self.shown(self.upper).get_array()
        np.testing.assert_allclose(found.filled(np.nan), signed, atol=1e-12)
        self.assertLess(found.min(), 0)
        self.assertTrue(found.mask.any())

    def test_each_body_is_seen_from_the_other_one(self):
        faces, corners = self.recipe.facing(self.ball, 2, -1)
        inner = self.ball.vertices[self.ball.faces[faces]].mean(axis=1)
        self.assertTrue((inner[:, 2] < 9.5).all())
        self.assertTrue((np.diff(inner[:, 2]) <= 1e-12).all(), "the nearest is painted last")
        np.testing.assert_array_equal(corners[..., 0], -self.ball.vertices[self.ball.faces[faces]][..., 0])
        self.assertEqual(len(self.shown(self.lower).get_paths()), 2)  # the block's top

    def test_title_and_bar_name_the_unit(self):
        self.assertIn("mm", [text.get_text() for text in self.figure.texts][0])
        self.assertIn("mm", self.bar.get_ylabel())
        self.assertEqual(self.shown(self.upper).norm(0), 0.5)

    def test_the_picture_shows_the_deepest_and_the_bare_colour(self):
        with tempfile.TemporaryDirectory() as folder:
            self.figure.savefig(f"{folder}/map.png")
            picture = imread(f"{folder}/map.png")[..., :3]
        self.assertEqual(picture.shape, (550, 1100, 3))
        deepest = self.shown(self.upper)
        for colour in (deepest.cmap(deepest.norm(deepest.get_array().min()))[:3], to_rgb(self.recipe.BEYOND)):
            self.assertGreater((np.abs(picture - colour).max(axis=-1) < 0.01).sum(), 20, colour)


class Command(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.picture = self.folder / "map.png"

    def script(self, *arguments, without=None):
        start = [SCRIPT] if without is None else ["-c", WITHOUT, without, SCRIPT]
        return subprocess.run([sys.executable, "-B", *map(str, [*start, self.picture, *arguments])], capture_output=True, text=True, check=False)

    def file(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def test_the_built_in_jaws(self):
        ran = self.script("--move", "0,0,-0.6")
        self.assertEqual((ran.returncode, ran.stderr), (0, ""))
        self.assertEqual(imread(self.picture).shape[:2], (550, 1100))

    def test_bad_input(self):
        good = self.file("good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        points = self.file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")
        words = self.file("words.stl", "these are words, and no mesh")
        for arguments, without, said in (
            ((), "matplotlib", ["matplotlib", "apt-get install python3-matplotlib", "pip install matplotlib"]),
            ((good, points), None, ["points.obj", "no face"]),
            ((good, words), None, ["words.stl"]),
            ((good, self.folder / "absent.stl"), None, ["absent.stl"]),
            ((good,), None, ["name the upper and the lower jaw"]),
            ((good, good, "--move", "up"), None, ["up"]),
            ((good, good, "--reach", "-1"), None, ["reach"]),
        ):
            with self.subTest(arguments=arguments, without=without):
                ran = self.script(*arguments, without=without)
                self.assertIn(ran.returncode, (1, 2))
                for part in said:
                    self.assertIn(part, ran.stderr)
                self.assertNotIn("Traceback", ran.stderr)
                self.assertFalse(self.picture.exists())


if __name__ == "__main__":
    unittest.main()
