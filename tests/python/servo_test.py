"""A scene's loop, a tick at a time, and what is misused in it."""

import os
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

    def test_bad_scenes(self):
        self.refuses(ist.InputError, "scene.toml:3", ist.Servo, self.scene(self.SCENE.replace('"box"', '"bax"')))
        self.refuses(ist.FileError, "missing.toml", ist.Servo, "missing.toml")
        name = self.scene(self.SCENE)
        self.refuses(ist.InputError, "unit", ist.Servo, name, unit="inch")
        self.refuses(ist.InputError, "query_time_fraction", ist.Servo, name, query_time_fraction=2)
        self.refuses(ist.InputError, "sphere_tests", ist.Servo, name, sphere_tests=-5)


if __name__ == "__main__":
    unittest.main()
