"""The tables of the report: they are those that the stored results give, and a loss in the results is bold in its table."""

import json
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
import perf_report as report  # noqa: E402  after its folder is known
from report import draw, peers  # noqa: E402
from report.figures import ROOT  # noqa: E402
from report.results import Results, Run  # noqa: E402
from report.tables import BLOCK, Table, between, factor, number, power, runs  # noqa: E402

TEXT = {page: (ROOT / page).read_text() for page in report.PAGES}
STORED = ROOT / "perf" / re.search(r"`(results/[\w-]+)`", TEXT["perf/REPORT.md"])[1]
MACHINES = sorted(folder for folder in STORED.parent.iterdir() if folder.is_dir())
# By table: a program, the begin of names of its runs, a counter, and a factor that makes a loss, or a win of a loss.
LOSSES = {
    "advice": ("advise_bench", "advise", "voxel_size", 1.5),
    "missed contacts": ("accuracy_bench", "verdict/0.8/slab", "missed", None),
    "forces": ("accuracy_bench", "force/0.2/slab", "angle_max", 100),
    "hand": ("hand_bench", "accuracy/built-in/contact", "gap_mm", -1),
    "ticks of a press": ("hand_bench", "ticks/built-in/contact/any/1", "rests_p50_us", 1000),
    "coherent": ("coherent_bench", "ticks/0.8/held_closed", "kept_p50_us", 100),
    "tolerance": ("measure_bench", "by_accuracy/distance/0.1/", "p50_us", 100),
    "warm depth": ("measure_bench", "measure/depth/warm", "real_time", 2),
    "saved spheres": ("seed_bench", "saved/0.8/simple/saved", "p50_us", 2),
    "added at 0.2 mm": ("ablation_bench", "ablation/ladder/", "p50_us", "tight"),
    "same spheres at 0.2 mm": ("ablation_bench", "ablation/same/fast-slab/0.2", "p50_us", 100),
    "left out at 0.2 mm": ("ablation_bench", "ablation/without/0-full/0.2", "p50_us", 100),
    "closing": ("ablation_bench", "ablation/same/fast-slab/0.2", "p50_us", 100),
    "a thousand balls": ("peers_bench", "worlds/all_touch/ist", "first_us", 1000),
    "standings": ("peers_bench", "peers/pairs/ist", "p50_us", 1000),
    "vertices": ("peers_bench", "points/distances/ist", "p50_us", 1000),
    "workers": ("scaling_bench", "workers/2", "p50_us", 10),
    "conformal": ("scaling_bench", "conformal/plates/0.5", "p50_us", 0.01),
    "largest pair": ("scaling_bench", "largest", "peak_MB", 2),
    "deadlines": ("deadline_bench", "within_100us/leaf_pairs/jaws", "over_max_us", 100),
    "lateness": ("loop_bench", "loop/1/idle", "missed", None),
    "pairs of a tick": ("loop_bench", "bodies", "ratio", 2),
    "pairs apart": ("loop_bench", "bodies", "apart_p50_us", 10),
    "world": ("world_bench", "world/four_bodies", "ratio", 2),
    "grid": ("world_bench", "world/hundred_at_rest", "real_time", 1e5),
    "by memory": ("hardware_bench", "hardware/0.8/", "words", 100),
    "sweeps": ("sweep_bench", "sweep/rates", "loop_in_c", 2),
}


def made_of(program):
    return next(made for made in map(Results, (STORED, *MACHINES)) if made.made(program))


def bold(name, results):
    return "\n".join(report.lines_of(name, results)).count("**")


class Pages(unittest.TestCase):
    def test_the_tables_are_those_of_the_stored_results(self):
        self.assertEqual(report.filled(TEXT["perf/REPORT.md"], Results(STORED)), TEXT["perf/REPORT.md"])
        machines = [Results(folder) for folder in MACHINES]
        for page, block in ((page, block) for page, text in TEXT.items() for block in BLOCK.finditer(text)):
            if table := report.TABLES.get(block[2].removesuffix(" table")):
                found = ["\n".join(report.lines_of(block[2].removesuffix(" table"), made)) for made in machines if made.made(table.program)]
                self.assertIn(block[0][len(block[1]):-len(block[3])].rstrip("\n"), found, page)

    def test_a_number_typed_by_hand_is_found(self):
        text = TEXT["perf/REPORT.md"].replace("| `slab` | 0.8 |", "| `slab` | 0.7 |")
        self.assertNotEqual(report.filled(text, Results(STORED)), text)

    def test_each_table_and_each_plot_has_a_place(self):
        placed = {block[2] for text in TEXT.values() for block in BLOCK.finditer(text)}
        self.assertEqual({f"{name} table" for name in (*report.TABLES, "instructions", "made with")} - placed, set())
        shown = set(re.findall(r"pictures/report/(\w+)\.svg", TEXT["perf/REPORT.md"]))
        self.assertEqual(shown, set(draw.PLOTS))

    def test_each_plot_gives_lines_of_equal_length(self):
        for name, (program, function) in draw.PLOTS.items():
            self.assertIn(program, report.PROGRAMS)
            for panel in function(made_of(program))["panels"]:
                for xs, ys, _ in panel["lines"]:
                    self.assertEqual(len(list(xs)), len(list(ys)), name)

    def test_every_figure_from_elsewhere_has_a_source(self):
        for name, told in json.loads((ROOT / "perf/elsewhere.json").read_text()).items():
            self.assertGreater(len(told["source"]), 50, name)


