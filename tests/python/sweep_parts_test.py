"""The parts of a sweep from Python: made in any order, followed, ended, merged and refused."""

import contextlib
import copy
import fcntl
import os
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import unittest
from support import box
from sweep_support import ANSWERS, BODIES, GRID, Sweeps, box_poses

import ist


class Parts(Sweeps):
    def test_sizes(self):
        sweep = self.job(box_poses(1, 45))
        self.assertEqual((sweep.rows, sweep.rows_per_part, sweep.parts), (45, 10, range(5)))
        self.assertRegex(sweep.hash, "^[0-9a-f]{32}$")
        self.assertEqual(sweep.folder, sweep.path.with_suffix(".sweep"))
        self.assertFalse(sweep.folder.exists())
        self.assertIn("45 rows in 5 parts", repr(sweep))
        self.assertEqual(self.job(box_poses(1, 0)).parts, range(0))

    def test_the_hash_names_the_rows(self):
        hashes = [self.job(*each).hash for each in ((box_poses(1, 45),), (box_poses(2, 45),), (box_poses(1, 46),), (GRID,),
                                                    (box_poses(1, 45), ("distance",)), (box_poses(1, 45), ("intersects",), "tests = 9"))]
        self.assertEqual(len(set(hashes)), len(hashes))
        self.assertEqual(self.job(box_poses(1, 45)).hash, hashes[0])

    def test_parts_are_made_once_in_any_order_and_merge(self):
        sweep = self.job(box_poses(2, 45) + "turns_within = [9, 9, 9]\n", ("intersects", "distance"))
        self.assertEqual(sweep.status(), ([], [0, 1, 2, 3, 4], [], [], 0.0))
        for part in (4, 1):
            made = sweep.run(part)
            self.assertEqual(made[:3], (part, "made", 5 if part == 4 else 10))
            self.assertGreater(made.seconds, 0)
            self.assertEqual(sweep.run(part), (part, "there", made.rows, made.seconds))
        self.assertEqual(sweep.merge(), (0, [0, 2, 3], []))
        self.assertFalse((sweep.folder / "rows.npy").exists())
        status = sweep.status(verify=True)
        self.assertEqual(status[:4], ([1, 4], [0, 2, 3], [], []))
        self.assertAlmostEqual(status.seconds, sum(sweep.run(part).seconds for part in (1, 4)))
        for part in (3, 0, 2):
            sweep.run(part)
        self.assertEqual(sweep.merge(), (45, [], []))
        parts = [np.load(sweep.folder / f"part-{part:06}.npy") for part in sweep.parts]
        self.assertEqual([len(part) for part in parts], [10, 10, 10, 10, 5])
        self.assertEqual(np.load(sweep.folder / "rows.npy").tobytes(), np.concatenate(parts).tobytes())
        self.assertTrue((sweep.folder / "manifest.json").exists())
        written = (sweep.folder / "rows.npy").stat().st_mtime_ns
        self.assertEqual(sweep.merge(), (45, [], []))
        self.assertEqual((sweep.folder / "rows.npy").stat().st_mtime_ns, written)

    def test_a_merge_beside_another_one_is_refused(self):
        sweep = self.job(box_poses(2, 10))
        sweep.run(0)
        with open(sweep.folder / "rows.start", "w", encoding="ascii") as mark:
            fcntl.flock(mark, fcntl.LOCK_EX)
            with self.assertRaisesRegex(ist.BusyError, "another process is merging"):
                sweep.merge()
        self.assertEqual(sweep.merge().rows, 10)
        self.assertFalse((sweep.folder / "rows.start").exists())

    def test_no_pose_is_a_table_of_no_rows(self):
        sweep = self.job(box_poses(1, 0))
        self.assertEqual(sweep.merge(), (0, [], []))
        table = np.load(sweep.folder / "rows.npy")
        self.assertEqual((table.shape, table.dtype), ((0,), sweep.columns))
        self.assertTrue((sweep.folder / "manifest.json").exists())

    def test_a_folder_in_which_nobody_has_begun_lacks_all_parts(self):
        sweep = self.job(box_poses(1, 25))
        self.assertEqual(sweep.merge(), (0, [0, 1, 2], []))
        self.assertFalse(sweep.folder.exists())

    def test_every_number_of_threads_makes_the_same_bytes(self):
        sweep = self.job(box_poses(3, 600), ANSWERS, "rows_per_part = 600\ntolerance = 0.01")
        made = []
        for threads in (1, 2, 0):
            folder = self.place / f"by {threads}"
            self.assertEqual(sweep.run(0, folder, threads=threads).outcome, "made")
            made.append((folder / "part-000000.npy").read_bytes())
        self.assertEqual(made, made[:1] * 3)

    def test_threads_share_a_sweep(self):
        sweep = self.job(box_poses(4, 400), ("distance",), "rows_per_part = 20\ntolerance = 0.001")
        outcomes = []

        def run(parts):
            for part in parts:
                outcomes.append(sweep.run(part, threads=1).outcome)

        threads = [threading.Thread(target=run, args=[sweep.parts[k::4]]) for k in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(outcomes, ["made"] * 20)
        self.assertEqual(sweep.merge(), (400, [], []))
        alone = sweep.folder.with_suffix(".alone")
        for part in sweep.parts:
            sweep.run(part, alone)
        sweep.merge(alone)
        self.assertEqual((sweep.folder / "rows.npy").read_bytes(), (alone / "rows.npy").read_bytes())

    def test_a_pickle_is_opened_anywhere(self):
        sweep = self.job(box_poses(6, 20))
        expected = [self.run_alone(sweep, part) for part in sweep.parts]
        before = os.getcwd()
        os.chdir(self.place)
        try:
            named = ist.Sweep(sweep.path.name, "here")
        finally:
            os.chdir(before)
        self.assertEqual((named.path, named.folder), (sweep.path, self.place / "here"))
        for other in (pickle.loads(pickle.dumps(named)), copy.copy(named), copy.deepcopy(named)):
            self.assertEqual((other.hash, other.path, other.folder), (sweep.hash, sweep.path, self.place / "here"))
            other.run(1)
        self.assertEqual((self.place / "here/part-000001.npy").read_bytes(), expected[1])

    @staticmethod
    def run_alone(sweep, part):
        """The bytes of a part that a process of its own makes."""
        program = f"import pickle, sys; pickle.loads(sys.stdin.buffer.read()).run({part})"
        subprocess.run([sys.executable, "-B", "-c", program], input=pickle.dumps(sweep), check=True)
        return (sweep.folder / f"part-{part:06}.npy").read_bytes()

    def test_a_part_that_was_lost_three_times_is_given_up(self):
        sweep = self.job(box_poses(9, 20_001), ("distance",), "rows_per_part = 20000\ntolerance = 0.0001")
        sweep.run(1)
        program = ("import ist, os, signal\n"
                   f"sweep = ist.Sweep({str(sweep.path)!r})\n"
                   "sweep.run(0, threads=1, progress=lambda done: done and os.kill(os.getpid(), signal.SIGSTOP))")
        lost = 0
        while lost < 3:
            with subprocess.Popen([sys.executable, "-B", "-c", program]) as process:
                os.waitpid(process.pid, os.WUNTRACED)  # it stops itself in the middle of the part
                made = sweep.status().done
                if made == [1]:
                    self.assertEqual(sweep.status().missing, [0])
                    with self.assertRaisesRegex(ist.BusyError, "making this part"):
                        sweep.run(0)
                process.kill()
            if made != [1]:  # it stopped when the part was made, which forgets the processes before
                self.assertEqual(made, [0, 1])
                for file in sweep.folder.glob("part-000000.*"):
                    file.unlink()
            lost = lost + 1 if made == [1] else 0
        self.assertEqual(sweep.status()[:4], ([1], [], [0], []))
        self.assertEqual(sweep.run(0)[:2], (0, "given up"))
        self.assertEqual(sweep.merge(), (0, [], [0]))
        for mark in sweep.folder.glob("part-000000.start-*"):
            mark.unlink()
        self.assertEqual(sweep.run(0)[:2], (0, "made"))
        self.assertEqual(sweep.merge().rows, 20_001)


class Ended(Exception):
    pass


class Follow(Sweeps):
    def long(self):
        return self.job(box_poses(10, 20_000), ("distance",), "rows_per_part = 20000\ntolerance = 0.0001")

    def test_parts_and_merges_are_followed(self):
        sweep = self.long()
        for attempt in range(20):  # if the system lets the caller wait for as long as the part takes, it is told once
            shares, folder = [], self.place / f"followed {attempt}"
            sweep.run(0, folder, threads=1, progress=shares.append)
            if len(shares) > 1:
                break
        self.assertEqual(shares, sorted(shares))
        self.assertTrue(0 <= shares[0] < shares[-1] <= 1)
        calls = []
        sweep.merge(folder, progress=calls.append)
        sweep.status(folder, progress=calls.append)
        ist.Sweep(sweep.path, progress=calls.append)
        self.assertGreaterEqual(len(calls), 3)
        self.assertTrue(all(0 <= each <= 1 for each in calls))

    def test_an_exception_ends_the_call_and_leaves_nothing(self):
        sweep = self.long()

        def end(kind, after=-1):
            def progress(done):
                if done > after:
                    raise kind
            return progress

        for kind in (Ended, KeyboardInterrupt, SystemExit):
            self.assertRaises(kind, sweep.run, 0, progress=end(kind))
            self.assertRaises(kind, ist.Sweep, sweep.path, progress=end(kind))
            for attempt in range(20):  # the system may let the caller wait until the part is there
                with contextlib.suppress(kind):
                    sweep.run(0, threads=1, progress=end(kind, after=0.01))
                if sweep.status().done == []:
                    break
                for file in sweep.folder.glob("part-*"):
                    file.unlink()
            self.assertEqual(os.listdir(sweep.folder), ["sweep.json"])
        small = self.job(box_poses(10, 10))
        small.run(0)
        before = sorted(os.listdir(small.folder))
        self.assertRaises(Ended, small.merge, progress=end(Ended))
        self.assertRaises(Ended, small.status, progress=end(Ended))
        self.assertEqual(sorted(os.listdir(small.folder)), before)
        self.assertEqual(small.merge().rows, 10)

    def test_ctrl_c(self):
        sweep = self.long()
        sweep.path.write_text(sweep.path.read_text().replace("20000", "2000000"))
        program = f"""import ist
from ist._follow import Follower
sweep = ist.Sweep({str(sweep.path)!r})
report, reports = Follower._report, []
def told(self, user, part):
    first = part and not any(reports)
    reports.append(part)
    if first:
        print('begun', flush=True)
    return report(self, user, part)
Follower._report = told
try:
    sweep.run(0, threads=1)
except KeyboardInterrupt:
    print('interrupted', sweep.status().missing)
"""
        process = subprocess.Popen([sys.executable, "-B", "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "begun\n")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
        self.assertEqual((out, err, process.returncode), ("interrupted [0]\n", "", 0))
        self.assertEqual(os.listdir(sweep.folder), ["sweep.json"])


class Misuse(Sweeps):
    def test_numbers(self):
        sweep = self.job(box_poses(1, 20))
        for part in (-1, 2**64, 0.5, "one", None):
            self.refuses(ist.InputError, "part", sweep.run, part)
        self.refuses(ist.InputError, "part", sweep.run, 2)
        for threads in (-1, 1025, 1.5, None):
            self.refuses(ist.InputError, "threads", sweep.run, 0, threads=threads)
        for first, count in ((-1, 1), (21, 0), (0, 21), (19, 2), (0, -1), ("a", 1), (0, 0.5), (2**64, 0)):
            self.refuses(ist.InputError, "", sweep.poses, first, count)
        for call in (lambda: sweep.run(0, progress=3), lambda: sweep.merge(progress=3), lambda: ist.Sweep(sweep.path, progress=3)):
            self.refuses(TypeError, "progress", call)
        self.assertFalse(sweep.folder.exists())

    def test_files(self):
        self.refuses(ist.FileError, "missing.toml", ist.Sweep, self.place / "missing.toml")
        self.refuses(ist.InputError, "zero", ist.Sweep, "a\0b.toml")
        self.refuses(ist.InputError, "zero", ist.Sweep, self.job(GRID).path, "a\0b")
        self.refuses(TypeError, "", ist.Sweep, 5)
        self.refuses(ist.InputError, [".toml:", "answers", "touch"], self.job, GRID, ["touch"])
        self.refuses(ist.InputError, [".toml:", "no file", "nobody.ist", "tree"], self.job, GRID, bodies=BODIES.replace("lower", "nobody"))
        self.refuses(ist.InputError, ["hash", "changed"], self.job, GRID, bodies=BODIES.replace("[moving]", f'hash = "{"0" * 32}"\n[moving]'))
        self.refuses(ist.InputError, "poses", self.job, "")

    def test_folders(self):
        sweep, other = self.job(box_poses(1, 20)), self.job(box_poses(2, 20))
        sweep.run(0)
        for call in (lambda: other.run(0, sweep.folder), lambda: other.merge(sweep.folder), lambda: other.status(sweep.folder)):
            self.refuses(ist.InputError, "sweep", call)
        self.assertEqual(sweep.status()[:2], ([0], [1]))
        empty = self.place / "empty"
        empty.mkdir()
        self.assertEqual(sweep.status(empty).missing, [0, 1])
        self.assertEqual(sweep.run(1, empty).outcome, "made")
        file = self.place / "no folder"
        file.write_text("")
        self.refuses(ist.Error, "no folder", sweep.run, 0, file)

    def test_a_damaged_part_is_found(self):
        sweep = self.job(box_poses(3, 30))
        for part in sweep.parts:
            sweep.run(part)
        first, second = sweep.folder / "part-000000.npy", sweep.folder / "part-000001.npy"
        content = bytearray(first.read_bytes())
        content[-1] ^= 1
        first.write_bytes(content)
        self.assertEqual(sweep.status().damaged, [])
        self.assertEqual(sweep.status(verify=True)[:4], ([1, 2], [], [], [0]))
        self.refuses(ist.InputError, "part-000000.npy", sweep.merge)
        first.unlink()
        second.write_bytes(second.read_bytes()[:-1])
        self.assertEqual(sweep.status()[:4], ([2], [0], [], [1]))
        self.refuses(ist.InputError, "part-000001.npy", sweep.run, 1)
        second.unlink()
        self.assertEqual([sweep.run(part).outcome for part in (0, 1)], ["made", "made"])
        self.assertEqual(sweep.merge().rows, 30)

    def test_a_tree_that_changed(self):
        ist.build(box([0, 0, 0], [1, 1, 1]), 0.5).save(self.place / "changes.ist")
        sweep = self.job(box_poses(1, 20), bodies=BODIES.replace("lower", "changes"))
        ist.build(box([0, 0, 0], [1, 1, 2]), 0.5).save(self.place / "changes.ist")
        self.refuses(ist.InputError, ["changes.ist", "changed"], sweep.run, 0)
        self.assertFalse(os.path.exists(sweep.folder))

    def test_freed(self):
        with self.job(box_poses(1, 20)) as sweep:
            sweep.run(0)
        sweep.free()
        for call in (lambda: sweep.run(1), sweep.merge, sweep.status, lambda: sweep.poses(0, 1)):
            self.refuses(ist.FreedError, "freed", call)
        self.assertEqual(repr(sweep), "<ist.Sweep, freed>")
        self.assertEqual((sweep.rows, sweep.parts), (20, range(2)))

    def test_a_sweep_may_be_freed_while_it_runs(self):
        sweep, begun = self.job(box_poses(10, 2000), ("distance",), "tolerance = 0.0001"), threading.Event()
        outcomes = []
        thread = threading.Thread(target=lambda: outcomes.append(sweep.run(0, progress=lambda done: begun.set())))
        thread.start()
        begun.wait()
        sweep.free()
        thread.join()
        self.assertEqual(outcomes[0][:3], (0, "made", 2000))


if __name__ == "__main__":
    unittest.main()
