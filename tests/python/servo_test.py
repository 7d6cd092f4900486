"""A scene's loop, a tick at a time, and what is misused in it."""

import os
import sys
import threading
import time
import unittest

import numpy as np
from support import Refusals, folder

import ist


class Servos(Refusals):
    SCENE = """unit = "mm"
[fixed]
shape = "box"
size = [10, 10, 4]
voxel_size = 0.5
[held]
shape = "sphere"
radius = 2
voxel_size = 0.5
translation = [0, 0, 4.5]
[device]
kind = "null"
[effects.springs]
"""

    def scene(self, text):
        name = os.path.join(folder(self), "scene.toml")
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
        return name

    def test_a_tick_and_its_faults(self):
        with ist.Servo(self.scene(self.SCENE), sphere_tests=100_000) as servo:
            start = servo.tool
            np.testing.assert_allclose(start[:3, :3], np.eye(3), atol=1e-9)
            deep = start.copy()
            deep[2, 3] -= 1.5
            for _ in range(400):
                felt = servo.tick(deep)
            self.assertGreater(felt.force[2], 0.05)  # pushed out of the box
            self.refuses(ist.InputError, "out", servo.tick, deep, out=np.empty(6))
            self.refuses(ist.InputError, "out", servo.tick, deep, out=np.empty((2, 3), np.float32))
            self.refuses(ist.InputError, "out", servo.tick, deep, out=np.empty((3, 2)).T)
            self.refuses(ist.InputError, "out", servo.tick, deep, out=[[0, 0, 0], [0, 0, 0]])
            self.refuses(ist.InputError, "pose", servo.tick, 2 * np.eye(4))
            self.refuses(ist.InputError, "pose", servo.tick, np.eye(3))
            self.refuses(ist.InputError, "pose", servo.tick, None)
            self.assertEqual((servo.faults, servo.ticks), (2, 402))
            self.assertEqual(servo.tick_seconds, 0.001)
            self.assertIsInstance(servo.warnings, tuple)
        self.refuses(ist.FreedError, "freed", servo.tick, start)

    def test_a_tick_fills_what_it_is_given(self):
        scene, forces = self.scene(self.SCENE), []
        for out in (None, np.full((2, 3), 7.0)):
            with ist.Servo(scene, sphere_tests=100_000) as servo:
                deep = servo.tool.copy()
                deep[2, 3] -= 1.5
                before = servo.tick(deep, out=out)
                for _ in range(399):
                    felt = servo.tick(deep, out=out)
                forces.append(np.array(felt))
                if out is None:
                    self.assertFalse(np.shares_memory(before.force, felt.force))
                    continue
                self.assertTrue(np.shares_memory(felt.force, out) and np.shares_memory(felt.torque, out))
                self.assertEqual(out.tobytes(), forces[0].tobytes())
                with self.assertRaises(ist.InputError):
                    servo.tick(None, out=out)
                self.assertEqual(out.tolist(), np.zeros((2, 3)).tolist())
        self.assertGreater(forces[0][0, 2], 0.05)

    BODIES = SCENE.replace("[held]", """[[fixed]]
name = "piece"
shape = "box"
size = [2, 2, 2]
voxel_size = 0.5
translation = [0, 4, 5]
attachable = true
[held]
name = "tool\"""").replace("[fixed]\nshape", "[[fixed]]\nname = \"plate\"\nshape")

    def test_a_hand_takes_and_releases_bodies(self):
        with ist.Servo(self.scene(self.BODIES), sphere_tests=100_000) as servo:
            self.assertEqual([(body.name, body.held) for body in servo.bodies], [("plate", False), ("piece", False), ("tool", True)])
            np.testing.assert_allclose(servo.bodies[1].pose[:3, 3], [0, 4, 5], atol=1e-9)
            up = servo.tool.copy()
            up[2, 3] += 1
            for _ in range(100):
                servo.tick(up)
            servo.attach("piece")
            self.assertTrue(servo.bodies[1].held)
            self.refuses(ist.ChangeRefused, "there already", servo.attach, "piece")
            self.refuses(ist.ChangeRefused, "attachable", servo.attach, "plate")
            self.refuses(ist.InputError, "no body called peace", servo.attach, "peace")
            self.refuses(ist.InputError, "name of a body", servo.release, 3)
            up[2, 3] += 0.5
            for _ in range(400):
                servo.tick(up)
            np.testing.assert_allclose(servo.bodies[1].pose[:3, 3], [0, 4, 5.5], atol=1e-3)  # it moved with the tool
            servo.release("piece")
            self.refuses(ist.ChangeRefused, "there already", servo.release, "piece")
            self.assertFalse(servo.bodies[1].held)
        self.refuses(ist.FreedError, "freed", servo.attach, "piece")

    BOXES = """unit = "mm"
[fixed]
shape = "box"
size = [10, 10, 4]
[held]
shape = "box"
size = [4, 4, 4]
translation = [0, 0, 4.5]
[device]
kind = "null"
[effects.contact]
"""

    def test_the_last_tick_and_its_contacts(self):
        for unit, scale in (("mm", 1.0), ("m", 1e-3)):
            with ist.Servo(self.scene(self.BOXES), unit=unit, sphere_tests=100_000) as servo:
                self.assertIsNone(servo.last())
                self.assertEqual((len(servo.contacts), servo.contacts.dtype), (0, ist.SERVO_CONTACT))
                hand = servo.tool.copy()
                for tick in range(700):  # the force is whole after 500
                    if tick < 200:
                        hand[2, 3] -= 0.01 * scale
                    before = time.monotonic_ns()
                    felt = servo.tick(hand)
                    state = servo.last()
                    self.assertEqual(state.tick, tick)
                    self.assertGreaterEqual(state.execution_ns, 0)
                    if sys.platform == "linux":
                        self.assertTrue(before <= state.begin_ns <= time.monotonic_ns() - state.execution_ns)
                self.assertEqual(state.tool.tolist(), servo.tool.tolist())
                np.testing.assert_allclose(state.device, hand, rtol=1e-14)
                self.assertEqual((state.force.tolist(), state.torque.tolist()), (felt.force.tolist(), felt.torque.tolist()))
                self.assertTrue(state.device_known and state.steps > 0 and not state.fault and not state.held)
                contacts = servo.contacts
                self.assertEqual(contacts.tobytes(), state.contacts.tobytes())
                self.assertTrue(1 <= len(contacts) <= 6)
                np.testing.assert_allclose(contacts["position"][:, 2], 2 * scale, rtol=1e-6)  # on the fixed box
                np.testing.assert_allclose(contacts["normal"], [[0, 0, 1]] * len(contacts), atol=1e-9)
                self.assertTrue(np.all((contacts["gap"] > 0) & (contacts["gap"] < 0.1 * scale)))
                self.assertEqual({(int(one["fixed"]), int(one["held"])) for one in contacts}, {(0, 1)})
                self.assertGreater(felt.force[2], 0.3)
                self.assertAlmostEqual(contacts["force"][:, 2].sum(), felt.force[2], delta=0.01)  # they bear the hand's force
                with self.assertRaises(ist.InputError):
                    servo.tick(None)
                self.assertTrue(servo.last().fault and not servo.last().device_known)
                self.assertEqual((servo.last().force.tolist(), len(servo.contacts)), ([0, 0, 0], 0))
        self.refuses(ist.FreedError, "freed", servo.last)

    def test_a_thread_reads_whole_ticks_while_another_one_ticks(self):
        ticks, wanted = 300, []
        scene = self.scene(self.BOXES)

        def make_ticks(servo, note):
            hand = servo.tool.copy()
            for tick in range(ticks):
                hand[2, 3] -= 0.01
                servo.tick(hand)
                note(tick)

        with ist.Servo(scene, sphere_tests=100_000) as servo:
            make_ticks(servo, lambda _: wanted.append(servo.last()))
        with ist.Servo(scene, sphere_tests=100_000) as servo:
            seen, latest, done = [], threading.Event(), threading.Event()

            def read():
                while not done.is_set():
                    state = servo.last()
                    if state is not None:
                        seen.append(state)
                        latest.set()

            def wait_for_the_reader(tick):  # threads may share a core
                if tick % 20 == 19:
                    latest.clear()
                    self.assertTrue(latest.wait(60))

            reader = threading.Thread(target=read)
            reader.start()
            try:
                make_ticks(servo, wait_for_the_reader)
            finally:
                done.set()
                reader.join()
        self.assertGreaterEqual(len({state.tick for state in seen}), ticks // 40)
        self.assertEqual([state.tick for state in seen], sorted(state.tick for state in seen))
        for state in seen:
            same = wanted[state.tick]
            self.assertEqual(state.tool.tobytes(), same.tool.tobytes())
            self.assertEqual(state.force.tobytes(), same.force.tobytes())
            self.assertEqual(state.contacts.tobytes(), same.contacts.tobytes())

    def test_bad_scenes(self):
        self.refuses(ist.InputError, "scene.toml:3", ist.Servo, self.scene(self.SCENE.replace('"box"', '"bax"')))
        self.refuses(ist.FileError, "missing.toml", ist.Servo, "missing.toml")
        name = self.scene(self.SCENE)
        self.refuses(ist.InputError, "unit", ist.Servo, name, unit="inch")
        self.refuses(ist.InputError, "query_time_fraction", ist.Servo, name, query_time_fraction=2)
        self.refuses(ist.InputError, "sphere_tests", ist.Servo, name, sphere_tests=-5)


if __name__ == "__main__":
    unittest.main()
