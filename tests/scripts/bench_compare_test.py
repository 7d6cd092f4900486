"""What scripts/bench_compare.py calls slower, and what scripts/bench_compare.sh does not begin with."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).parents[2] / "scripts"


class Compare(unittest.TestCase):
    """The comparison as the script calls it, of made-up runs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, side, times, unit="us", **more):
        """`times` by name, one a run."""
        for run in range(max(map(len, times.values()))):
            rows = [{"name": name, "real_time": of[run], "cpu_time": of[run], "time_unit": unit, **more}
                    for name, of in times.items() if run < len(of)]
            (self.folder / f"{side}-{run + 1}-some_bench.json").write_text(json.dumps({"benchmarks": rows}))

    def compare(self):
        ran = subprocess.run([sys.executable, str(SCRIPTS / "bench_compare.py"), str(self.folder)],
                             capture_output=True, text=True, check=False)
        self.said = ran.stdout + ran.stderr
        return ran.returncode

    def row(self, name):
        return next(line for line in self.said.splitlines() if line.startswith(name))

    def test_slower_where_the_best_new_run_is_worse_than_the_worst_old_one(self):
        self.write("base", {"query": [10, 11, 12], "build": [10, 11, 12]})
        self.write("head", {"query": [12.1, 13, 14], "build": [11, 11, 11]})
        self.assertEqual(self.compare(), 1)
        self.assertIn("1 slower: query", self.said)
        row = self.row("query")
        for part in ("11 us", "13 us", "1.182", "1.008", "SLOWER"):
            self.assertIn(part, row)
        self.assertNotIn("SLOWER", self.row("build"))

    def test_one_run_that_overlaps_is_no_regression(self):
        self.write("base", {"query": [10, 10, 20]})
        self.write("head", {"query": [20, 30, 30]})
        self.assertEqual(self.compare(), 0)
        self.assertIn("nothing is slower", self.said)

    def test_faster_is_said_and_passes(self):
        self.write("base", {"query": [10, 11, 12]})
        self.write("head", {"query": [5, 6, 9.9]})
        self.assertEqual(self.compare(), 0)
        self.assertIn("faster", self.row("query"))

    def test_time_is_taken_by_the_clock_that_the_benchmark_chose(self):
        for name, of_wall in (("query", False), ("query/real_time", True), ("query/1/manual_time", True)):
            for clock, code in (("real_time", 1 if of_wall else 0), ("cpu_time", 0 if of_wall else 1)):
                self.write("base", {name: [10, 10, 10]})
                self.write("head", {name: [10, 10, 10]}, **{clock: 99})
                self.assertEqual(self.compare(), code, (name, clock))

    def test_units_may_differ(self):
        self.write("base", {"query": [10, 11, 12]}, unit="us")
        self.write("head", {"query": [0.013, 0.014, 0.015]}, unit="ms")
        self.assertEqual(self.compare(), 1)

    def test_what_is_on_one_side_only_is_named_and_not_compared(self):
        self.write("base", {"query": [10, 10], "gone": [1, 1]})
        self.write("head", {"query": [10, 10], "new": [99, 99]})
        self.assertEqual(self.compare(), 0)
        self.assertIn("only in base, not compared: gone", self.said)
        self.assertIn("only in head, not compared: new", self.said)

    def test_nothing_in_common_is_an_error(self):
        self.write("base", {"gone": [1, 1]})
        self.write("head", {"new": [1, 1]})
        self.assertEqual(self.compare(), 2)
        self.assertIn("nothing is on both sides", self.said)

    def test_no_runs_are_an_error(self):
        self.assertEqual(self.compare(), 2)

    def test_a_benchmark_that_failed_is_an_error(self):
        self.write("base", {"query": [10, 10]})
        self.write("head", {"query": [10, 10]}, error_occurred=True, error_message="differs from its twin")
        self.assertEqual(self.compare(), 2)
        self.assertIn("differs from its twin", self.said)

    def test_a_run_that_lacks_a_benchmark_is_an_error(self):
        self.write("base", {"query": [10, 10], "build": [10]})
        self.write("head", {"query": [10, 10], "build": [10, 10]})
        self.assertEqual(self.compare(), 2)
        self.assertIn("build is in 1 of 2 runs", self.said)

    def test_a_file_that_is_cut_off_is_an_error(self):
        self.write("base", {"query": [10, 10]})
        self.write("head", {"query": [10, 10]})
        (self.folder / "head-1-some_bench.json").write_text('{"benchmarks": [')
        self.assertEqual(self.compare(), 2)


class Usage(unittest.TestCase):
    """Of the script: what ends it before anything is built."""

    def refused(self, *arguments, says):
        ran = subprocess.run([str(SCRIPTS / "bench_compare.sh"), *arguments], capture_output=True, text=True,
                             check=False, timeout=300)
        self.assertEqual(ran.returncode, 2, ran.stderr)
        self.assertIn(says, ran.stderr)

    def test_two_commits_are_needed(self):
        self.refused(says="needs two commits")
        self.refused("HEAD", says="needs two commits")
        self.refused("HEAD", "HEAD", "HEAD", says="needs two commits")

    def test_a_commit_must_be_one(self):
        for name in ("no-such-branch", "HEAD; true", "$(true)", ""):
            self.refused(name, "HEAD", says=f"'{name}' is no commit")

    def test_options_are_known_and_have_values(self):
        self.refused("HEAD", "HEAD", "--fast", says="unknown option --fast")
        self.refused("HEAD", "HEAD", "--runs", says="--runs needs a value")
        for runs in ("0", "2", "-7", "many", "7x"):
            self.refused("HEAD", "HEAD", "--runs", runs, says="--runs is from 3")


if __name__ == "__main__":
    unittest.main()
