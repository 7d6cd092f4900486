"""A sweep by GNU parallel, which starts a job again that is killed in the middle of a part."""

import shutil
import subprocess
import unittest

from support import command, kill_in_the_middle_of_a_part, make_job, path_with_command, sha256, sha256_by_one_process, skip

if shutil.which("parallel") is None:
    skip("no GNU parallel; scripts/setup.sh --sweep installs it")


class Parallel(unittest.TestCase):
    def test_a_job_is_killed_and_the_table_is_that_of_one_process(self):
        sweep = make_job(self, 8000, 1000)
        log = sweep.path.with_name("log")
        line = ["parallel", "--jobs", "2", "--retries", "4", "--joblog", log, "ist", "sweep", sweep.path, "-o", sweep.folder, "--share", "{}/4",
                "--threads", "1", ":::", "0", "1", "2", "3"]
        running = subprocess.Popen(list(map(str, line)), env=path_with_command(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        process, part = kill_in_the_middle_of_a_part(sweep.folder)
        said, _ = running.communicate(timeout=300)
        self.assertEqual(running.returncode, 0, f"{said}\n{log.read_text()}")
        self.assertIn(part, sweep.status().done)
        command("sweep", sweep.path, "-o", sweep.folder, "--merge")
        self.assertEqual(sha256(sweep.folder), sha256_by_one_process(sweep), f"process {process} was killed")


if __name__ == "__main__":
    unittest.main()
