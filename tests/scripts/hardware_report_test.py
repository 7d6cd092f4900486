"""What scripts/hardware_report.py makes of counts and netlists."""

import json
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
import hardware_report  # noqa: E402  after its folder is known

# As yosys 0.23 writes it: its last brace is missing.
STAT = '{\n "modules": {"top": {"num_cells_by_type": %s}},\n "design": {"num_cells_by_type": %s\n }\n'
ICE40 = {"SB_LUT4": 1320, "SB_CARRY": 7, "SB_DFF": 100, "SB_DFFSR": 23, "SB_MAC16": 4, "SB_RAM40_4K": 2}
ECP5 = {"LUT4": 1000, "CCU2C": 107, "TRELLIS_FF": 45, "MULT18X18D": 4, "DP16KD": 2}


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

    def report(self):
        with mock.patch.dict(os.environ, {"PATH": f"{self.folder}:{os.environ['PATH']}"}):
            return "\n".join(hardware_report.lines(self.folder))

    def test_cells_are_counted_by_what_they_are(self):
        said = self.report()
        self.assertIn("| iCE40 UP5K | 1,320 of 5,280 (25 %) | 123 | 4 of 8 (50 %) | 2 of 30 (7 %) |", said)
        self.assertIn("| ECP5 LFE5U-25F | 1,214 of 24,288 (5 %) | 45 |", said)
        self.assertIn("Yosys 9.9", said)

    def test_a_clock_is_told_if_it_was_measured(self):
        self.assertIn("`nextpnr-ice40` is not installed |", self.report())
        (self.folder / "placed.json").write_text(json.dumps(
            {"fmax": {"clk": {"achieved": 40.0}}, "utilization": {"ICESTORM_LC": {"used": 528, "available": 5280}}}))
        self.assertIn("| 40.0 MHz, with 528 of 5,280 (10 %) logic cells |", self.report())


if __name__ == "__main__":
    unittest.main()
