"""What the tests of the package share: bodies, poses that turn, and the command beside them."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("numpy is missing: scripts/setup.sh --python")
    sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)

import ist

BOX_FACES = np.array(
    [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4],
     [3, 4, 7]]
)


def box(low, high):
    """The vertices and faces of a closed box."""
    (a, b, c), (d, e, f) = low, high
    corners = [[a, b, c], [d, b, c], [d, e, c], [a, e, c], [a, b, f], [d, b, f], [d, e, f], [a, e, f]]
    return np.array(corners, float), BOX_FACES


def turn(axis, angle):
    """A rotation, (3, 3), by Rodrigues' formula."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def pose_of(axis, angle, shift):
    pose = np.eye(4)
    pose[:3, :3] = turn(axis, angle)
    pose[:3, 3] = shift
    return pose


# The lower jaw open, nearly closed, and closed; all of them turn, so that a transposed pose shows.
JAW_POSES = [
    pose_of([1, 0.2, 0.1], 0.004, [0.3, -0.2, -2.5]),
    pose_of([0.1, 1, 0.3], -0.01, [0.1, 0.4, -0.7]),
    pose_of([0.3, -0.1, 1], 0.015, [0.2, 0.1, -0.1]),
]


def write_stl(path, vertices, faces):
    facets = np.zeros(len(faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets["corners"] = vertices[faces]
    with open(path, "wb") as file:
        file.write(bytes(80) + np.uint32(len(faces)).tobytes() + facets.tobytes())


class Jaws(unittest.TestCase):
    """Both built-in jaws, in voxels of 0.8 mm."""

    @classmethod
    def setUpClass(cls):
        cls.meshes = ist.jaws()
        cls.upper, cls.lower = (ist.build(mesh, voxel_size=0.8) for mesh in cls.meshes)
        cls.query = ist.Query(cls.upper, cls.lower)


class Refusals(unittest.TestCase):
    """Asks for an exception, and for words in it."""

    def refuses(self, kind, words, call, *arguments, **options):
        with self.assertRaises(kind) as raised:
            call(*arguments, **options)
        text = str(raised.exception)
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, text)
        if isinstance(raised.exception, ist.Error):
            self.assertGreater(raised.exception.code, 0)
            self.assertNotIn(raised.exception.name, ("", "unknown"))
        return raised.exception


def unaligned(array):
    """A copy of an array that begins one byte beyond where its numbers may begin."""
    memory = np.zeros(array.nbytes + 1, np.uint8)
    memory[1:] = np.frombuffer(array.tobytes(), np.uint8)
    return memory[1:].view(array.dtype).reshape(array.shape)


def command_lines(*arguments):
    """What the command prints as JSON, without its header."""
    done = subprocess.run([os.environ["IST_COMMAND"], *map(str, arguments)], capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()][1:]


def folder(test):
    made = tempfile.TemporaryDirectory()
    test.addCleanup(made.cleanup)
    return made.name
