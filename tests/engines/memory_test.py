"""A million poses in memory that does not grow with them."""

import os
import resource
import subprocess
import unittest

from support import make_job, np

import ist

MEGABYTE = 1 << 20


class Memory(unittest.TestCase):
    def peak(self, *arguments):
        """Runs `ist sweep`. Returns the most memory of all commands so far, MiB."""
        ran = subprocess.run([os.environ["IST_COMMAND"], "sweep", *map(str, arguments)], capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024 / MEGABYTE

    def test_a_million_poses_far_apart(self):
        sweep = make_job(self, 1_000_000, 100_000, low=(1000, -500, -500), high=(2000, 500, 500))
        sweep.path.write_text(sweep.path.read_text().replace(', "distance"', "").replace("tolerance = 0.002\n", ""))
        making = self.peak(sweep.path, "-o", sweep.folder)
        merging = self.peak(sweep.path, "-o", sweep.folder, "--merge")
        table = np.load(sweep.folder / "rows.npy", mmap_mode="r")
        self.assertEqual(len(table), 1_000_000)
        self.assertEqual((table["intersects"].min(), table["intersects"].max()), (ist.NO, ist.NO))
        self.assertEqual(table["index"][-1], 999_999)
        print(f"at most {making:.0f} MiB, with the merge {merging:.0f} MiB; the table has {table.nbytes / MEGABYTE:.0f} MiB")
        self.assertLess(merging, 200)


if __name__ == "__main__":
    unittest.main()
