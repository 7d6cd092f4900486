"""What scripts/try.py calls slower, and what makes it fail."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TRY = pathlib.Path(__file__).parents[2] / "scripts/try.py"
HEAD = {"slab": [10, 11, 12, 11], "tight": [20, 21, 22, 21]}


class Try(unittest.TestCase):
    """The comparison as the script calls it, of made-up runs of `ist bench --json`."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, side, times, listed=100):
        """`times` by spheres, one a run, below the line on the machine that each run begins with."""
        for run in range(max(map(len, times.values()))):
            lines = [{"version": "0.0"}, *({"question": "leaf pairs", "way": "fast", "spheres": spheres, "workers": 1,
                                            "microseconds_median": of[run], "listed": listed} for spheres, of in times.items())]
            (self.folder / f"{side}-{run + 1}.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))

    def compare(self, tree, **more):
        self.write("head", HEAD)
        self.write("tree", tree, **more)
        return self.ran()

    def ran(self):
        done = subprocess.run([sys.executable, str(TRY), str(self.folder)], capture_output=True, text=True, check=False)
        self.said = done.stdout + done.stderr
        return done.returncode

    def row(self, spheres):
        return next(line for line in self.said.splitlines() if f", {spheres} " in line)

    def test_slower_where_every_run_is_beyond_those_of_the_other_side(self):
        self.assertEqual(self.compare({**HEAD, "slab": [12.1, 13, 14, 13]}), 1)
        for part in ("11 us", "13 us", "1.182", "SLOWER"):
            self.assertIn(part, self.row("slab"))
        self.assertNotIn("SLOWER", self.row("tight"))

    def test_faster_is_named_and_passes(self):
        self.assertEqual(self.compare({**HEAD, "slab": [5, 6, 7, 9.9]}), 0)
        self.assertIn("faster", self.row("slab"))

    def test_runs_that_overlap_decide_nothing(self):
        self.assertEqual(self.compare({**HEAD, "slab": [11.9, 30, 30, 30], "tight": [10, 10, 10, 20.1]}), 0)
        self.assertNotIn("SLOWER", self.said)
        self.assertNotIn("faster", self.said)

    def test_a_difference_below_3_percent_decides_nothing(self):
        self.write("head", {"slab": [10, 10, 10, 10], "tight": [10, 10, 10, 10]})
        self.write("tree", {"slab": [10.2, 10.2, 10.2, 10.2], "tight": [9.8, 9.8, 9.8, 9.8]})
        self.assertEqual(self.ran(), 0)
        self.assertNotIn("SLOWER", self.said)
        self.assertNotIn("faster", self.said)

    def test_another_answer_fails(self):
        self.assertEqual(self.compare(HEAD, listed=99), 1)
        self.assertIn("another answer: leaf pairs, fast, slab: ['100'] pairs, now ['99']", self.said)

    def test_a_row_that_is_gone_fails(self):
        self.assertEqual(self.compare({"slab": HEAD["slab"]}), 1)
        self.assertIn("only in HEAD, not compared: leaf pairs, fast, tight", self.said)

    def test_a_row_that_is_new_is_named_and_passes(self):
        self.assertEqual(self.compare({**HEAD, "table": [1, 1, 1, 1]}), 0)
        self.assertIn("only in tree, not compared: leaf pairs, fast, table", self.said)

    def test_nothing_to_compare_is_an_error(self):
        self.assertEqual(self.ran(), 2)
        self.assertEqual(self.compare({"table": [1]}), 2)
        self.assertIn("nothing is on both sides", self.said)


if __name__ == "__main__":
    unittest.main()
