"""What the report says of other libraries follows from the results: IST wins and loses, and a loss has the reason that is known."""

import pathlib
import sys
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from report import peers_builds, peers_elsewhere  # noqa: E402  after its folder is known
from report.losses import NOT_EXPLAINED, by_reason  # noqa: E402
from report.peer_answers import Answers, verdict  # noqa: E402
from report.peers_otherwise import avx2_verdict, cold, points_verdict  # noqa: E402
from report.results import Results, Run  # noqa: E402

POSES = ("0.0", "-1.0")


def answers(times, series="peers", **marks):
    """Runs of IST, which takes 10 µs, and of one other with its times and marks."""
    given = {"ist": ((10, 10), {}), "other": (times, marks)}
    return [{"name": f"{series}/meets/{player}/{pose}/iterations:1/manual_time", "label": pose, "p50_us": time, "n": 5,
             "agree": 1, "promise": 0, "prepared": 0} | own
            for player, (row, own) in given.items() for pose, time in zip(POSES, row)]


def asked(runs, series="peers"):
    results = Results("nowhere")
    results._read["peers_bench"] = {"benchmarks": runs, "context": {"swept_mb": "600"}}
    return results, Answers(results, "meets", series)


class Standing(unittest.TestCase):
    @staticmethod
    def said(times, **marks):
        return verdict(asked(answers(times, **marks))[1])[0]

    def test_a_win_everywhere_is_said_plainly(self):
        self.assertEqual(self.said((20, 30)), "IST is the fastest at all 2 poses.")

    def test_noise_is_neither_a_win_nor_a_loss(self):
        self.assertEqual(self.said((20, 9.8)), "IST is the fastest at 1 of 2 poses, and as fast as the fastest, within 3 %, at 1.")
        self.assertIn("IST is the fastest at 0 of 2 poses, and as fast as the fastest, within 3 %, at 1. **It loses at 1, by up to 2 times**",
                      self.said((5, 9.8)))

    def test_a_loss_without_a_mark_is_not_explained(self):
        self.assertIn(f"IST is the fastest at 1 of 2 poses. **It loses at 1, by up to 2 times** (other, -1.0): to **other at 1** ({NOT_EXPLAINED}).",
                      self.said((20, 5)))

    def test_a_mark_is_the_reason(self):
        for marks, reason in (({"promise": 2}, "it reads stored distances"), ({"prepared": 1}, "its mesh was moved"),
                              ({"agree": 0}, "it gives another answer")):
            said = self.said((20, 5), **marks)
            self.assertIn(f"**other at 1** ({reason}", said)
            self.assertTrue(said.endswith(" No other without a mark answers."), said)

    def test_those_without_a_mark_win_or_lose_where_they_answer(self):
        for times, expected in (((20, 5), "IST is the fastest at all 1 poses where one answers."),
                                ((5, 5), "IST is the fastest at 0 of 1 poses where one answers. **It loses at 1")):
            runs = answers(times)
            runs[-1]["agree"] = 0  # the other's, at the second pose
            said = verdict(asked(runs)[1])[0]
            self.assertIn(f"Among those without a mark, {expected}", said)


class ColdCaches(unittest.TestCase):
    def said(self, times):
        results, warm = asked(answers((20, 20)) + answers(times, "cold"))
        cold_only = Answers(results, "meets", "cold")
        with mock.patch("report.peers_otherwise.asked_in", return_value={"meets": cold_only}):
            return "\n".join(cold(results, {"meets": warm}))

    def test_they_have_a_verdict_of_their_own(self):
        self.assertIn("IST is the fastest at all 2 poses.", self.said((20, 30)))
        self.assertIn("**It loses at 2, by up to 2 times**", self.said((9, 5)))


class Avx2(unittest.TestCase):
    @staticmethod
    def said(times):
        runs = [entry | {"name": entry["name"].replace("/other/", "/ist_avx2/")} for entry in answers(times)]
        return avx2_verdict({"meets": asked(runs)[1]})

    def test_it_may_be_slower_or_faster(self):
        self.assertEqual(self.said((12, 11)), "The kernels that IST chooses are slower at no pose by 3 % or more.")
        self.assertIn(f"at 1 of 2: **meets at -1.0, 1.25 times** ({NOT_EXPLAINED})", self.said((12, 8)))


class Builds(unittest.TestCase):
    BOUNDS = {"p50_us": 0.13, "held_mb": 0.22}

    @staticmethod
    def said(bounds, **other):
        runs = [Run({"name": f"peers/build/{name}", "p50_us": 8000, "held_mb": 160, "peak_mb": 180} | more)
                for name, more in (("ist", {}), ("bullet", other))]
        return peers_builds.verdict(runs, bounds)

    def test_who_needs_most_is_said_in_bold_with_the_reason(self):
        said = self.said(self.BOUNDS, p50_us=100, held_mb=16, peak_mb=18)
        self.assertIn("**time to build: 1 of 1 need less, bullet 80 times less** (tight bounds of every voxel", said)
        self.assertIn("the trees need 13 % of that", said)
        self.assertIn("**peak memory: 1 of 1 need less, bullet 10 times less** (89 % of it is the memory held)", said)

    def test_bounds_that_cost_little_explain_nothing(self):
        for bounds in ({}, {"p50_us": 0.9, "held_mb": 0.9}):
            self.assertIn(f"({NOT_EXPLAINED})", self.said(bounds, p50_us=100, held_mb=200, peak_mb=200))

    def test_a_win_has_no_loss(self):
        self.assertEqual(self.said(self.BOUNDS, p50_us=9000, held_mb=200, peak_mb=200), "IST builds in the least time, and holds the least memory.")


class Points(unittest.TestCase):
    @staticmethod
    def said(time):
        return points_verdict({("ist", "0"): {"p50_us": 10}, ("cgal", "0"): {"p50_us": time}}, ["ist", "cgal"], ["0"])

    def test_it_may_win_or_lose(self):
        self.assertEqual(self.said(20), "IST is the fastest at all 1 poses.")
        self.assertIn("**cgal at 0, 2 times as fast**", self.said(5))


class Elsewhere(unittest.TestCase):
    def test_the_sentence_counts_the_machines_of_the_data(self):
        for machines, said in ((["a"], "one measurement on another machine"), (["a", "b", "c"], "one measurement on each of 3 other machines")):
            with mock.patch.dict(peers_elsewhere.ELSEWHERE["native_fcl"], machines=machines):
                self.assertEqual(peers_elsewhere.measured(), said)


class Reasons(unittest.TestCase):
    def test_losses_of_one_reason_stand_together(self):
        self.assertEqual(by_reason([("a", "x"), ("b", None), ("c", "x")]), f"**a, c** (x); **b** ({NOT_EXPLAINED})")


if __name__ == "__main__":
    unittest.main()
