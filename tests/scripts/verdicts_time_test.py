"""What the report says of times and of errors follows from the results: each verdict can say yes, and can say no."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from report import accuracy, advice, bodies, measures, scaling_conformal, scaling_workers, sweeps  # noqa: E402  after its folder is known
from report.coherent import Motion, verdicts  # noqa: E402
from report.losses import NOT_EXPLAINED  # noqa: E402
from report.results import Run  # noqa: E402


def run(name, **counters):
    return Run({"name": name, **counters})


class CoherentTicks(unittest.TestCase):
    @staticmethod
    def motion(kept, kept_max, by_search=0, workers=1):
        return Motion(run(f"ticks/0.2/10mm_s/apart/{workers}", fresh_p50_us=100, fresh_max_us=200, kept_p50_us=kept, kept_max_us=kept_max,
                          by_search=by_search, ticks=1000, step_p50_voxels=0.05))

    def test_a_gain_is_said_plainly(self):
        median, _, slowest, _ = verdicts([self.motion(10, 190)])
        self.assertEqual(median, "The median tick by kept pairs takes 0.1 to 0.1 of a fresh query's time at 1 of 1 motions, of up to 0.05 voxels a "
                                 "tick: it loses at none.")
        self.assertNotIn("**", slowest)

    def test_a_loss_is_bold_with_its_reason(self):
        median, _, slowest, _ = verdicts([self.motion(110, 260, by_search=1000), self.motion(10, 260)])
        self.assertIn("**It takes longer at 1, by up to 1.1 times**: **10 mm/s apart at 0.2 mm** (most of its ticks are searches", median)
        self.assertIn("**It takes longer at 2, by up to 1.3 times**", slowest)
        self.assertIn("**10 mm/s apart at 0.2 mm** (the tick that makes the next front", slowest)

    def test_what_no_front_explains_is_not_explained(self):
        for lost in (self.motion(10, 500), self.motion(10, 260, workers=2)):
            self.assertIn(f"({NOT_EXPLAINED})", verdicts([lost])[2])

    def test_noise_is_no_loss(self):
        for kept, said in ((102, "it loses at none"), (104, "It takes longer at 1")):
            self.assertIn(said, verdicts([self.motion(kept, 190)])[0])

    def test_where_nothing_gains_it_says_so(self):
        self.assertIn("The median tick gains at no motion.", verdicts([self.motion(110, 260)])[0])


class Measures(unittest.TestCase):
    @staticmethod
    def asked(**times):
        return [measures.Asked([run(f"by_accuracy/depth/{tolerance}/0", p50_us=time, lower=0, upper=0)])
                for tolerance, time in ((0.1, times["coarse"]), (0.01, times["fine"]))]

    def said(self, **times):
        return measures.verdicts({"depth": self.asked(**times)})[0]

    def test_what_fits_into_a_tick_is_said_plainly(self):
        self.assertEqual(self.said(coarse=10, fine=900),
                         "The penetration depth fits into a tick of 1,000 µs to every tolerance measured, down to 0.01 mm.")

    def test_what_does_not_is_bold(self):
        self.assertIn("to 0.1 mm. It takes up to 5 times as long **to 0.01 mm** (the finer the tolerance", self.said(coarse=10, fine=5000))
        said = self.said(coarse=4000, fine=5000)
        self.assertIn("**The penetration depth fits into a tick of 1,000 µs to no tolerance.**", said)
        self.assertIn("(most of the points that it measures only show that nothing else is deeper)", said)
        self.assertIn(f"({NOT_EXPLAINED})", measures.verdicts({"distance": self.asked(coarse=4000, fine=5000)})[0])

    def test_the_slowest_pose_counts(self):
        asked = measures.Asked([run(f"by_accuracy/depth/0.1/{dz}", p50_us=time, lower=0, upper=0.1) for dz, time in ((0, 5), (-1, 7), (-2, 6))])
        self.assertEqual((asked.time, asked.slowest.parts[3]), (7, "-1"))

    def test_a_warm_start_may_gain_or_lose(self):
        cold = run("measure/depth/cold/0", real_time=100, points=1000)
        for time, points, text in ((90, 500, "at no pose slower by 3 %"), (110, 990, "**dz = 0** (it measures nearly as many"),
                                   (110, 500, f"**dz = 0** ({NOT_EXPLAINED})"),
                                   (104, 500, "takes 1.04 to 1.04 of the time afresh")):
            self.assertIn(text, measures.warm_verdict([("0", cold, run("measure/depth/warm/0", real_time=time, points=points))], 0.01))


class Errors(unittest.TestCase):
    def test_a_force_may_point_farther_off_than_by_the_voxels_balls(self):
        balls, exact = {("simple", "0.8"): (6, 17)}, {("slab", "0.8"): (0, 0)}
        self.assertNotIn("**", accuracy.forces_verdict(balls | exact))
        self.assertEqual(accuracy.forces_verdict(balls | {("slab", "0.8"): (5, 54), ("tight", "0.8"): (6.1, 17)}),
                         "In the median the direction is nowhere farther off than with `simple`. At the most the direction is farther off than with "
                         f"`simple` for **`slab` at 0.8 mm, 54° beside 17°** ({NOT_EXPLAINED}).")

    def test_missed_contacts_are_bold_and_none_is_plain(self):
        self.assertEqual(accuracy.missed_verdict([run("verdict/0.2/slab", missed=0)]), "None is missed in any row.")
        self.assertIn("**3 by `slab` at 0.2 mm**", accuracy.missed_verdict([run("verdict/0.2/slab", missed=3)]))

    def test_advice_is_larger_than_the_curve_allows_or_smaller(self):
        self.assertIn("up to 1.5 times as large", advice.size_verdict([1.1, 1.5], "80 %"))
        self.assertIn("**1 of 2 budgets", advice.size_verdict([0.9, 1.5], "80 %"))
        self.assertEqual(advice.size_verdict([], "80 %"), "")


class Scaling(unittest.TestCase):
    def test_only_a_query_longer_than_a_tick_needs_a_budget(self):
        self.assertEqual(scaling_conformal.verdict({"p50_us": 800}), "0.8 ms, within a tick of 1 ms.")
        self.assertEqual(scaling_conformal.verdict({"p50_us": 62500}), "**62.5 ms**, longer than a tick of 1 ms: such a query needs a budget.")

    @staticmethod
    def workers(median, late):
        return scaling_workers.verdict({("1", "row", "0"): {"p50_us": 100, "p99_us": 200},
                                        ("2", "row", "0"): {"p50_us": median, "p99_us": late}})

    def test_two_workers_may_gain_or_lose(self):
        self.assertNotIn("**", self.workers(60, 150))
        self.assertIn("In the median two workers are slower than one at 1 of 1, by up to 1.1 times: "
                      f"**back to back at 0** ({NOT_EXPLAINED})", self.workers(110, 150))
        self.assertIn(f"In the 99 of 100 two workers are slower than one at 1 of 1, by up to 1.5 times: **back to back at 0** ({NOT_EXPLAINED})",
                      self.workers(60, 300))


class Sweeps(unittest.TestCase):
    RATES = {"threads_1": 100, "threads_2": 190, "loop_in_c": 90, "loop_in_python": 80}

    def test_a_sweep_that_no_loop_passes_has_no_loss(self):
        self.assertNotIn("**", sweeps.verdict(self.RATES))

    def test_a_faster_loop_and_a_useless_thread_are_losses(self):
        self.assertIn("**a loop in C answers 1.04 times as many poses** (a sweep also", sweeps.verdict(self.RATES | {"loop_in_c": 104}))
        self.assertNotIn("**", sweeps.verdict(self.RATES | {"loop_in_c": 102}))
        self.assertIn(f"**2 threads answer less than 1** ({NOT_EXPLAINED})", sweeps.verdict(self.RATES | {"threads_2": 95}))


class Promises(unittest.TestCase):
    def test_one_that_fails_names_its_reason_or_that_none_is_known(self):
        self.assertIn("(a reason)", bodies._verdict("It takes", 3, 2, " µs", "a reason"))
        self.assertIn(f"({NOT_EXPLAINED})", bodies._verdict("It takes", 3, 2, " µs"))
        self.assertNotIn("(", bodies._verdict("It takes", 2, 2, " µs", "a reason"))


if __name__ == "__main__":
    unittest.main()
