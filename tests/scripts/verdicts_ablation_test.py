"""Verdicts on the parts of the query and on the table of the closing: wins, losses, and the reason of each."""

import unittest

from made_results import results  # first: it knows the folder of the report
from report import ablation, closing

LADDER = ("1-pointers_simple", "2-pointers_table", "3-linear_simple", "3-linear_table", "4-batches", "5-tight", "6-slab", "7-avx2", "8-second_worker")
WITHOUT = ("0-full", "1-second_worker", "2-simd", "4-slab")


def steps(kind, times, tests=None):
    """Runs at every pose of the size 0.2: times in µs by step, and tests where they are not 1000; each lists its time in leaf pairs."""
    tests = tests or {}
    return {f"ablation/{kind}/{step}/0.2/{dz}/iterations:1/manual_time":
            {"p50_us": us, "tests": tests.get(step, 1000), "contacts": us, "bytes": 1e6, "n": 9, "label": "human"}
            for step, us in times.items() for dz in closing.POSES}


def variants(kind, times, tests=None):
    return ablation.Variants(results("ablation_bench", steps(kind, times, tests)), kind, "0.2")


class Ladder(unittest.TestCase):
    FASTER = dict(zip(LADDER, (900, 800, 850, 700, 600, 500, 400, 300, 200)))

    def test_steps_that_all_gain(self):
        said = ablation.verdict(variants("ladder", self.FASTER), "0.0")
        self.assertIn("`slab` with all steps, two workers, is 4.50 times as fast as `simple` on pointers; they list 200 and 900 leaf pairs.", said)
        self.assertIn("No step loses.", said)

    def test_a_step_that_loses_is_bold_with_its_reason(self):
        slower = self.FASTER | {"6-slab": 600}
        said = ablation.verdict(variants("ladder", slower, {"6-slab": 800}), "0.0")
        self.assertIn("**These lose**: slabs (**0.83**; 20 % fewer tests, at 1.50 times the time of a test: "
                      "a test reads and compares two slabs", said)
        self.assertNotIn("No step loses.", said)

    def test_a_loss_without_a_known_reason_says_so(self):
        said = ablation.verdict(variants("ladder", self.FASTER | {"7-avx2": 500}), "0.0")
        self.assertIn("SIMD: AVX2 (**0.80**; as many tests, at 1.25 times the time of a test: not explained)", said)

    def test_the_whole_may_lose(self):
        self.assertIn("is **0.90** times as fast", ablation.verdict(variants("ladder", self.FASTER | {"8-second_worker": 1000}), "0.0"))

    def test_the_layout_has_a_reason_only_where_it_loses(self):
        self.assertNotIn("Where it loses", ablation.layout_text(variants("ladder", self.FASTER)))
        said = ablation.layout_text(variants("ladder", self.FASTER | {"3-linear_table": 1000}))
        self.assertIn("a factor of **0.80** at dz = 0.0", said)
        self.assertIn("Where it loses, a visit computes", said)


class Without(unittest.TestCase):
    SLOWER = dict(zip(WITHOUT, (100, 120, 900, 110)))

    def test_no_part_is_better_left_out(self):
        self.assertEqual(ablation.without_verdict(variants("without", self.SLOWER), "0.2"), "At 0.2 mm no part is better left out.")

    def test_a_part_that_is_names_why(self):
        said = ablation.without_verdict(variants("without", self.SLOWER | {"4-slab": 80}, {"4-slab": 1250}), "0.2")
        self.assertIn("**the query is faster without** slabs at dz = 0.0 (**0.80** times as long; with it "
                      "20 % fewer tests, at 1.56 times the time", said)


def both(published=1000, fast=100, two=60):
    """The same spheres on both sides, and the whole."""
    times = {f"published-{policy}": published for policy in ablation.POLICIES} | {f"fast-{policy}": fast for policy in ablation.POLICIES}
    return steps("same", times) | steps("without", {"0-full": two})


class Same(unittest.TestCase):
    def said(self, **times):
        return "\n".join(ablation.same_table(ablation.Variants(results("ablation_bench", both(**times)), "same", "0.2")))

    def test_a_faster_query_has_no_loss(self):
        self.assertIn("| 10 |", self.said())
        self.assertNotIn("**", self.said())

    def test_a_slower_one_is_bold(self):
        self.assertIn("| **0.50** |", self.said(fast=2000))
        self.assertIn("**Slower than the published query**: `simple` against `simple` at dz = 0.0,", self.said(fast=2000))


class Closing(unittest.TestCase):
    def said(self, **times):
        rows, verdict = closing.compare(results("ablation_bench", both(**times)))
        return "\n".join("|".join(row) for row in rows), verdict

    def test_where_all_is_faster_nothing_is_bold(self):
        table, verdict = self.said()
        self.assertNotIn("**", table + verdict)
        self.assertEqual(verdict, "No cell is slower than the published query by 3 % or more. "
                                  "Two workers are nowhere slower than one by 3 % or more.")

    def test_two_workers_that_are_slower_are_bold_with_both_times(self):
        table, verdict = self.said(two=130)
        self.assertEqual(table.count("**7.7**"), len(closing.POSES))
        self.assertNotIn("**10.0**", table)
        self.assertIn("**Two workers are slower than one** at closed, dz = 0 (130 against 100 µs),", verdict)
        self.assertIn("not explained", verdict)

    def test_a_cell_that_is_slower_than_published_is_bold(self):
        table, verdict = self.said(fast=2000, two=1900)
        self.assertIn("**0.5**", table)
        self.assertIn("**Slower than the published query**: `table` against `table`, closed, dz = 0 (**0.50**)", verdict)


if __name__ == "__main__":
    unittest.main()
