"""The array script of docs/sweeps.md, its variables set by hand, as Slurm sets them."""

import subprocess
import unittest

from array_script import write_array_script
from support import command, make_job, path_with_command, sha256, sha256_by_one_process


class SlurmByHand(unittest.TestCase):
    def test_the_tasks_of_an_array_make_the_table_of_one_process(self):
        sweep = make_job(self, 70, 10)
        script = write_array_script(sweep.path.parent)
        self.assertIn("--requeue", script.read_text())
        seen = []
        for task in range(3):
            variables = {"SLURM_ARRAY_TASK_ID": str(task), "SLURM_ARRAY_TASK_COUNT": "3", "SLURM_CPUS_PER_TASK": "2"}
            ran = subprocess.run(["bash", script], env=path_with_command() | variables, cwd=script.parent,
                                 capture_output=True, text=True, check=False)
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
            seen.append(len(sweep.status().done))
        self.assertEqual(seen[-1], 7)
        self.assertTrue(0 < seen[0] < seen[1] < seen[2], f"each task makes a share of its own: {seen}")
        command("sweep", sweep.path, "-o", sweep.folder, "--merge")
        self.assertEqual(sha256(sweep.folder), sha256_by_one_process(sweep))
        print("bash ran the array script, its variables set by hand: Slurm itself runs it in Sweep.Slurm alone")


if __name__ == "__main__":
    unittest.main()
