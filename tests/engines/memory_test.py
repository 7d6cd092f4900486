"""A million poses in memory that does not grow with them."""

import os
import subprocess
import sys
import unittest

from support import make_job, np

import ist

MEGABYTE = 1 << 20
# A process counts the memory of the one that started it, too, so a small one does.
STARTER = """import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


class Memory(unittest.TestCase):
    def peak(self, sweep, *words):
        """Runs `ist sweep`. Returns the most memory that it had, MiB."""
        command = [sys.executable, "-S", "-c", STARTER, os.environ["IST_COMMAND"], "sweep", sweep.path, "-o", sweep.folder, *words]
        ran = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        return int(ran.stdout) * 1024 / MEGABYTE

    def peaks(self, count, rows_per_part):
        """Makes a sweep of poses far apart, and its table. Returns it with the most memory of both, MiB."""
        sweep = make_job(self, count, rows_per_part, low=(1000, -500, -500), high=(2000, 500, 500))
        sweep.path.write_text(sweep.path.read_text().replace(', "distance"', "").replace("tolerance = 0.002\n", ""))
        return sweep, self.peak(sweep, "--threads", "1"), self.peak(sweep, "--merge")

    def test_a_million_poses_far_apart(self):
        _, *small = self.peaks(200_000, 200_000)
        sweep, *large = self.peaks(1_000_000, 1_000_000)
        table = np.load(sweep.folder / "rows.npy", mmap_mode="r")
        self.assertEqual(len(table), 1_000_000)
        self.assertEqual((table["intersects"].min(), table["intersects"].max()), (ist.NO, ist.NO))
        self.assertEqual(table["index"][-1], 999_999)
        print("made, merged: " + " MiB, ".join(f"{most:.1f}" for most in (*small, *large)) + f" MiB; the table has {table.nbytes / MEGABYTE:.0f} MiB")
        for before, after in zip(small, large):
            self.assertLess(after - before, table.nbytes / MEGABYTE / 4)


if __name__ == "__main__":
    unittest.main()
