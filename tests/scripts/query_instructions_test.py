"""What scripts/query_instructions.py calls a change, and what it cannot compare."""

import contextlib
import copy
import io
import json
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
import query_instructions  # noqa: E402  after its folder is known

COUNTS = {
    "context": {"compiler": "GNU 12.2.0", "flags": "-O3"},
    "queries": [
        {"name": "collide", "instructions": 100000, "found": 7, "sphere_tests": 50},
        {"name": "gap", "instructions": 200000, "found": 1, "sphere_tests": 60},
    ],
}


def with_instructions(count):
    counts = copy.deepcopy(COUNTS)
    counts["queries"][0]["instructions"] = count
    return counts


class Check(unittest.TestCase):
    """The whole check, of made-up counts."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.baseline = pathlib.Path(folder.name) / "kept.json"
        self.baseline.write_text(json.dumps(COUNTS))
        self.said = io.StringIO()

    def check(self, counted, *rest, require_all="0"):
        made = {"side_effect": counted} if isinstance(counted, Exception) else {"return_value": counted}
        with mock.patch.object(query_instructions, "count", **made), \
                mock.patch.dict(os.environ, IST_REQUIRE_ALL=require_all), \
                contextlib.redirect_stdout(self.said), contextlib.redirect_stderr(self.said):
            return query_instructions.main("program", self.baseline, "--update" in rest)

    def test_same_counts_pass(self):
        self.assertEqual(self.check(COUNTS), 0)

    def test_within_one_percent_passes(self):
        for count in (99000, 101000):
            self.assertEqual(self.check(with_instructions(count)), 0)

    def test_beyond_one_percent_fails_and_says_what_changed_and_how_to_accept_it(self):
        for count, word in ((101001, "MORE"), (98999, "FEWER")):
            self.assertEqual(self.check(with_instructions(count)), 1)
            said = self.said.getvalue()
            for part in ("collide", "100000", str(count), word, f"{count / 100000:.4f}", "--update"):
                self.assertIn(part, said)

    def test_a_query_on_one_side_only_fails(self):
        fewer = copy.deepcopy(COUNTS)
        del fewer["queries"][1]
        self.assertEqual(self.check(fewer), 1)
        self.assertIn("gap", self.said.getvalue())
        self.baseline.write_text(json.dumps(fewer))
        self.assertEqual(self.check(COUNTS), 1)

    def test_another_answer_fails(self):
        other = copy.deepcopy(COUNTS)
        other["queries"][1]["sphere_tests"] = 61
        self.assertEqual(self.check(other), 1)
        self.assertIn("sphere_tests 60 -> 61", self.said.getvalue())

    def test_another_compiler_or_other_flags_are_not_compared(self):
        for key in ("compiler", "flags"):
            other = with_instructions(300000)
            other["context"][key] = "another"
            self.assertEqual(self.check(other), 77)
            self.assertEqual(self.check(other, require_all="1"), 1)
            self.assertIn(f"the {key} here: another", self.said.getvalue())

    def test_what_cannot_be_counted_is_skipped_and_what_fails_is_not(self):
        self.assertEqual(self.check(query_instructions.NotComparable("no AVX2")), 77)
        self.assertEqual(self.check(ValueError("failed")), 1)

    def test_update_keeps_the_new_counts(self):
        new = with_instructions(150000)
        self.assertEqual(self.check(new, "--update"), 0)
        self.assertEqual(json.loads(self.baseline.read_text()), new)
        self.assertEqual(self.check(new), 0)

    def test_without_counts_that_are_kept_there_is_nothing_to_compare(self):
        self.baseline.unlink()
        self.assertEqual(self.check(COUNTS), 77)


class Reading(unittest.TestCase):
    """What valgrind and the program leave."""

    PRINTED = "compiler: GNU 12.2.0\nflags: -O3 -DNDEBUG\ncollide/slab 3 40\n"

    def test_a_count_goes_to_the_query_that_its_file_names(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "out.1").write_text(
                "part: 1\ndesc: Trigger: Client Request: collide/slab\nsummary: 5000\n\ntotals: 5000\n")
            (pathlib.Path(folder) / "out.2").write_text("desc: Trigger: Program termination\ntotals: 9\n")
            counts = query_instructions.counts_in(folder)
        self.assertEqual(counts, {"collide/slab": 5000})
        made = query_instructions.join(self.PRINTED, counts)
        self.assertEqual(made["context"], {"compiler": "GNU 12.2.0", "flags": "-O3 -DNDEBUG"})
        self.assertEqual(made["queries"],
                         [{"name": "collide/slab", "instructions": 5000, "found": 3, "sphere_tests": 40}])

    def test_a_query_that_was_not_counted_is_an_error(self):
        for counts in ({}, {"collide/slab": 12}):
            with self.assertRaisesRegex(ValueError, "nothing was counted"):
                query_instructions.join(self.PRINTED, counts)


if __name__ == "__main__":
    unittest.main()
