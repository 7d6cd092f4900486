"""Bad input of every function is an exception that says what to do, and never a crash."""

import copy
import os
import pickle
import subprocess
import sys
import unittest
import warnings

import numpy as np
from support import BOX_FACES, Refusals, box, folder, pose_of, unaligned

import ist

VERTICES, FACES = box([0, 0, 0], [2, 2, 2])
EYE = np.eye(4)


class Misuse(Refusals):
    def setUp(self):
        self.tree = ist.build((VERTICES, FACES), 0.5)
        self.query = ist.Query(self.tree, self.tree)


class Names(Misuse):
    """An error of the library begins with the function of this package that was called."""

    def begins(self, name, call, *arguments, **options):
        text = str(self.refuses(ist.Error, "", call, *arguments, **options))
        self.assertTrue(text.startswith(name + ": "), text)
        self.assertNotIn("ist_", text)

    def test_functions_methods_and_classes(self):
        apart = ist.build((VERTICES, FACES), 0.5, keep_triangles=False)
        self.begins("ist.build", ist.build, (VERTICES * np.nan, FACES), 0.5)
        self.begins("ist.load", ist.load, "/none.ist")
        self.begins("ist.read_mesh", ist.read_mesh, "/none.stl")
        self.begins("ist.Query", ist.Query, self.tree, self.tree, target="none")
        self.begins("Query.intersects", self.query.intersects, EYE * 2)
        self.begins("Query.penetration", self.query.penetration, EYE * 2, 0.1)
        self.begins("Query.triangle_pairs", ist.Query(apart, apart).triangle_pairs, EYE)
        self.begins("ist.signed_distance", ist.signed_distance, apart, [[0, 0, 0]])
        self.begins("ist.Servo", ist.Servo, "/none.toml")
        self.begins("Query.near_pairs", self.query.near_pairs, EYE, float("nan"))
        self.begins("Query.near_pairs", self.query.near_pairs, EYE[:3], 1)
        self.begins("Query.distance", self.query.distance, EYE, "wide")
        self.begins("ist.distance_map", ist.distance_map, self.tree, self.tree, EYE[0])
        self.begins("World.add", ist.World().add, self.tree, EYE[:2])
        self.begins("ist.Sweep", ist.Sweep, "/none.toml", "/tmp")

    def test_wrong_types(self):
        for name, call in (("ist.Query", lambda: ist.Query(1, self.tree)), ("ist.build", lambda: ist.build((VERTICES, FACES), progress=1))):
            self.assertTrue(str(self.refuses(TypeError, "", call)).startswith(name + ": "))

    def test_a_library_that_lacks_functions(self):
        engine = os.path.join(os.path.dirname(os.environ.get("IST_LIBRARY", "")), "libist.so.0")
        if not os.path.exists(engine):
            self.skipTest("libist.so.0 is not beside the library")
        run = subprocess.run(
            [sys.executable, "-c", "import ist"], env={**os.environ, "IST_LIBRARY": engine}, stderr=subprocess.PIPE, text=True
        )
        self.assertIn("name libist_loop.so.0 in IST_LIBRARY", run.stderr)


