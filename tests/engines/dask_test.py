"""A sweep on two processes of dask, one of which is killed in the middle of a part.

IST_DASK_POSES gives the first test another number of poses, and IST_DASK_TABLE names a file for its table.
"""

import ast
import inspect
import os
import pathlib
import shutil
import signal
import threading
import unittest

from support import kill_in_the_middle_of_a_part, make_job, sha256, sha256_by_one_process, skip, stopped_in_part

try:
    from distributed import Client, LocalCluster
except ImportError as missing:
    skip(f"{missing}; scripts/setup.sh --sweep installs it, for /usr/bin/python3")

import ist
import ist.dask


class Dask(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cluster = LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
        cls.addClassCleanup(cluster.close)
        cls.client = Client(cluster, set_as_default=False)
        cls.addClassCleanup(cls.client.close)

    def workers(self):
        return set(self.client.run(os.getpid).values())

    def makes_all_although_a_worker_is_killed(self, sweep):
        workers, killed, shares = self.workers(), [], []

        def kill():
            killed.append(kill_in_the_middle_of_a_part(sweep.folder)[0])

        killer = threading.Thread(target=kill)
        killer.start()
        status = ist.dask.run(sweep, self.client, progress=shares.append)
        killer.join()
        self.assertEqual(len(killed), 1, "no worker died")
        self.assertIn(killed[0], workers)
        self.assertNotIn(killed[0], self.workers())
        self.assertEqual(status[:4], (list(sweep.parts), [], [], []))
        self.assertEqual(sweep.merge().rows, sweep.rows)
        self.assertEqual(sha256(sweep.folder), sha256_by_one_process(sweep))
        self.assertEqual((shares, shares[-1], len(shares)), (sorted(shares), 1, len(sweep.parts)))

    def test_a_worker_is_killed_and_the_table_is_that_of_one_process(self):
        sweep = make_job(self, int(os.environ.get("IST_DASK_POSES", "16000")), 1000)
        self.makes_all_although_a_worker_is_killed(sweep)
        if kept := os.environ.get("IST_DASK_TABLE"):
            shutil.copyfile(sweep.folder / "rows.npy", kept)

    def test_tasks_that_dask_gives_up_are_tried_again(self):
        def allow(failures):
            self.client.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", failures))

        allow(0)  # a killed worker's tasks end with KilledWorker
        self.addCleanup(allow, 3)
        self.makes_all_although_a_worker_is_killed(make_job(self, 8000, 1000))

    def test_what_is_there_is_not_made_again(self):
        sweep, shares = make_job(self, 40, 10), []
        sweep.run(2)
        self.assertEqual(ist.dask.run(sweep, self.client, threads=2, progress=shares.append).done, [0, 1, 2, 3])
        self.assertEqual(len(shares), 3)
        self.assertEqual(ist.dask.run(sweep, self.client, progress=shares.append).done, [0, 1, 2, 3])
        self.assertEqual(len(shares), 3)

    def test_a_part_that_somebody_else_makes_is_waited_for(self):
        sweep, shares = make_job(self, 4000, 1000), []

        def progress(share):
            shares.append(share)
            if share == 0.75:  # the other process goes on when all other parts are made
                other.send_signal(signal.SIGCONT)

        with stopped_in_part(sweep, 1) as other:
            self.assertEqual(ist.dask.run(sweep, self.client, retries=0, progress=progress).done, [0, 1, 2, 3])
            self.assertEqual(shares, [0.25, 0.5, 0.75, 1])
            self.assertEqual(other.stdout.read(), b"made\n")

    def test_an_error_comes_out(self):
        sweep = make_job(self, 40, 10)
        sweep.path.write_text(sweep.path.read_text().replace("seed = 7", "seed = 8"))
        with self.assertRaisesRegex(ist.InputError, "another sweep"):
            ist.dask.run(sweep, self.client, retries=1)
        self.assertFalse(sweep.folder.exists())

        def enough(done):
            raise TimeoutError("that is enough")

        sweep = make_job(self, 40, 10)
        with self.assertRaisesRegex(TimeoutError, "enough"):
            ist.dask.run(sweep, self.client, progress=enough)
        self.assertEqual(ist.dask.run(sweep, self.client).done, [0, 1, 2, 3])

    def test_the_stub_has_its_parameters(self):
        stub = ast.parse(pathlib.Path(ist.dask.__file__).with_suffix(".pyi").read_text())
        said = next(each for each in stub.body if isinstance(each, ast.FunctionDef))
        self.assertEqual([each.arg for each in said.args.args], list(inspect.signature(ist.dask.run).parameters))


if __name__ == "__main__":
    unittest.main()
