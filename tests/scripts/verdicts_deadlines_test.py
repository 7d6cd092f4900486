"""Verdicts on deadlines: each can say no, and what does not count is shown."""

import unittest

from made_results import results  # first: it knows the folder of the report
from report import deadlines


def row(over=2, loop=1, over_away=10, loop_away=10, n=1000, complete=0.0, pairs=0):
    """A run whose query exceeds its deadline by `over` µs in every quantile, and whose loop does by `loop`."""
    times = {f"{what}_{q}_us": us for what, us in (("over", over), ("loop", loop)) for q in deadlines.QUANTILES}
    return {**times, "over_away": over_away, "loop_away": loop_away, "n": n, "complete": complete, "most_pairs": pairs, "away_us": 3}


def text(**runs):
    whole = {"unbudgeted/inside/iterations:20": {"p50_us": 1, "tests": 9, "pairs": 0}}
    named = {name.replace("__", "/") + "/iterations:1000": run for name, run in runs.items()}
    return "\n".join(deadlines.chapter(results("deadline_bench", named | whole), None))


class Tails(unittest.TestCase):
    def test_a_query_like_its_loop_has_the_machines_tail(self):
        self.assertIn("in 1 of 1 rows no quantile", text(within_100us__contacts__inside=row()))
        self.assertIn("No row exceeds it.", text(within_100us__contacts__inside=row()))

    def test_one_beyond_it_is_bold_with_what_is_known_of_the_reason(self):
        said = text(within_100us__leaf_pairs__inside=row(over=100))
        self.assertIn("in 0 of 1 rows", said)
        self.assertIn("**These exceed it**: leaf pairs of sphere inside a sphere within 100 µs (p99, p99.9, p99.99, max: not explained)", said)
        self.assertIn("| **100, 1** |", said)
        self.assertNotIn("No row exceeds it.", said)

    def test_contacts_that_are_complete_just_in_time_have_their_reason_and_others_have_not(self):
        late = "an answer that is complete just in time still makes contacts"
        self.assertIn(late, text(within_100us__contacts__inside=row(over=100, complete=0.5, pairs=9000)))
        self.assertNotIn(late, text(within_100us__contacts__inside=row(over=100, complete=0.0, pairs=9000)))
        self.assertNotIn(late, text(within_100us__contacts__inside=row(over=100, complete=0.5, pairs=9)))
        self.assertNotIn(late, text(within_100us__leaf_pairs__inside=row(over=100, complete=0.5, pairs=9000)))


class Away(unittest.TestCase):
    def test_what_was_away_is_not_in_n_and_stands_beside_it(self):
        said = text(within_100us__contacts__inside=row(over_away=210, loop_away=220))
        self.assertIn("| 790, 780 | 210, 220 |", said)
        self.assertIn("for over 3 µs, and so in no quantile, were 21 to 21 % of the queries of a row and 22 to 22 % of its loops", said)
        self.assertIn("In no row were queries away more often", said)

    def test_queries_that_are_away_more_often_than_loops_are_bold(self):
        said = text(within_100us__contacts__inside=row(over_away=210, loop_away=20))
        self.assertIn("**Queries were away more often than loops**", said)
        self.assertIn("in 1 of 1 rows: contacts of sphere inside a sphere within 100 µs (210 and 20)", said)
        self.assertIn("| **210, 20** |", said)


class Given(unittest.TestCase):
    def test_every_given_time_is_listed_the_shortest_first(self):
        said = text(within_5000us__contacts__inside=row(), within_70us__contacts__inside=row())
        self.assertLess(said.index("| contacts | 70 |"), said.index("| contacts | 5,000 |"))


if __name__ == "__main__":
    unittest.main()