class Meshes(Misuse):
    def builds(self, words, mesh, voxel_size=0.5, **options):
        return self.refuses(ist.InputError, words, ist.build, mesh, voxel_size, **options)

    def test_shapes_and_dtypes(self):
        self.builds(["vertices", "(8, 2)"], (VERTICES[:, :2], FACES))
        self.builds(["vertices", "shape"], (VERTICES.ravel(), FACES))
        self.builds(["faces", "(12, 2)"], (VERTICES, FACES[:, :2]))
        self.builds(["faces", "float64"], (VERTICES, FACES.astype(float)))
        self.builds(["faces", "bool"], (VERTICES, FACES > 0))
        self.builds(["vertices", "numbers"], (np.array([["a", "b", "c"]]), FACES))
        self.builds(["vertices", "numbers"], ([[1, 2], [3]], FACES))
        self.builds(["faces", "(N, 3)"], (VERTICES, [[0, 1, 2], [0, 1]]))
        self.builds("3 parts", (VERTICES, FACES, FACES))

    def test_indices(self):
        for bad in (-1, 2**32, 2**63 - 1):
            faces = FACES.astype(np.int64)
            faces[5, 1] = bad
            self.builds(["faces[5]", str(bad)], (VERTICES, faces))
        faces = FACES.astype(np.uint64)
        faces[3, 0] = 2**64 - 1
        self.builds("faces[3]", (VERTICES, faces))
        faces = FACES.copy()
        faces[7, 2] = 8
        self.assertEqual(self.builds(["triangle 7", "vertex"], (VERTICES, faces)).name, "mesh-bad-index")

    def test_content(self):
        vertices = VERTICES.copy()
        vertices[4, 1] = np.nan
        self.assertEqual(self.builds("vertex 4", (vertices, FACES)).name, "mesh-not-finite")
        self.builds("triangle", (VERTICES, np.empty((0, 3), int)))
        self.builds("vert", (np.empty((0, 3)), np.empty((0, 3), int)))
        self.assertEqual(self.builds("extent", (VERTICES * 0, FACES)).name, "mesh-extent")
        self.assertEqual(self.builds("extent", (VERTICES * 1e20, FACES)).name, "mesh-extent")

    def test_options(self):
        for size in (-1, np.inf):
            self.builds("voxel size", (VERTICES, FACES), size)
        for words in ({"keep_triangles": False}, {"proximity": True}):
            self.builds("give a voxel size", (VERTICES, FACES), 0, **words)
        self.builds("voxel_size", (VERTICES, FACES), np.nan)
        self.builds("voxel_size", (VERTICES, FACES), "small")
        self.builds(["spheres", "tight"], (VERTICES, FACES), spheres="round")
        self.builds("max_memory", (VERTICES, FACES), max_memory=-1)
        self.builds("max_memory", (VERTICES, FACES), max_memory=0)
        self.builds("max_memory", (VERTICES, FACES), max_memory=2**64)
        self.refuses(ist.MemoryLimitError, "memory", ist.build, (VERTICES, FACES), 0.001, max_memory=1 << 20)
        self.assertTrue(issubclass(ist.MemoryLimitError, MemoryError) and issubclass(ist.InputError, ValueError))
        self.refuses(TypeError, "progress", ist.build, (VERTICES, FACES), 0.5, progress=3)

    def test_objects_that_are_no_mesh(self):
        self.builds(["int", "vertices and faces"], 7)
        self.builds("NoneType", None)
        self.builds("dict", {"vertices": VERTICES, "faces": FACES})

    def test_files(self):
        place = folder(self)
        missing = os.path.join(place, "missing.stl")
        error = self.refuses(ist.FileError, "missing.stl", ist.build, missing, 0.5)
        self.assertIsInstance(error, OSError)
        self.refuses(ist.FileError, "missing.stl", ist.read_mesh, missing)
        empty = os.path.join(place, "empty.stl")
        with open(empty, "wb") as file:
            file.write(b"nothing of use")
        self.refuses(ist.InputError, "empty.stl", ist.read_mesh, empty)
        self.refuses(ist.InputError, "empty.stl", ist.load, empty)
        tree = os.path.join(place, "tree.ist")
        self.tree.save(tree)
        for read in (ist.read_mesh, ist.build):
            self.refuses(ist.InputError, ["tree.ist", "is a tree of IST", "ist.load"], read, tree)
        self.refuses(ist.InputError, "zero", ist.read_mesh, "a\0b.stl")
        self.refuses(TypeError, "", ist.read_mesh, 5)
        self.refuses(ist.FileError, "folder", self.tree.save, os.path.join(place, "no", "folder.ist"))

    def test_jaws(self):
        for seed in (-1, 2**64, 1.5, "one"):
            self.refuses(ist.InputError, "seed", ist.jaws, seed)


