"""Calls that last: their caller follows them, ends them by an exception, and Ctrl-C ends them too."""

import ctypes
import gc
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
from support import JAW_POSES, Jaws, box, write_stl

import ist
from ist._handle import Handle


class Ended(Exception):
    pass


class Follow(Jaws):

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        write_stl(os.path.join(cls.folder.name, "upper.stl"), *cls.meshes[0])
        cls.upper.save(os.path.join(cls.folder.name, "upper.ist"))
        cls.bytes = cls.upper.to_bytes()

    def calls(self):
        """Calls of some 0.1 s and more, each with a progress function."""
        poses = np.tile(JAW_POSES[1], (3000, 1, 1))
        points = np.random.default_rng(1).normal(scale=30, size=(200_000, 3))
        stl, tree = (os.path.join(self.folder.name, name) for name in ("upper.stl", "upper.ist"))
        return {
            "read_mesh": lambda progress: ist.read_mesh(stl, progress=progress),
            "build of a file": lambda progress: ist.build(stl, 2, progress=progress),
            "load": lambda progress: ist.load(tree, progress=progress),
            "save": lambda progress: self.upper.save(tree, progress=progress),
            "load of bytes": lambda progress: ist.load(self.bytes, progress=progress),
            "to_bytes": lambda progress: self.upper.to_bytes(progress=progress),
            "build": lambda progress: ist.build(self.meshes[0], 0.25, progress=progress),
            "rows": lambda progress: self.query.rows(poses, tolerance=0.01, progress=progress),
            "occlusion": lambda progress: self.query.occlusion(JAW_POSES[2], longest_edge=0.1, progress=progress),
            "signed_distance": lambda progress: ist.signed_distance(self.upper, points, progress=progress),
            "distance_map": lambda progress: ist.distance_map(self.upper, self.lower, JAW_POSES[1], progress=progress),
        }

    def test_parts_are_told_on_the_callers_thread(self):
        most = 0
        for name, call in self.calls().items():
            with self.subTest(name):
                parts, threads = [], set()

                def progress(part):
                    parts.append(part)
                    threads.add(threading.get_ident())

                call(progress)
                self.assertEqual(threads, {threading.get_ident()})
                self.assertTrue(all(0 <= part <= 1 for part in parts))
                self.assertEqual(parts, sorted(parts))
                most = max(most, len(parts))
        self.assertGreater(most, 1)  # a call that ends soon reports once, and not all end so soon

    def test_an_exception_ends_the_call_and_comes_out(self):
        for name, call in self.calls().items():
            for kind in (Ended, KeyboardInterrupt, SystemExit):
                with self.subTest(name, kind=kind):

                    def progress(part):
                        raise kind("as asked")

                    with self.assertRaises(kind):
                        call(progress)
        self.assertIs(self.query.intersects(JAW_POSES[2]), True)  # and the query goes on

    def test_nothing_half_made_is_left(self):
        def progress(part):
            raise Ended

        poses = np.tile(JAW_POSES[1], (500, 1, 1))
        out = np.full(500, 7, ist.ROW)
        before = out.tobytes()
        with self.assertRaises(Ended):
            self.query.rows(poses, out=out, progress=progress)
        self.assertEqual(out.tobytes(), before)
        path = os.path.join(self.folder.name, "kept.ist")
        ist.build(self.meshes[1], 4).save(path)
        with self.assertRaises(Ended):
            self.upper.save(path, progress=progress)
        self.assertEqual(ist.load(path).voxel_size, 4)
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["kept.ist", "upper.ist", "upper.stl"])
        os.remove(path)


class Hook(unittest.TestCase):
    """What Python cannot raise in a callback's first line reaches a hook, which names the callback until Python 3.12."""

    def hears(self, value, of_callback):
        import types

        from ist._follow import Follower

        before, heard, hook = sys.unraisablehook, [], lambda each: heard.append(each.exc_value)
        sys.unraisablehook = hook
        try:
            with Follower() as follower:
                named = follower._target if of_callback else None
                sys.unraisablehook(types.SimpleNamespace(object=named, exc_value=value))
                self.assertEqual(follower._report(None, 0.5), 0 if heard else 1)
            self.assertIs(sys.unraisablehook, hook)
        finally:
            sys.unraisablehook = before
        return not heard

    def test_an_interrupt_ends_the_call_named_or_not(self):
        self.assertTrue(self.hears(KeyboardInterrupt(), True))
        self.assertTrue(self.hears(KeyboardInterrupt(), False))
        self.assertTrue(self.hears(Ended(), True))

    def test_others_go_where_they_went(self):
        self.assertFalse(self.hears(Ended(), False))


