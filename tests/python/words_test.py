"""The package's own words: the examples of its docstrings run, every public name has one, and the stub fits both the package
and mypy."""

import doctest
import inspect
import pathlib
import subprocess
import sys
import tempfile
import unittest

import support  # noqa: F401  which ends the run where numpy is missing

import ist
from ist import _measures, _mesh, _query, _sweep, _tree, _world

PACKAGE = pathlib.Path(ist.__file__).parent
USE = """
import pathlib
from typing import List, Optional, Tuple
import numpy as np
import ist
import ist.dask

upper, lower = (ist.build(mesh, voxel_size=0.8) for mesh in ist.jaws(seed=1))
query = ist.Query(upper, lower, workers=2, spheres="tight")
touch: Optional[bool] = query.intersects(np.eye(4))
pairs = query.leaf_pairs(np.eye(4), out=np.empty(10, ist.LEAF_PAIR))
count: int = pairs.count + query.triangle_pairs(np.eye(4).tolist()).count
near = query.near_pairs(np.eye(4), 0.1, most=20)
parts: int = query.near_parts(np.eye(4), (0, 1), 9.0).count + near.count
triangles: Optional[Tuple[int, int]] = query.distance(np.eye(4)).triangles
outcome: str = query.first_contact(np.eye(4), np.eye(4), 0.1).outcome
longest: float = query.escape(np.eye(4), longest=2.0).upper
status: str = query.settle(np.eye(4), closing=(0, 0, 1), hold=["yaw"], within=(2.0, 0.05)).status
low: float = query.distance(np.eye(4), 0.1).lower + ist.rotation_error(np.eye(4))
way: float = ist.motion_between(np.eye(4), np.eye(4), (1, 2, 3)).along
matched: List[int] = ist.match_contacts([[0, 0, 0]], [[0, 0, 1]], 2.0, after_teeth=[16]).tolist()
rows = query.rows(np.eye(4)[None], want=["intersects", "penetration"], progress=lambda part: None)
force, torque, about = query.contacts(np.eye(4)).wrench(2.0)
tree = ist.load(pathlib.Path("a.ist"))
world = ist.World(reach=0.5)
body: int = world.add(tree, np.eye(4), name="jaw")
world.reserve(near_pairs=8)
found = world.leaf_pairs(out=np.empty(4, ist.WORLD_PAIR))
of_first = found.found_of(found.pairs[0])
touching: bool = world.ask("intersects", tests=100).complete
least: Optional[float] = world.distance(0.1).upper
met: Optional[Tuple[int, int]] = world.distance(0.1).triangles
sweep = ist.Sweep("job.toml", pathlib.Path("out"), progress=lambda part: None)
outcomes = [sweep.run(part, threads=2).outcome for part in sweep.parts]
lacking: List[int] = sweep.merge().missing + sweep.status(verify=True).given_up
done: int = len(ist.dask.run(sweep, client=None, threads=2).done)
file: pathlib.Path = sweep.folder / "rows.npy"
with ist.Servo("scene.toml", unit="m") as servo:
    tick = servo.tick(None, out=np.empty((2, 3)))
    z: float = float(tick.force[2])
    state = servo.last()
    made: Optional[int] = None if state is None else state.tick
    gaps = servo.contacts["gap"]
"""
MISUSE = 'import ist\nist.Query(1, 2)\nist.Query(ist.load("a"), ist.load("b"), spheres="round")\nx: str = ist.load("a").leaves\n'


class Words(unittest.TestCase):
    def test_examples_of_docstrings(self):
        tried = 0
        for module in (ist, _measures, _mesh, _query, _sweep, _tree, _world):
            result = doctest.testmod(module)
            self.assertEqual(result.failed, 0, module.__name__)
            tried += result.attempted
        self.assertGreater(tried, 20)

    def test_every_public_name_has_a_docstring(self):
        for name in ist.__all__:
            each = getattr(ist, name)
            if inspect.isclass(each) or inspect.isfunction(each):
                self.assertTrue(each.__doc__ and not each.__doc__.startswith(f"{name}("), name)
            if not inspect.isclass(each):
                continue
            for member, value in vars(each).items():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(value.__doc__, f"{name}.{member}")

    def test_every_docstring_with_a_pose_says_which_way_it_goes(self):
        frames = {"Query": "p_fixed = pose @ p_moving", "World": "p_world = pose @ p_body", "Servo": "p_scene = pose @ p_tool",
                  "occlusion": "p_fixed = pose @ p_moving", "distance_map": "p_other = pose @ p_body",
                  "rotation_error": "p_fixed = pose @ p_moving"}
        takers = {}
        for name in ist.__all__:
            each = getattr(ist, name)
            if inspect.isclass(each):
                takers.update((f"{name}.{member}", value) for member, value in vars(each).items()
                              if inspect.isfunction(value) and not member.startswith("_"))
            elif inspect.isfunction(each):
                takers[name] = each
        takers = {name: each for name, each in takers.items()
                  if not {"pose", "poses", "start", "stop"}.isdisjoint(inspect.signature(each).parameters)}
        self.assertEqual({name.split(".")[0] for name in takers}, set(frames))
        self.assertGreaterEqual(len(takers), 14)
        for name, each in takers.items():
            self.assertIn(frames[name.split(".")[0]], each.__doc__, name)
        for name in ("Query", "World", "Servo"):
            self.assertIn(frames[name], getattr(ist, name).__doc__, name)


class Stub(unittest.TestCase):
    def mypy(self, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "use.py"
            file.write_text(text)
            return subprocess.run(
                ["/usr/bin/python3", "-m", "mypy", "--strict", "--cache-dir", folder, str(file)],
                capture_output=True, text=True, env={"MYPYPATH": str(PACKAGE.parent), "PATH": "/usr/bin:/bin"}, check=False)

    def test_mypy_accepts_what_is_right(self):
        done = self.mypy(USE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_mypy_refuses_what_is_wrong(self):
        done = self.mypy(MISUSE)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertEqual(sum(f"use.py:{line}: error" in done.stdout for line in (2, 3, 4)), 3, done.stdout)

    def test_the_stub_names_what_the_package_has(self):
        import ast

        tree = ast.parse((PACKAGE / "__init__.pyi").read_text())
        said = {each.name: each for each in tree.body if isinstance(each, (ast.ClassDef, ast.FunctionDef))}
        said_names = set(said) | {each.target.id for each in tree.body if isinstance(each, ast.AnnAssign)}
        self.assertEqual(set(ist.__all__) - said_names, set())
        for name, stub in said.items():
            if name.startswith("_"):
                continue
            real = getattr(ist, name)
            if isinstance(stub, ast.FunctionDef):
                self.assertEqual(self.parameters(stub), list(inspect.signature(real).parameters), name)
                continue
            for member in stub.body:
                if isinstance(member, ast.FunctionDef) and member.name not in ("__enter__", "__exit__"):
                    there = inspect.getattr_static(real, member.name, None) or getattr(real, member.name, None)
                    if there is None:  # set by __init__
                        self.assertIn(f"self.{member.name}", inspect.getsource(real), f"{name}.{member.name}")
                    elif inspect.isfunction(there):
                        self.assertEqual(self.parameters(member), list(inspect.signature(there).parameters), f"{name}.{member.name}")

    @staticmethod
    def parameters(function):
        a = function.args
        names = [each.arg for each in [*a.posonlyargs, *a.args, *a.kwonlyargs]]
        return names + ([a.kwarg.arg] if a.kwarg else [])


if __name__ == "__main__":
    assert sys.version_info >= (3, 9)
    unittest.main()