class Trees(Misuse):
    def test_damaged_pickles(self):
        content = self.tree.to_bytes()
        for at in range(0, len(content), max(1, len(content) // 60)):
            damaged = bytearray(content)
            damaged[at] ^= 0x10
            self.refuses(ist.InputError, "", ist.load, bytes(damaged))
            self.refuses(ist.InputError, "", pickle.loads, pickle.dumps(self.tree).replace(content, bytes(damaged)))
        for length in (0, 7, 31, len(content) - 1):
            self.refuses(ist.InputError, "", ist.load, content[:length])
        self.refuses(ist.InputError, "", ist.load, content + b"\0")
        self.refuses(TypeError, "", ist.load, None)

    def test_a_tree_without_triangles(self):
        bare = ist.build((VERTICES, FACES), 0.5, keep_triangles=False)
        self.assertEqual(self.refuses(ist.InputError, "triangles", lambda: bare.vertices).name, "triangles-missing")
        query = ist.Query(bare, self.tree)
        self.assertIsNone(query.intersects(EYE))
        self.refuses(ist.InputError, "triangles", query.triangle_pairs, EYE)
        self.refuses(ist.InputError, "triangles", query.near_pairs, EYE, 1)
        self.refuses(ist.InputError, "triangles", query.near_parts, EYE, (0, 0), 1)
        self.refuses(ist.InputError, "triangles", query.penetration, EYE, 0.1)
        self.refuses(ist.InputError, "triangles", query.occlusion, EYE)
        self.refuses(ist.InputError, "triangles", query.rows, EYE[None], want=["penetration"])
        self.refuses(ist.InputError, "triangles", ist.signed_distance, bare, [[0, 0, 0]])
        self.refuses(ist.InputError, "build both trees with them", query.triangle_pairs, EYE)
        self.refuses(ist.InputError, "created without contacts", ist.Query(bare, bare, contacts=-1).contacts, EYE)

    def test_other_objects(self):
        for other in (self.query, (VERTICES, FACES), None):
            for call in (lambda: ist.signed_distance(other, [[0, 0, 0]]), lambda: ist.distance_map(other, self.tree),
                         lambda: ist.distance_map(self.tree, other), lambda: ist.Query(self.tree, other)):
                self.refuses(TypeError, "pass an ist.Tree", call)
        for call in (lambda: copy.copy(self.query), lambda: copy.deepcopy(self.query), lambda: pickle.dumps(self.query)):
            self.refuses(TypeError, "neither copied nor pickled", call)

    def test_freed_objects(self):
        query = ist.Query(self.tree, self.tree)
        self.tree.free()
        self.tree.free()
        self.assertIs(query.intersects(EYE), True)  # a query keeps its trees alive
        for call in (self.tree.to_bytes, lambda: self.tree.vertices, lambda: self.tree.leaf_centres, lambda: ist.Query(self.tree, self.tree),
                     lambda: ist.signed_distance(self.tree, [[0, 0, 0]])):
            self.refuses(ist.FreedError, "freed", call)
        self.assertIn("freed", repr(self.tree))
        with query as same:
            same.free()
        for call in (query.forget, lambda: query.intersects(EYE), lambda: query.rows(EYE[None]), lambda: query.distance(EYE)):  # noqa: F821
            self.refuses(ist.FreedError, "freed", call)
        del query, same  # which is why flake8 takes query for undefined in the lambdas above


class Queries(Misuse):
    def test_poses(self):
        verbs = [self.query.intersects, self.query.leaf_pairs, self.query.contacts, self.query.distance, self.query.triangle_pairs,
                 self.query.occlusion, lambda pose: ist.occlusion(self.tree, self.tree, pose),
                 lambda pose: ist.distance_map(self.tree, self.tree, pose), lambda pose: self.query.penetration(pose, 0.1),
                 lambda pose: self.query.near_pairs(pose, 0.1), lambda pose: self.query.near_parts(pose, (0, 0), 0.1),
                 lambda pose: self.query.first_contact(pose, EYE, 0.1), lambda pose: self.query.first_contact(EYE, pose, 0.1),
                 self.query.settle, self.query.escape]
        mirrored, scaled, nan, row = EYE.copy(), 2 * EYE, EYE.copy(), EYE.copy()
        mirrored[0, 0], nan[1, 3], row[3, 0] = -1, np.nan, 1
        scaled[3, 3] = 1
        transposed = pose_of([0, 0, 1], 0.5, [1, 2, 3]).T
        for verb in verbs:
            for pose in (mirrored, scaled, nan, row, transposed, np.full((4, 4), np.inf)):
                self.assertEqual(self.refuses(ist.InputError, "rigid motion", verb, pose).name, "pose-invalid")
            for pose in (EYE[:3], EYE[None], 5, "pose", [[1, 2], [3]], EYE.astype(complex), [[10**400] * 4] * 4):
                self.refuses(ist.InputError, "", verb, pose)
        self.assertIs(self.query.intersects(EYE), True)  # and goes on

    def test_poses_of_other_dtypes_and_layouts_are_taken(self):
        pose = pose_of([0, 0, 1], 0.5, [1.9, 0.2, 0.1])
        expected = self.query.distance(pose, 1e-6)
        for other in (pose.tolist(), np.asfortranarray(pose), pose.astype(">f8"), np.stack([pose, pose])[1], pose.astype(object)):
            self.assertEqual(self.query.distance(other, 1e-6)[:2], expected[:2])
        self.assertIs(self.query.intersects(np.eye(4, dtype=int)), True)

    def test_arrays_that_are_not_aligned_are_copied(self):
        from ist._arrays import floats, indices

        pose = pose_of([0, 0, 1], 0.5, [1.9, 0.2, 0.1])
        points, faces = unaligned(VERTICES), unaligned(FACES.astype(np.uint32))
        self.assertFalse(points.flags.aligned or faces.flags.aligned)
        for taken, given in ((floats(points, (None, 3), "points"), points), (indices(faces, "faces"), faces)):
            self.assertTrue(taken.flags.aligned and taken.flags.c_contiguous)
            np.testing.assert_array_equal(taken, given)
        self.assertIs(floats(VERTICES, (None, 3), "points"), VERTICES)
        self.assertEqual(self.query.distance(unaligned(pose), 1e-6)[:2], self.query.distance(pose, 1e-6)[:2])
        for vertices in (points, unaligned(VERTICES.astype(np.float32))):
            self.assertEqual(ist.build((vertices, faces), 0.5).to_bytes(), self.tree.to_bytes())

    def test_arrays_begin_where_they_say(self):
        from ist._arrays import address, asked, behind_the_head

        class Named(np.ndarray):
            pass

        grown = np.empty(5, ist.CONTACT)
        grown.resize(5000, refcheck=False)
        for array in (VERTICES, VERTICES[3:, 1:], VERTICES.T, np.empty(0), np.empty(7, ist.ROW)[2:], grown, np.array(1.5), VERTICES.view(Named),
                      np.frombuffer(b"12345678", "u1"), np.memmap(os.path.join(folder(self), "map"), float, "w+", shape=9)):
            self.assertEqual(address(array), array.ctypes.data)
            self.assertEqual(asked(array), array.ctypes.data)
        self.assertIs(address, behind_the_head)  # by Debian's Python

    def test_an_array_that_was_good_is_looked_at_again(self):
        from ist._arrays import Room

        room, out = Room(ist.LEAF_PAIR), np.empty(6, ist.LEAF_PAIR)

        def takes(array):
            room.take(array)
            self.assertEqual((room.place.value, room.length.value), (array.ctypes.data, len(array)))

        def spoiled(spoil, array=None):
            array = np.empty(6, ist.LEAF_PAIR) if array is None else array
            takes(array)
            takes(array)
            spoil(array)
            self.refuses(ist.InputError, "out", room.take, array)

        for length in (6, 6, 9, 0, 6):
            takes(np.empty(length, ist.LEAF_PAIR))  # most of them at the id of the one before
        takes(out)
        takes(out)
        for length in (6000, 6, 100_000):
            out.resize(length, refcheck=False)
            takes(out)
        spoiled(lambda array: array.setflags(write=False))
        spoiled(lambda array: setattr(array, "dtype", "u8"))
        spoiled(lambda array: setattr(array, "dtype", ist.TRIANGLE_PAIR.newbyteorder()))
        spoiled(lambda array: setattr(array, "shape", (6, 1)))
        spoiled(lambda array: setattr(array, "shape", (2, 3)))
        memory = np.zeros(200, "u1")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # NumPy advises against it
            spoiled(lambda array: setattr(array, "data", memory[4 + -memory.ctypes.data % 8 :].data[:48]))
        takes(out)
        self.refuses(ist.InputError, "out", room.take, out.tolist())
        takes(np.empty(6, ist.LEAF_PAIR).view(np.recarray))

    def test_members_are_read_from_their_structs(self):
        from ist import _query as records

        for read, struct, names in (
            (records.read_leaf_pairs, records.QueryResult, "leaf_pairs written sphere_tests complete truncated level "
             "distance_known distance_lower distance_upper resolution rotation_error"),
            (records.read_contacts, records.QueryResult, "leaf_pairs contacts written sphere_tests complete rotation_error"),
            (records.read_distance, records.DistanceResult, "lower upper sphere_tests complete nearest_known narrowest rotation_error"),
            (records.read_triangle_pairs, records.TrianglePairsResult, "pairs written sphere_tests truncated complete rotation_error"),
            (records.read_near_pairs, records.NearPairsResult,
             "pairs written sphere_tests truncated complete found pad rotation_error"),
        ):
            flags = ("complete", "truncated", "distance_known", "nearest_known")
            for value in (0, 1):
                members = {name: value if name in flags else 3 + i for i, name in enumerate(names.split())}
                found = read(struct(**members))
                self.assertEqual(found, tuple(members.values()))
                for name, each in zip(members, found):
                    self.assertEqual(type(each) is bool, name in flags, name)

    def test_a_question_asked_twice_has_one_time_limit(self):
        from ist._arrays import budget_of
        from ist._c import QueryResult

        budget, limit = budget_of(0, 60.0)
        given, found = [], QueryResult(leaf_pairs=10_000)

        def ask(_query, _pose, _limit, _place, length, _found):
            given.append((length.value, budget.nanoseconds))
            return 0

        array = self.query._room(ist.LEAF_PAIR, None, budget, ask, limit, found, "leaf_pairs")
        self.assertEqual(len(array), 10_000)
        (few, whole), (enough, rest) = given
        self.assertEqual((few, enough, whole), (4096, 10_000, 60_000_000_000))
        self.assertLess(rest, whole)
        self.assertGreater(rest, 0)

    def test_arrays_for_answers(self):
        wrong = [np.empty(5, ist.CONTACT), np.empty((5, 1), ist.LEAF_PAIR), np.empty(10, ist.LEAF_PAIR)[::2], [1, 2], "text",
                 np.empty(5, ist.LEAF_PAIR).view("u1"), np.zeros(41, "u1")[1:].view(ist.LEAF_PAIR)]
        frozen = np.empty(5, ist.LEAF_PAIR)
        frozen.setflags(write=False)
        for out in [*wrong, frozen]:
            self.refuses(ist.InputError, "out", self.query.leaf_pairs, EYE, out=out)
        good = np.empty(5, ist.LEAF_PAIR)
        self.query.leaf_pairs(EYE, out=good)
        good.setflags(write=False)
        self.refuses(ist.InputError, "out", self.query.leaf_pairs, EYE, out=good)
        grown = np.empty(5, ist.LEAF_PAIR)
        self.query.leaf_pairs(EYE, out=grown)
        grown.resize(10_000, refcheck=False)  # its memory is elsewhere now
        self.assertEqual(self.query.leaf_pairs(EYE, out=grown).pairs.tolist(), self.query.leaf_pairs(EYE).pairs.tolist())
        self.refuses(ist.InputError, "out", self.query.contacts, EYE, out=np.empty(5, ist.LEAF_PAIR))
        self.refuses(ist.InputError, "out", self.query.triangle_pairs, EYE, out=np.empty(5, ist.CONTACT))
        self.refuses(ist.InputError, "out", self.query.near_pairs, EYE, 0.1, out=np.empty(5, ist.TRIANGLE_PAIR))
        self.refuses(ist.InputError, ["out", "2"], self.query.rows, np.stack([EYE, EYE]), out=np.empty(3, ist.ROW))
        self.refuses(ist.InputError, "out", ist.signed_distance, self.tree, [[0, 0, 0]], out=np.empty(2, ist.SURFACE_DISTANCE))
        self.assertEqual(len(self.query.leaf_pairs(EYE, out=np.empty(0, ist.LEAF_PAIR)).pairs), 0)

    def test_numbers(self):
        for tests in (-1, 2**64, 1.5, "many", None):
            self.refuses(ist.InputError, "tests", self.query.intersects, EYE, tests=tests)
        for seconds in (-1, np.nan, "soon"):
            self.refuses(ist.InputError, "seconds", self.query.intersects, EYE, seconds=seconds)
        for margin in (-1, np.nan, np.inf, "wide", 10**400):
            self.refuses(ist.InputError, "margin", self.query.near_pairs, EYE, margin)
            self.refuses(ist.InputError, "margin", self.query.near_parts, EYE, (0, 0), margin)
        for triangles in (None, 7, (1,), (1, 2, 3), (-1, 0), (0, 2**32), (0.5, 0), ("a", 0)):
            self.refuses(ist.InputError, "triangles", self.query.near_parts, EYE, triangles, 1)
        self.refuses(ist.InputError, "the meshes have", self.query.near_parts, EYE, (0, 2**32 - 1), 1)
        self.refuses(ist.InputError, "near_pairs", ist.Query, self.tree, self.tree, near_pairs=2**27)
        for tolerance in (-1, np.nan, "fine", -(10**400)):
            self.refuses(ist.InputError, "tolerance", self.query.distance, EYE, tolerance)
            self.refuses(ist.InputError, "tolerance", self.query.penetration, EYE, tolerance)
            self.refuses(ist.InputError, "tolerance", self.query.first_contact, EYE, EYE, tolerance)
            self.refuses(ist.InputError, "tolerance", self.query.escape, EYE, tolerance)
            self.refuses(ist.InputError, "longest", self.query.escape, EYE, longest=tolerance)
            self.refuses(ist.InputError, "tolerance", self.query.rows, EYE[None], tolerance=tolerance)
        self.refuses(ist.InputError, "most", self.query.leaf_pairs, EYE, most=-1)
        self.assertTrue(self.query.leaf_pairs(EYE, seconds=np.inf).complete)

    def test_options(self):
        make = ist.Query
        tree = self.tree
        self.refuses(TypeError, "fixed", make, (VERTICES, FACES), tree)
        self.refuses(TypeError, "moving", make, tree, None)
        self.refuses(ist.InputError, "workers", make, tree, tree, workers=3)
        self.refuses(ist.InputError, "contacts", make, tree, tree, contacts=0)
        self.refuses(ist.InputError, "contacts", make, tree, tree, contacts=5000)
        for contacts in (-2, 1.5, "many", None):
            self.refuses(ist.InputError, "contacts", make, tree, tree, contacts=contacts)
        for margin in (3, -1, np.nan, np.inf, "far", None):
            self.refuses(ist.InputError, "margin", make, tree, tree, margin=margin)
        self.refuses(ist.InputError, "front_pairs", make, tree, tree, front_pairs=-1)
        self.refuses(ist.InputError, "spheres", make, tree, tree, spheres="round")
        self.assertEqual(self.refuses(ist.InputError, "", make, tree, tree, target="abacus").name, "target-missing")
        simple = ist.build((VERTICES, FACES), 0.5, spheres="simple")
        self.assertEqual(self.refuses(ist.InputError, "", make, simple, tree, spheres="slab").name, "policy-missing")
        self.assertEqual(self.refuses(ist.InputError, "contacts", make(tree, tree, contacts=-1).contacts, EYE).name, "not-prepared")

    def test_rows(self):
        rows = self.query.rows
        self.refuses(ist.InputError, "poses", rows, EYE)
        self.refuses(ist.InputError, "poses", rows, np.empty((3, 4, 3)))
        for want in ([], ["touch"], "distance", ["intersects", "depth"]):
            self.refuses(ist.InputError, "want", rows, EYE[None], want=want)
        self.refuses(ist.InputError, "did you mean 'distance'?", rows, EYE[None], want=["distances"])
        self.refuses(ist.InputError, "threads", rows, EYE[None], threads=-1)
        self.refuses(ist.InputError, "threads", rows, EYE[None], threads=5000)
        self.refuses(ist.InputError, "stiffness", rows, EYE[None], stiffness=np.inf)
        self.assertEqual(rows(np.zeros((1, 4, 4)))["status"].tolist(), [120])

    def test_measures(self):
        self.refuses(ist.InputError, "reach", self.query.occlusion, EYE, reach=0)
        self.refuses(ist.InputError, "reach", self.query.occlusion, EYE, reach=np.nan)
        self.refuses(ist.InputError, "contact", self.query.occlusion, EYE, contact=-0.1)
        self.refuses(ist.InputError, "limits", self.query.occlusion, EYE, limits=0.5)
        self.refuses(ist.InputError, "points", ist.signed_distance, self.tree, [[0, 0]])
        self.refuses(ist.InputError, "", ist.signed_distance, self.tree, [[0, 0, np.nan]])
        self.refuses(ist.InputError, "reach", ist.signed_distance, self.tree, [[0, 0, 0]], reach=-1)
        for reach in (-1, 0, np.nan, "far", None):
            self.refuses(ist.InputError, "reach", ist.distance_map, self.tree, self.tree, reach=reach)
        corners, wrong = len(VERTICES), np.empty(len(VERTICES), ist.SURFACE_DISTANCE)
        wrong.setflags(write=False)
        for out in (np.empty(corners + 1, ist.SURFACE_DISTANCE), np.empty(corners, ist.LEAF_PAIR), [1, 2], "text", wrong,
                    np.empty(2 * corners, ist.SURFACE_DISTANCE)[::2]):
            self.refuses(ist.InputError, "out", ist.distance_map, self.tree, self.tree, out=out)
        self.refuses(TypeError, "last", self.query.penetration, EYE, 0.1, last=(1, 2))


if __name__ == "__main__":
    assert BOX_FACES.shape == (12, 3)
    unittest.main()
