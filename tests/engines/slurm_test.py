"""The array script of docs/sweeps.md in a Slurm of one node, which requeues a task that is killed in the middle of a part."""

import os
import re
import unittest

from array_script import write_array_script
from one_node_slurm import PROGRAMS, OneNodeSlurm, program
from support import command, kill_in_the_middle_of_a_part, make_job, path_with_command, sha256, sha256_by_one_process, skip

MISSING = [name for name in PROGRAMS if program(name) is None]
if MISSING:
    skip(f"no {' '.join(MISSING)}: no Slurm runs the array script, and only Sweep.SlurmByHand has run it; scripts/setup.sh --slurm installs them")


class Slurm(unittest.TestCase):
    def test_a_killed_task_is_requeued_and_the_table_is_that_of_one_process(self):
        os.environ.update(path_with_command())  # which the jobs inherit
        sweep = make_job(self, 8000, 1000)
        script = write_array_script(sweep.path.parent)
        with OneNodeSlurm() as slurm:
            said = slurm.ask("sbatch", "--array=0-3", "--cpus-per-task=1", script, cwd=script.parent)
            job = re.fullmatch(r"Submitted batch job (\d+)\n", said)[1]
            _, part = kill_in_the_middle_of_a_part(sweep.folder)
            slurm.wait("the end of the array", lambda: slurm.ask("squeue", "--noheader") == "", 300)
            jobs = slurm.ask("scontrol", "show", "job", job)
            version = slurm.ask("sbatch", "--version").strip()
        self.assertEqual(sorted(re.findall(r"Restarts=(\d)", jobs)), ["0", "0", "0", "1"], jobs)
        self.assertEqual(re.findall(r"Requeue=(\d)", jobs), ["1"] * 4, jobs)
        self.assertEqual(re.findall(r"JobState=(\w+)", jobs), ["COMPLETED"] * 4, jobs)
        self.assertIn(part, sweep.status().done)
        command("sweep", sweep.path, "-o", sweep.folder, "--merge")
        self.assertEqual(sha256(sweep.folder), sha256_by_one_process(sweep))
        print(f"{version}, a node of its own, ran the array script, and requeued a task that was killed")


if __name__ == "__main__":
    unittest.main()