class Interrupt(unittest.TestCase):
    """SIGINT while a call lasts: a process of its own says what it heard."""

    CALLS = {
        "build": "ist.build(ist.jaws()[0], 0.06, max_memory=16 << 30)",
        "occlusion": "query.occlusion(np.eye(4), longest_edge=0.01)",
        "rows": "query.rows(np.tile(np.eye(4), (400_000, 1, 1)), tolerance=0.001, threads=1)",
        "to_bytes": "while True: query.fixed.to_bytes()",
        "load of bytes": "bytes = query.fixed.to_bytes()\n    while True: ist.load(bytes)",
    }
    # The call's third report is made while it lasts.
    PROGRAM = """import ist, numpy as np
from ist._follow import Follower
query = ist.Query(*(ist.build(jaw, 0.8) for jaw in ist.jaws()))
report, reports = Follower._report, []
def told(self, user, part):
    reports.append(part)
    if len(reports) == 3:
        print('begun', flush=True)
    return report(self, user, part)
Follower._report = told
try:
    {call}
    print('ended by itself')
except KeyboardInterrupt:
    print('interrupted', query.intersects(np.eye(4)))
"""

    def test_a_call_hears_it(self):
        for name, call in self.CALLS.items():
            with self.subTest(name):
                program = self.PROGRAM.format(call=call)
                run = subprocess.Popen([sys.executable, "-B", "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                self.assertEqual(run.stdout.readline(), "begun\n")
                run.send_signal(signal.SIGINT)
                out, err = run.communicate()
                self.assertEqual((out, run.returncode), ("interrupted True\n", 0), err)
                self.assertEqual(err, "")

    def test_freeing_leaves_it_to_the_program(self):
        class Freed(Handle):
            _free = ctypes.CDLL(None)["raise"]  # SIGINT comes while an object is freed

        for in_a_cycle in (False, True):
            with self.subTest(in_a_cycle=in_a_cycle), self.assertRaises(KeyboardInterrupt):
                handle = Freed(signal.SIGINT)
                if in_a_cycle:
                    handle.itself = handle
                del handle
                gc.collect()
                time.sleep(0)


class Threads(Jaws):
    def test_a_query_serves_one_thread(self):
        entered, leave = threading.Event(), threading.Event()

        def progress(part):
            entered.set()
            leave.wait()

        caller = threading.Thread(target=lambda: self.query.rows(np.tile(JAW_POSES[0], (10, 1, 1)), progress=progress))
        caller.start()
        entered.wait()
        try:
            for call in (lambda: self.query.intersects(JAW_POSES[0]), self.query.forget, self.query.free,
                         lambda: self.query.rows(np.eye(4)[None])):
                with self.assertRaises(ist.BusyError):
                    call()
        finally:
            leave.set()
            caller.join()
        self.assertIs(self.query.intersects(JAW_POSES[0]), False)

    def test_threads_share_trees_and_run_at_once(self):
        answers, poses = [], JAW_POSES * 20
        expected = [self.query.distance(pose, 0.0)[:2] for pose in poses]

        def ask():
            query = ist.Query(self.upper, self.lower)
            answers.append([query.distance(pose, 0.0)[:2] for pose in poses])

        threads = [threading.Thread(target=ask) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(answers, [expected] * 4)

    def test_other_threads_run_during_a_call(self):
        """Python runs on other threads alone between two reports of a call. The call ends if another thread ran often there."""
        reports, runs, end = [], [], threading.Event()

        def run():
            while not end.is_set():
                runs.append(len(reports))
                time.sleep(0.001)

        def progress(part):
            if reports and runs.count(len(reports)) > 5:
                raise Ended
            reports.append(part)

        other = threading.Thread(target=run)
        other.start()
        try:
            with self.assertRaises(Ended):
                self.query.rows(np.tile(JAW_POSES[1], (400_000, 1, 1)), tolerance=0.001, threads=1, progress=progress)
        finally:
            end.set()
            other.join()

    def test_a_tree_may_be_freed_while_others_ask(self):
        tree = ist.build(box([0, 0, 0], [2, 2, 2]), 0.1)
        points = np.random.default_rng(2).normal(size=(50_000, 3))
        seen, asked = [], threading.Semaphore(0)

        def ask():
            try:
                while True:
                    ist.signed_distance(tree, points, progress=lambda part: asked.release())
            except ist.FreedError as error:
                seen.append(error)

        threads = [threading.Thread(target=ask) for _ in range(3)]
        for thread in threads:
            thread.start()
        for _ in threads:
            asked.acquire()
        tree.free()
        for thread in threads:
            thread.join()
        self.assertEqual(len(seen), 3)


if __name__ == "__main__":
    assert os.name == "posix"
    unittest.main()
