"""What scripts/hardware_report.py makes of counts and netlists."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]

# As yosys 0.23 writes it: its last brace is missing.
STAT = '{\n "modules": {"top": {"num_cells_by_type": %s}},\n "design": {"num_cells_by_type": %s\n }\n'
ICE40 = {"SB_LUT4": 1320, "SB_CARRY": 7, "SB_DFF": 100, "SB_DFFSR": 23, "SB_MAC16": 4, "SB_RAM40_4K": 2}
ECP5 = {"LUT4": 1000, "CCU2C": 107, "TRELLIS_FF": 45, "MULT18X18D": 4, "DP16KD": 2}


def run(size, dz, **counters):
    return {"name": f"hardware/{size}/{dz}/iterations:3", "label": "made-up", "voxel_size": size, "pairs": 100000,
            "pairs_exact": 100000, "contacts": 10, "contacts_exact": 10, "opened": 10000, "words": 50000, "moved": 7,
            "misses": 50000, "false_hits": 0, "false_misses": 0, "false_hit_rate": 0, "word_bytes": 8, "nodes": 2**17, **counters}


class HardwareReport(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # The version is all that it asks of yosys, which need not be here.
        (self.folder / "yosys").write_text("#!/bin/sh\necho 'Yosys 9.9 (git)'\n")
        (self.folder / "yosys").chmod(0o755)
        for family, counts in (("ice40", ICE40), ("ecp5", ECP5)):
            (self.folder / f"{family}.json").write_text(STAT % (json.dumps(counts), json.dumps(counts)))

    def report(self, *runs):
        (self.folder / "hardware_bench.json").write_text(json.dumps(
            {"context": {"commit": "abc", "date": "2026-01-02T03"}, "benchmarks": list(runs)}))
        file = self.folder / "HARDWARE.md"
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "scripts"),
                       "PATH": f"{self.folder}:{os.environ['PATH']}"}
        subprocess.run([sys.executable, "-B", "scripts/hardware_report.py", self.folder, self.folder, file], check=True,
                       cwd=ROOT, env=environment)
        return file.read_text()

    def test_cells_are_counted_by_what_they_are(self):
        said = self.report(run(0.4, 0.0))
        self.assertIn("| iCE40 UP5K | 1,320 of 5,280 (25 %) | 123 | 4 of 8 (50 %) | 2 of 30 (7 %) |", said)
        self.assertIn("| ECP5 LFE5U-25F | 1,214 of 24,288 (5 %) | 45 |", said)
        self.assertIn("Yosys 9.9", said)

    def test_a_clock_is_told_where_it_was_measured(self):
        self.assertIn("The clock is not measured", self.report(run(0.4, 0.0)))
        (self.folder / "placed.json").write_text(json.dumps(
            {"fmax": {"clk": {"achieved": 40.0}}, "utilization": {"ICESTORM_LC": {"used": 528, "available": 5280}}}))
        said = self.report(run(0.4, 0.0))
        self.assertNotIn("The clock is not measured:", said)
        self.assertIn("**40.0 MHz**", said)
        self.assertIn("| 40.0 MHz, as placed | 400 … 200 Hz |", said)

    def test_a_hit_that_is_missed_is_not_passed_over(self):
        self.assertIn("misses a hit in 0 of 200,000 pairs.", self.report(run(0.4, 0.0), run(0.4, -1.0)))
        self.assertIn("misses a hit in 3 of 200,000 pairs: **this must not be",
                      self.report(run(0.4, 0.0), run(0.4, -1.0, false_misses=3)))

    def test_near_misses_are_told_at_their_worst(self):
        self.assertIn("It calls no miss a hit.", self.report(run(0.4, 0.0)))
        said = self.report(run(0.4, 0.0), run(0.4, -1.0, false_hits=100, false_hit_rate=0.002, pairs_exact=80000))
        self.assertIn("At most 0.200 % of the misses become hits. They cost at most 25.00 % more pairs", said)
        self.assertIn("no more leaf pairs.", said)
        self.assertIn("at most 3 more leaf pairs, of 10", self.report(
            run(0.4, 0.0, false_hits=1, false_hit_rate=0.001, contacts=13)))

    def test_the_worst_tick_is_the_one_with_most_pairs(self):
        said = self.report(run(0.4, 0.0), run(0.4, -1.0, pairs=200000, opened=0), run(0.8, 0.0, pairs=10000, opened=1000))
        self.assertIn("| 0.4 | -1.0 | 200,000 |", said)
        self.assertIn("| 100 MHz | **10,000** … **5,000** Hz | 500 … 500 Hz |", said)
        self.assertIn("| bytes a tick |  |  | 400,080 | 400,080 |", said)

    def test_what_limits_is_chosen_by_the_numbers(self):
        said = self.report(run(0.4, 0.0), run(0.8, 0.0, words=5000))
        self.assertIn("- Voxel 0.8, 100 MHz, one 16-bit SDRAM at 100 MHz: the circuit is the limit, and 1,000 Hz are reached", said)
        self.assertIn("- Voxel 0.4, 100 MHz, one 16-bit SDRAM at 100 MHz: the memory is the limit, and 1,000 Hz are not", said)


if __name__ == "__main__":
    unittest.main()