class Losses(unittest.TestCase):
    def test_a_loss_in_the_results_is_bold_in_its_table(self):
        for table, (program, begin, counter, times) in LOSSES.items():
            results = made_of(program)
            before = bold(table, results)
            changed = [run for run in results._file(program)["benchmarks"] if run["name"].startswith(begin) and counter in run
                       and (not isinstance(times, str) or times in run["name"])]
            self.assertTrue(changed, table)
            for run in changed:
                run[counter] = 1 if times is None else run[counter] * (100 if isinstance(times, str) else times)
            self.assertNotEqual(bold(table, results), before, table)

    def test_a_pose_at_which_no_other_answers_is_no_win(self):
        rows = [Run({"name": f"peers/meets/{name}", "promise": promise, "prepared": 0, "a:p50_us": 2, "b:p50_us": 2, "a:agree": 1, "b:agree": agree})
                for name, promise, agree in (("ist", 0, 1), ("fcl", 0, 0), ("openvdb", 2, 1))]
        self.assertEqual(peers.standing(rows, peers.unmarked)["count"], 1)
        self.assertEqual(peers.standing(rows, lambda *_: True)["count"], 2)

    def test_the_worst_case_agrees_only_right_before_contact(self):
        results = Results(STORED)
        for run in results._file("seed_bench")["benchmarks"]:
            if re.match(r"rate/0\.8/reference/\w+/1\.5/", run["name"]):
                run["p50_us"] = 1e6
        rows = [line for line in report.lines_of("worst cases", results) if line.startswith("| 0.8 |")]
        self.assertEqual([row.split(" | ")[4] for row in rows], ["*Agrees*"] * 2)

    def test_a_hit_that_the_circuit_misses_stops_the_report(self):
        results = Results(STORED)
        results._file("hardware_bench")["benchmarks"][0]["false_misses"] = 3
        self.assertRaisesRegex(SystemExit, "the circuit misses 3 hits", report.lines_of, "near misses", results)

    def test_one_build_makes_no_median(self):
        results = Results(STORED)
        builds = results._file("build_bench")["benchmarks"]
        builds[:] = [run for run in builds if not run["name"].startswith("build/slab/0.8") or run.get("repetition_index") == 0]
        self.assertRaisesRegex(SystemExit, "too few builds for a median", report.lines_of, "build", results)

    def test_queries_that_were_away_are_not_among_those_that_count(self):
        results = Results(STORED)
        run = next(run for run in results._file("deadline_bench")["benchmarks"] if run["name"].startswith("within_100us/leaf_pairs/jaws"))
        run["n"], run["over_away"], run["loop_away"] = 1000, 400, 0
        row = next(line for line in report.lines_of("deadlines", results) if line.startswith("| jaws, five poses | leaf pairs | 100 |"))
        self.assertTrue(row.endswith("| 600, 1,000 | **400, 0** |"), row)


class Parts(unittest.TestCase):
    def test_runs_that_differ_in_one_part_are_one_row(self):
        results = Results("nowhere")
        results._read["some"] = {"benchmarks": [{"name": f"a/{way}/{size}", "t": t} for size in "xy" for way, t in (("slow", 4), ("fast", 2))]}
        table = Table("some", runs("a", by=1), [("size", 2), ("times", lambda r: r["slow:t"] / r["fast:t"], lambda r: r.parts[2] == "y")])
        self.assertEqual(table.lines(results), ["| size | times |", "|---|---|", "| x | 2 |", "| y | **2** |"])

    def test_results_that_are_missing_or_failed_are_named(self):
        results = Results("nowhere")
        results._read["some"] = {"benchmarks": [{"name": "a/b", "error_occurred": True, "error_message": "no memory"}]}
        self.assertRaisesRegex(SystemExit, "some: a/b: no memory", results.runs, "some", "a")
        self.assertRaisesRegex(SystemExit, "some.json has no c", results.runs, "some", "c")

    def test_numbers_have_the_digits_that_count(self):
        for value, text in {0: "0", 12345.6: "12,346", 123.4: "123", 12.34: "12.3", 0.012345: "0.0123", 0.00001234: "0.0000123"}.items():
            self.assertEqual(number(value), text)
        self.assertEqual([factor(value) for value in (0.96, 0.98, 12.34)], ["**0.96**", "0.98", "12.3"])

    def test_a_power_law_is_read_exactly_between_its_points_and_not_beyond(self):
        points = [(x, 3 * x**-2) for x in (1, 2, 8)]
        self.assertAlmostEqual(between(points, 4), 3 / 16)
        self.assertIsNone(between(points, 0.9))
        exponent, times = power(*zip(*points))
        self.assertAlmostEqual(exponent, -2)
        self.assertAlmostEqual(times, 3)


if __name__ == "__main__":
    unittest.main()
