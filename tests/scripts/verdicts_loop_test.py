"""Verdicts on the loop's latency: missed deadlines and late begins, with a reason that the numbers choose."""

import unittest

from made_results import NoPictures, results  # first: it knows the folder of the report
from report import loop


def tick(late=1, missed=0, longest=500, processor=400):
    """A run whose ticks begin `late` µs late and take at most `longest` µs, of which its thread has the processor for `processor`."""
    times = {f"{what}_{q}_us": us for what, us in (("late", late), ("execution", longest), ("cpu", processor)) for q in loop.QUANTILES}
    upto = {f"{what}_upto_{us}us": 50.0 for what in ("late", "execution") for us in (1, 100)}
    upto |= {"late_upto_2000us": 98.0 if late > 2000 else 100.0, "execution_upto_2000us": 99.0 if longest > 2000 else 100.0}
    return {**times, **upto, "late_count": 100, "execution_count": 100, "missed": missed, "ticks": 100, "held": 0, "denied": 0, "label": "human",
            "period_us": 2000, "voxel_size": 0.2, "neighbour_MB": 64, "awake_us": 100}


def text(**special):
    """The chapter, where only what is named, as loop_1_idle, is not an ordinary run."""
    runs = {}
    for kind in loop.KINDS:
        for at in loop.CONDITIONS:
            runs["/".join((*kind, at)) + "/iterations:1"] = special.get("_".join((*kind, at)), tick())
    return "\n".join(loop.chapter(results("loop_bench", runs), NoPictures()))


class Missed(unittest.TestCase):
    def test_no_deadline_missed_is_said_plainly(self):
        self.assertIn("\nThe loop missed no deadline.", text())

    def test_ticks_that_began_late_are_counted(self):
        said = text(loop_2_idle=tick(missed=3, late=5000), loop_2_noisy=tick(late=5000), bare_clock_idle=tick(missed=7))
        self.assertIn("**Deadlines were missed**: the loop, 2 workers, idle, 3 beside 100 ticks (no tick took as long as the period, 500 µs at most; "
                      "2 began over 2,000 µs late, by up to 5,000 µs", said)
        self.assertIn("the empty loop by the same clock missed 7", said)
        self.assertNotIn("not explained", said)

    def test_a_long_tick_was_off_its_core_or_is_not_explained(self):
        self.assertIn("1 took over 2,000 µs; the longest took 2,500 µs, and its thread had the processor for 400 µs at most: it was off its core; "
                      "none began over 2,000 µs late", text(loop_1_noisy=tick(missed=1, longest=2500)))
        self.assertIn("its thread had the processor for 2,400 µs at most: not explained",
                      text(loop_1_noisy=tick(missed=1, longest=2500, processor=2400)))
        said = text(loop_1_noisy=tick(missed=4, late=5000, longest=2500, processor=2510), bare_clock_noisy=tick(missed=5))
        self.assertIn("the longest took 2,500 µs, and its thread had the processor all that time: not explained; "
                      "2 began over 2,000 µs late, by up to 5,000 µs", said)
        self.assertIn("the empty loop by the same clock missed 5", said)

    def test_an_empty_loop_that_misses_is_no_loss_of_the_loop(self):
        self.assertIn("The loop missed no deadline.", text(bare_plain_idle=tick(missed=9)))


class Late(unittest.TestCase):
    def test_nothing_is_said_where_idle_is_no_later(self):
        self.assertNotIn("later idle", text(loop_1_noisy=tick(late=9)))

    def test_the_machine_is_a_cause_only_where_an_empty_loop_is_later_too(self):
        self.assertIn("**At p99 these begin later idle than beside the neighbour**: the loop, 1 worker. No empty loop is among them: not explained.",
                      text(loop_1_idle=tick(late=9)))
        self.assertIn("nothing, by the loop's clock. An empty loop is among them, so the machine is a cause", text(bare_clock_idle=tick(late=9)))


class Period(unittest.TestCase):
    def test_it_is_the_programs(self):
        self.assertIn("every 2,000 µs", text())


if __name__ == "__main__":
    unittest.main()
