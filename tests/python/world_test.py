"""Worlds: the answers of queries at the poses of their pairs, and bad input."""

import threading
import unittest

import numpy as np
from support import Refusals, box, pose_of

import ist


def shift(*by):
    return pose_of([0, 0, 1], 0, by)


class Worlds(Refusals):
    """Three boxes in a row, each in the next, turned; and one far away."""

    def setUp(self):
        self.trees = [ist.build(box([-1, -1, -1], [1, 1, 1 + 0.1 * k]), voxel_size=0.25) for k in range(4)]
        self.poses = [pose_of([0.3, 1, 0.2], 0.4 * k, [1.6 * k, 0.2, 0]) for k in range(3)] + [shift(0, 60, 0)]
        self.world = ist.World(reach=0.1)
        for k, (tree, pose) in enumerate(zip(self.trees, self.poses)):
            self.assertEqual(self.world.add(tree, pose, f"box {k}"), k)

    def query(self, row):
        return ist.Query(self.trees[row["a"]], self.trees[row["b"]])

    def test_answers_are_those_of_queries(self):
        self.world.reserve()
        touch, leaves, met = self.world.intersects(), self.world.leaf_pairs(), self.world.triangle_pairs()
        felt, apart = self.world.contacts(), self.world.distances(0.01)
        self.assertTrue(touch.complete and not touch.truncated)
        self.assertEqual([(row["a"], row["b"]) for row in touch.pairs], [(0, 1), (0, 2), (1, 2)])
        for k, row in enumerate(touch.pairs):
            query, pose = self.query(row), self.world.pose_of(row["a"], row["b"])
            expected = np.linalg.inv(self.poses[row["a"]]) @ self.poses[row["b"]]
            np.testing.assert_allclose(pose, expected, atol=1e-12)
            self.assertEqual(row["status"], 0)
            self.assertEqual({ist.YES: True, ist.NO: False, ist.NEAR: None}[row["answer"]], query.intersects(pose))
            self.assertEqual(leaves.found_of(leaves.pairs[k]).tolist(), query.leaf_pairs(pose).pairs.tolist())
            self.assertEqual(met.found_of(met.pairs[k]).tolist(), query.triangle_pairs(pose).pairs.tolist())
            contacts, wanted = self.world.contacts_of(row["b"], row["a"]), query.contacts(pose)
            self.assertEqual(contacts.contacts.tobytes(), wanted.contacts.tobytes())
            self.assertEqual(contacts.sums.tobytes(), wanted.sums.tobytes())
            self.assertEqual((contacts.complete, contacts.leaf_pairs), (True, wanted.leaf_pairs))
            error = max(ist.rotation_error(self.poses[row[body]]) for body in "ab")
            self.assertEqual((row["rotation_error"], contacts.rotation_error), (error, error))
            self.assertEqual(contacts.sphere_tests, felt.pairs[k]["sphere_tests"])
            self.assertGreater(contacts.sphere_tests, 0)
            self.assertEqual(felt.pairs[k]["contacts"], len(wanted.contacts))
            distance = query.distance(pose, 0.01)
            self.assertLessEqual(apart.pairs[k]["distance_lower"], distance.upper)
            self.assertGreaterEqual(apart.pairs[k]["distance_upper"], distance.lower)
        self.assertEqual(touch.pairs["answer"].tolist(), [ist.YES, ist.NO, ist.YES])
        self.assertGreater(leaves.pairs["found"].sum(), 100)

    def test_contacts_that_a_limit_ended_say_so(self):
        self.world.reserve()
        whole, all_of = self.world.contacts().pairs, self.world.contacts_of(0, 1)
        for out in (None, np.zeros(3, ist.WORLD_PAIR), np.zeros(1, ist.WORLD_PAIR)):
            row = self.world.contacts(tests=int(whole["sphere_tests"][0]) // 2, out=out).pairs[0]
            found = self.world.contacts_of(1, 0)
            self.assertEqual((row["complete"], found.complete), (0, False))
            self.assertEqual((row["sphere_tests"], row["found"]), (found.sphere_tests, found.leaf_pairs))
            self.assertLess(found.leaf_pairs, all_of.leaf_pairs)
            self.assertLess(found.area, all_of.area)
        # Also of a pair that `out` had no room for, and whatever the caller does to its rows.
        out = np.zeros(1, ist.WORLD_PAIR)
        self.world.contacts(tests=int(whole["sphere_tests"].sum()) - 2, out=out)
        out["complete"], out["sphere_tests"] = 0, 7
        self.assertTrue(self.world.contacts_of(0, 1).complete)
        self.assertEqual(self.world.contacts_of(0, 1).sphere_tests, whole["sphere_tests"][0])
        self.assertFalse(self.world.contacts_of(1, 2).complete)

    def test_least_distance(self):
        self.world.reserve()
        self.assertEqual(self.world.distance(0.01)[:4], (0, 0, True, (0, 1)))
        self.world.set_pose(1, shift(0, 30, 0))
        least = self.world.distance(0.001)
        self.assertEqual(least.nearest, (0, 2))
        query = self.query({"a": 0, "b": 2})
        wanted = query.distance(self.world.pose_of(0, 2), 0.001)
        self.assertLessEqual(abs(least.lower - wanted.lower), 0.002)
        self.assertLessEqual(least.upper - least.lower, 0.001)
        self.assertFalse(self.world.distance(0.0, tests=1).complete)

    # Turns body 0, so that its coordinates are not those of the world.
    def turn(self):
        self.poses[0] = pose_of([1, 0.5, 0.1], 0.7, [0, 0.2, 0])
        self.world.set_pose(0, self.poses[0])

    # Compares nearest points in the world with the points of a query of bodies `a` and `b`, in coordinates of `a`.
    def same_points(self, a, b, tolerance, found, triangles):
        wanted = self.query({"a": a, "b": b}).distance(self.world.pose_of(a, b), tolerance)
        pose = self.poses[a]
        for name in ("nearest_fixed", "nearest_moving"):
            np.testing.assert_allclose(found[name], pose[:3, :3] @ getattr(wanted, name) + pose[:3, 3], rtol=0, atol=1e-12)
        np.testing.assert_allclose(found["direction"], pose[:3, :3] @ wanted.direction, rtol=0, atol=1e-12)
        self.assertEqual(tuple(triangles), wanted.triangles)

    def test_distances_have_the_nearest_points(self):
        self.world.reserve()
        self.turn()
        self.assertFalse(self.world.intersects().pairs["nearest_known"].any())
        self.world.forget()
        rows = self.world.distances(0.01).pairs
        for row in rows:
            self.assertEqual(row["nearest_known"], 1)
            self.same_points(row["a"], row["b"], 0.01, row, row["nearest_triangles"])
            way = row["nearest_moving"] - row["nearest_fixed"]
            length = np.linalg.norm(way)
            self.assertTrue(row["distance_lower"] - 1e-12 <= length <= row["distance_upper"] + 1e-12)
            np.testing.assert_allclose(row["direction"] * length, way, rtol=0, atol=1e-12)
        self.assertGreater(rows["distance_lower"][1], 0.1)
        for row in rows[[0, 2]]:  # they intersect
            self.assertEqual(row["distance_upper"], 0)
            self.assertEqual(row["nearest_fixed"].tolist(), row["nearest_moving"].tolist())
            self.assertEqual(row["direction"].tolist(), [0, 0, 0])

    def test_the_least_distance_has_the_nearest_points(self):
        self.world.reserve()
        self.turn()
        self.world.set_pose(1, shift(0, 30, 0))
        least = self.world.distance(0.001)
        self.assertEqual(least.nearest, (0, 2))
        self.same_points(0, 2, 0.001, least._asdict(), least.triangles)
        length = np.linalg.norm(least.nearest_moving - least.nearest_fixed)
        self.assertTrue(least.lower - 1e-12 <= length <= least.upper + 1e-12)
        unasked = self.world.distance(1000)  # the roots are enough
        self.assertEqual((unasked.nearest_fixed, unasked.nearest_moving, unasked.direction, unasked.triangles), (None,) * 4)

    def test_a_pose_that_is_none(self):
        self.world.reserve()
        with self.assertRaises(ist.InputError) as raised:
            self.world.set_pose(1, np.full((4, 4), np.nan))
        self.assertEqual(raised.exception.code, ist.POSE_INVALID)
        found = self.world.intersects()
        self.assertFalse(found.complete)
        of_1 = (found.pairs["a"] == 1) | (found.pairs["b"] == 1)
        self.assertEqual(of_1.sum(), 3)
        self.assertTrue((found.pairs["status"][of_1] == ist.POSE_INVALID).all())
        self.assertTrue((found.pairs["status"][~of_1] == 0).all())
        self.assertTrue(self.world.distance(0.01).pose_missing)

    def test_memory(self):
        self.assertEqual(self.world.nbytes, 0)
        one = self.world.bytes_needed(1)
        self.assertLess(one, self.world.bytes_needed())
        self.world.ignore(0, 2)
        self.world.reserve(1)
        self.assertEqual(self.world.nbytes, one)
        found = self.world.intersects()
        self.assertEqual((found.count, len(found.pairs), found.truncated, found.complete), (2, 1, True, False))
        self.world.reserve(found.count)
        found = self.world.intersects()
        self.assertEqual(found.pairs["answer"].tolist(), [ist.YES, ist.YES])
        self.assertTrue(found.complete and not found.truncated)
        small = ist.World(max_memory=100_000)
        for k in range(2):
            small.add(self.trees[k], name=f"box {k}")
        with self.assertRaises(ist.MemoryLimitError) as raised:
            small.reserve()
        self.assertIn("1 near pair", str(raised.exception))

    def test_answers_do_not_depend_on_threads(self):
        several = ist.World(reach=0.1, threads=3)
        for tree, pose in zip(self.trees, self.poses):
            several.add(tree, pose)
        for world in (self.world, several):
            world.reserve()
        for question in ("intersects", "contacts", "distance"):
            self.assertEqual(several.ask(question).pairs.tobytes(), self.world.ask(question).pairs.tobytes())

    def test_a_distance_has_the_name_that_a_query_gives_it(self):
        self.world.reserve()
        named = self.world.ask("distance", tolerance=0.1).pairs.tobytes()
        self.world.forget()
        self.assertEqual(self.world.ask("distances", tolerance=0.1).pairs.tobytes(), named)

    def test_arrays_are_filled_in_place(self):
        self.world.reserve()
        rows, leaves = np.zeros(2, ist.WORLD_PAIR), np.zeros(10, ist.LEAF_PAIR)
        found = self.world.leaf_pairs(into=leaves, out=rows)
        self.assertIs(found.pairs.base, rows)
        self.assertTrue(found.truncated and found.count == 3 and len(found.pairs) == 2)
        self.assertEqual(rows["written"].tolist(), [10, 0])
        self.assertEqual(rows["truncated"].tolist(), [1, 1 if rows["found"][1] else 0])
        self.assertEqual(len(self.world.contacts(out=rows).pairs), 2)
        contacts = np.zeros(1, ist.CONTACT)
        self.assertEqual(len(self.world.contacts_of(0, 1, out=contacts).contacts), 1)

    def test_bodies_have_names_and_trees(self):
        self.assertEqual(self.world.bodies, tuple(self.trees))
        self.assertEqual(self.world.names, ("box 0", "box 1", "box 2", "box 3"))
        self.assertEqual(repr(self.world), "<ist.World of 4 bodies>")
        self.world.free()
        self.assertEqual(repr(self.world), "<ist.World, freed>")
        with self.assertRaises(ist.FreedError):
            self.world.intersects()

    def test_misuse(self):
        def refuses(words, call, *arguments, **options):
            self.refuses(ist.InputError, words, call, *arguments, **options)

        refuses(["World.intersects: ", "call World.reserve"], self.world.intersects)
        with self.assertRaises(TypeError):
            self.world.add(7)
        refuses(["pose", "(4, 4)"], self.world.add, self.trees[0], np.eye(3))
        refuses(["body 9"], self.world.ignore, 0, 9)
        refuses(["'box 1'"], self.world.ignore, 1, 1)
        refuses(["a is -1"], self.world.ignore, -1, 1)
        refuses(["near_pairs is -1"], self.world.reserve, -1)
        refuses(["near_pairs"], self.world.bytes_needed, [(0, 1)])
        refuses(["reach"], ist.World, reach=-1)
        refuses(["contacts"], ist.World, contacts=0)
        refuses(["threads"], ist.World, threads=0)
        self.world.reserve()
        refuses(["number"], self.world.set_pose, 8, np.eye(4))
        refuses(["out"], self.world.intersects, out=np.zeros(3))
        refuses(["out"], self.world.leaf_pairs, into=np.zeros(3, ist.CONTACT))
        refuses(["question", "touches", "intersects"], self.world.ask, "touches")
        refuses(["World.ask: question is 'distanc': did you mean 'distance'?"], self.world.ask, "distanc")
        refuses(["question is 7: pass one of near_pairs, "], self.world.ask, 7)
        refuses(["into", "distances"], self.world.ask, "distances", into=np.zeros(3, ist.LEAF_PAIR))
        refuses(["tolerance"], self.world.distance, -1)
        refuses(["tolerance"], self.world.distances, np.nan)
        refuses(["World.contacts_of: ", 'World.ask for "contacts"'], self.world.contacts_of, 0, 3)
        with self.assertRaises(TypeError):
            self.world.__reduce__()

    def test_every_verb_refuses_bad_poses(self):
        no_motions = [np.full((4, 4), bad) for bad in (0, np.nan, np.inf)] + [2 * np.eye(4), shift(1, 2, 3).T, -np.eye(4)]
        no_matrices = [np.eye(3), np.eye(4)[None], 5, "pose", [[1, 2], [3]], np.eye(4).astype(complex), [[10**400] * 4] * 4]
        self.world.reserve()
        for verb in (lambda pose: self.world.add(self.trees[0], pose), lambda pose: self.world.set_pose(1, pose)):
            for pose in no_motions:
                self.assertEqual(self.refuses(ist.InputError, "", verb, pose).name, "pose-invalid")
            for pose in no_matrices:
                self.refuses(ist.InputError, "pose", verb, pose)
        self.assertEqual(len(self.world.bodies), 4)
        self.world.set_pose(1, self.poses[1])
        self.assertTrue(self.world.intersects().complete)  # and goes on

    def test_every_verb_refuses_bad_numbers_and_arrays(self):
        self.world.reserve()
        world = self.world
        of_pairs = (world.intersects, world.contacts, world.distances, world.leaf_pairs, world.triangle_pairs)
        for verb in (*of_pairs, world.distance):
            for tests in (-1, 2**64, 1.5, "many", None):
                self.refuses(ist.InputError, "tests", verb, tests=tests)
            for seconds in (-1, np.nan, "soon", None):
                self.refuses(ist.InputError, "seconds", verb, seconds=seconds)
        wrong = [np.zeros(4, ist.LEAF_PAIR), np.zeros((4, 1), ist.WORLD_PAIR), np.zeros(8, ist.WORLD_PAIR)[::2], [1], "text", 7]
        frozen = np.zeros(4, ist.WORLD_PAIR)
        frozen.setflags(write=False)
        for verb in (*of_pairs, world.near_pairs):
            for out in (*wrong, frozen):
                self.refuses(ist.InputError, "out", verb, out=out)
        for verb in (world.leaf_pairs, world.triangle_pairs):
            for into in (*wrong[1:], np.zeros(4, ist.CONTACT), frozen):
                self.refuses(ist.InputError, "out", verb, into=into)
        world.contacts()
        for out in (*wrong, frozen, np.zeros(4, ist.WORLD_PAIR), np.zeros(65, "u1")[1:].view(ist.CONTACT)):
            self.refuses(ist.InputError, "out", world.contacts_of, 0, 1, out=out)
        for body in (-1, 2**32, 1.5, "upper", None, 9):
            for call in (lambda: world.set_pose(body, np.eye(4)), lambda: world.pose_of(0, body), lambda: world.ignore(body, 0),
                         lambda: world.contacts_of(0, body)):
                self.refuses(ist.InputError, "", call)
        for near_pairs in (-1, 2**64, 1.5, "pairs", [(0, 1)]):
            self.refuses(ist.InputError, "near_pairs", world.reserve, near_pairs)
            self.refuses(ist.InputError, "near_pairs", world.bytes_needed, near_pairs)
        for tolerance in (-1, np.nan, "fine", None):
            self.refuses(ist.InputError, "tolerance", world.distance, tolerance)
            self.refuses(ist.InputError, "tolerance", world.distances, tolerance)
        self.assertTrue(world.contacts_of(0, 1).complete)  # and goes on

    def test_bad_options(self):
        bad = {"reach": (-1, np.nan, np.inf, "far", None), "max_memory": (-1, 0, 2**64, 1.5, "much", None),
               "threads": (-1, 0, 17, 1.5, "all"), "pair_caches": (-1, 0, 2**64, 1.5), "contacts": (0, -2, 5000, 1.5, "many", None),
               "margin": (-1, np.nan, 3, "far"), "front_pairs": (-1, 2**64, "many"), "spheres": ("round", 3),
               "frontier_pairs": (-1, 2**64, "many"), "target": ("abacus", "\ud800")}
        for option, values in bad.items():
            for value in values:
                self.refuses(ist.InputError, "" if option == "target" else option, ist.World, **{option: value})
        self.assertEqual(ist.World().add(self.trees[0], name="\ud800"), 0)

    def test_a_second_thread_is_refused(self):
        self.world.reserve()
        seen = []

        def ask():
            try:
                self.world.intersects()
            except ist.BusyError as error:
                seen.append(error)

        with self.world._lock:
            thread = threading.Thread(target=ask)
            thread.start()
            thread.join()
        self.assertEqual(len(seen), 1)


if __name__ == "__main__":
    unittest.main()
