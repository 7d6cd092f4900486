"""What the report decides by: curves between measured points, and numbers as they are written."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from report import bodies  # noqa: E402  after its folder is known
from report.curves import between, crossings, power  # noqa: E402
from report.peer_answers import Answers  # noqa: E402
from report.peers_elsewhere import ELSEWHERE, absent, native_fcl  # noqa: E402
from report.peers_otherwise import asked_in  # noqa: E402
from report.results import Results  # noqa: E402
from report.text import number, table  # noqa: E402


class Curves(unittest.TestCase):
    def test_a_power_law_is_read_exactly_between_its_points(self):
        points = [(x, 3 * x**-2) for x in (1, 2, 8)]
        self.assertAlmostEqual(between(points, 4), 3 / 16)
        self.assertAlmostEqual(between(points, 8), 3 / 64)

    def test_nothing_is_read_beyond_the_points(self):
        self.assertIsNone(between([(1, 1), (2, 2)], 0.9))
        self.assertIsNone(between([(1, 1), (2, 2)], 2.1))

    def test_the_power_is_found(self):
        exponent, factor = power([1, 2, 4], [5 * x**1.5 for x in (1, 2, 4)])
        self.assertAlmostEqual(exponent, 1.5)
        self.assertAlmostEqual(factor, 5)

    def test_curves_cross_where_the_lead_changes(self):
        (place,) = crossings([0, 10], [1, 2], [2, 1])
        self.assertAlmostEqual(place, 5)
        self.assertEqual(crossings([0, 1, 2], [1, 1, 1], [2, 2, 2]), [])

    def test_a_lead_within_the_noise_is_none(self):
        self.assertEqual(crossings([0, 1, 2], [1, 1.02, 1], [2, 1, 2]), [])
        self.assertEqual(len(crossings([0, 1, 2], [1, 1.2, 1], [2, 1, 2])), 2)


class Bodies(unittest.TestCase):
    """Four bodies within their goals, and a hundred at rest that take longer."""

    def setUp(self):
        times = {f"{kind}{quantile}_us": 10 for kind in ("", "one_by_one_", "together_", "apart_") for quantile in ("p50", "p99")}
        self.results = Results("nowhere")
        self.results._read["loop_bench"] = {"benchmarks": [
            {"name": "bodies/splint/iterations:1", "ticks": 100, "ticks_apart": 10, "ratio": 1.1, **times, "apart_p50_us": 0.5}]}
        self.results._read["world_bench"] = {"benchmarks": [
            {"name": "world/four_bodies/contacts/iterations:1/manual_time", "ratio": 1.2, "bodies": 4, "pairs": 6,
             "voxel_size": 0.4, "tremble_voxels": 0.05, **times},
            {"name": "world/hundred_at_rest/real_time", "real_time": 25, "bodies": 100, "moved": 0},
            {"name": "world/a_pair_apart/real_time", "real_time": 0.3, "bodies": 2, "moved": 1}]}
        self.text = "\n".join(bodies.chapter(self.results, None))

    def test_a_promise_that_holds_is_said_plainly(self):
        self.assertIn("\nTogether they take 1.1 times the pairs one by one: the goal is at most 1.15.", self.text)
        self.assertIn("\nA pair that is apart takes 0.5 µs: the goal is at most 2.", self.text)

    def test_one_that_does_not_is_bold_in_words_and_in_the_table(self):
        self.assertIn("**`contacts` of the world takes 1.2 times its queries; the goal is at most 1.15** (a world also", self.text)
        self.assertIn("| 100 bodies, none near, 0 moving | **25** | 20 |", self.text)


class Peers(unittest.TestCase):
    """Two poses, at which FCL takes 1.5 and 3 times as long as IST, and the sampler takes 1 µs."""

    TIMES = {"ist": (10, 10), "fcl": (15, 30), "openvdb": (1, 1)}

    def setUp(self):
        runs = [{"name": f"peers/meets/{player}/{pose}/iterations:1/manual_time", "label": pose, "p50_us": time, "n": 5, "agree": 1,
                 "promise": 2 if player == "openvdb" else 0, "prepared": 0}
                for player, times in self.TIMES.items() for pose, time in zip(("truth7", "far"), times)]
        self.results = Results("nowhere")
        self.results._read["peers_bench"] = {"benchmarks": runs}
        self.meets = Answers(self.results, "meets")

    def with_fcl(self, *times):
        for run in self.meets.runs.values():
            if "/fcl/" in run["name"]:
                run["p50_us"] = times[run["label"] == "far"]
        return native_fcl("meets", self.meets)[0]

    def test_fcl_as_it_could_be_wins_where_either_factor_suffices(self):
        text = native_fcl("meets", self.meets)[0]
        self.assertIn("some 1.7 to 2.1 times faster", text)
        self.assertIn("By either factor it would be the fastest of those without a mark at 1 of 2 poses (truth7).", text)

    def test_and_where_the_greater_factor_alone_does(self):
        self.assertIn("By the greater factor it would be the fastest of those without a mark at 1 of 2 poses (far), by the lesser one at 0.",
                      self.with_fcl(22, 20))
        self.assertIn("at 2 of 2 poses (truth7, far), by the lesser one at 1 (truth7).", self.with_fcl(15, 20))

    def test_or_nowhere(self):
        self.assertIn("By either factor it would win at no pose.", self.with_fcl(22, 30))

    def test_every_figure_from_elsewhere_has_a_source(self):
        for name, figures in ELSEWHERE.items():
            self.assertGreater(len(figures["source"]), 50, name)

    def test_nothing_is_said_of_a_question_that_was_not_measured_so(self):
        self.assertEqual(native_fcl("candidates", self.meets), [])

    def test_who_is_absent_stands_in_proportion_to_fcl_here(self):
        self.assertIn(f"some {number(15 * ELSEWHERE['pqp']['p50_us']['pqp'] / ELSEWHERE['pqp']['p50_us']['fcl'])} µs here; IST takes 10.",
                      absent({"pairs": self.meets})[0])

    def test_what_was_not_asked_is_left_out(self):
        self.assertEqual(asked_in(self.results, "avx2"), {})


class Texts(unittest.TestCase):
    def test_numbers_have_the_digits_that_count(self):
        written = {0: "0", 12345.6: "12,346", 123.4: "123", 12.34: "12.3", 0.012345: "0.0123", 0.00001234: "0.0000123"}
        for value, text in written.items():
            self.assertEqual(number(value), text)

    def test_tables_are_markdown(self):
        self.assertEqual(table(["a", "b"], [["x", 1.5]]), ["| a | b |", "|---|---|", "| x | 1.5 |"])


if __name__ == "__main__":
    unittest.main()
