"""The package answers what the command answers, at poses that turn, and rows are the single calls bit by bit."""

import json
import os
import pickle
import unittest

import numpy as np
from support import JAW_POSES, Jaws, box, command_lines, folder, pose_of

import ist


def same_bits(a, b):
    return np.float64(a).tobytes() == np.float64(b).tobytes()


class Command(Jaws):
    """Beside the command, which reads the same trees and poses from files."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        import tempfile

        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.files = [os.path.join(cls.place.name, name) for name in ("upper.ist", "lower.ist")]
        cls.upper.save(cls.files[0])
        cls.lower.save(cls.files[1])
        poses = os.path.join(cls.place.name, "poses.json")
        with open(poses, "w", encoding="utf-8") as file:
            json.dump([{"pose": pose.T.ravel().tolist()} for pose in JAW_POSES], file)
        cls.lines = command_lines(
            "collide", *cls.files, "--poses", poses, "--json", "--distance", 0.001, "--depth", 0.01, "--exact"
        )

    def test_touch_distance_depth_and_counts(self):
        self.assertEqual(len(self.lines), len(JAW_POSES))
        touches = [line["touch"] for line in self.lines]
        self.assertEqual(set(touches), {"yes", "no"})
        for pose, line in zip(JAW_POSES, self.lines):
            self.query.forget()
            self.assertEqual(self.query.intersects(pose), {"yes": True, "no": False, "near": None}[line["touch"]])
            self.assertEqual(self.query.triangle_pairs(pose).count, line["triangle_pairs"])
            self.assertEqual(self.query.leaf_pairs(pose).count, line["leaf_pairs"])
            self.query.forget()
            distance = self.query.distance(pose, 0.001)
            self.assertLessEqual(distance.lower, line["distance_upper"])
            self.assertGreaterEqual(distance.upper, line["distance_lower"])
            for points in (line["nearest_fixed"], line["nearest_moving"]):
                self.assertEqual(len(points), 3)
            way = np.linalg.norm(np.subtract(line["nearest_moving"], line["nearest_fixed"]))
            self.assertTrue(line["distance_lower"] - 1e-12 <= way <= line["distance_upper"] + 1e-12)
            depth = self.query.penetration(pose, 0.01)
            self.assertTrue(same_bits(depth.lower, line["depth_lower"]) and same_bits(depth.upper, line["depth_upper"]))

    def test_trees_from_files_and_bytes_are_the_same(self):
        with open(self.files[0], "rb") as file:
            content = file.read()
        self.assertEqual(self.upper.to_bytes(), content)
        for tree in (ist.load(self.files[0]), ist.load(content), ist.load(memoryview(content)), pickle.loads(pickle.dumps(self.upper))):
            self.assertEqual(tree.to_bytes(), content)


class Comparison(unittest.TestCase):
    def test_motion_about_a_hinge(self):
        before, hinge = pose_of([0, 0, 1], 0.7, [1, 2, 3]), np.array([0.0, 80.0, -20.0])
        turn = pose_of([1, 0, 0], 0.02, [0, 0, 0])
        turn[:3, 3] = hinge - turn[:3, :3] @ hinge
        change = ist.motion_between(before, turn @ before, [3, -40, -60])
        self.assertAlmostEqual(change.angle, 0.02, places=12)
        np.testing.assert_allclose(change.rotation, [0.02, 0, 0], atol=1e-12)
        np.testing.assert_allclose(change.axis_point, [3, 80, -20], atol=1e-8)
        point = np.array([3, -40, -60, 1.0])
        np.testing.assert_allclose(change.translation, (turn @ point - point)[:3], atol=1e-11)
        still = ist.motion_between(before, before)
        self.assertIsNone(still.axis_point)
        self.assertEqual(still.about.tolist(), [0, 0, 0])

    def test_matches(self):
        before, after = [[0, 0, 0], [9, 0, 0], [20, 0, 0]], [[9.5, 0, 0], [0.25, 0, 0]]
        self.assertEqual(ist.match_contacts(before, after).tolist(), [1, 0, -1])
        self.assertEqual(ist.match_contacts(before, after, 0.3).tolist(), [1, -1, -1])
        teeth = ist.match_contacts(before, after, before_teeth=[16, 0, 0], after_teeth=[26, 17])
        self.assertEqual(teeth.tolist(), [-1, 0, -1])
        self.assertEqual(ist.match_contacts(np.empty((0, 3)), after).tolist(), [])

    def test_misuse(self):
        for words, arguments, options in (
            ("about", ("motion",), {"about": [1, 2]}),
            ("within", ("match", [[0, 0, 0]], [[0, 0, 0]], -1), {}),
            ("before", ("match", [[0, 0]], [[0, 0, 0]]), {}),
            ("before_teeth has 2", ("match", [[0, 0, 0]], [[0, 0, 0]]), {"before_teeth": [1, 2]}),
            ("after_teeth", ("match", [[0, 0, 0]], [[0, 0, 0]]), {"after_teeth": [-1]}),
            ("centre of contact 0", ("match", [[0, np.nan, 0]], [[0, 0, 0]]), {}),
        ):
            with self.subTest(words), self.assertRaisesRegex(ist.InputError, words):
                if arguments[0] == "motion":
                    ist.motion_between(np.eye(4), np.eye(4), **options)
                else:
                    ist.match_contacts(*arguments[1:], **options)


class Verbs(Jaws):
    def test_a_tree_keeps_the_frame_that_its_file_names(self):
        vertices, faces = box((1, 2, 3), (4, 6, 8))
        lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
        path = os.path.join(folder(self), "box.obj")
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(["# SPACE=LPS", *lines]))
        lps, ras = ist.build(path, 1), ist.build(path, 1, frame="ras")
        self.assertEqual((lps.frame, ras.frame), ("lps", "ras"))
        self.assertEqual(ist.build((vertices, faces), 1).frame, "unknown")
        self.assertEqual(sorted(map(tuple, ras.vertices)), sorted((-x, -y, z) for x, y, z in lps.vertices))
        with self.assertRaisesRegex(ist.InputError, "frame"):
            ist.Query(lps, ras)
        with self.assertRaisesRegex(ist.InputError, "frame is 'las'"):
            ist.build(path, 1, frame="las")

    def test_a_pose_maps_the_moving_body_to_the_fixed_one(self):
        pose = pose_of([0, 0, 1], np.pi / 2, [5, 0, 0])  # (x, y, z) goes to (5 - y, x, z)
        fixed = ist.build(box([-6, -1, -1], [-4, 1, 1]), voxel_size=0.25)
        moving = ist.build(box([-1, 9, -1], [1, 12, 1]), voxel_size=0.25)  # goes to x from -7 to -4, y from -1 to 1
        query = ist.Query(fixed, moving)
        self.assertIs(query.intersects(pose), True)
        with self.assertRaises(ist.InputError):
            query.intersects(pose.T)
        back = np.linalg.inv(pose)
        self.assertIs(query.intersects(back), False)
        moved = pose @ np.array([0, 12, 0, 1])
        np.testing.assert_allclose(moved, [-7, 0, 0, 1], atol=1e-12)
        self.assertAlmostEqual(query.distance(pose_of([0, 0, 1], np.pi / 2, [8, 0, 0]), 1e-6).upper, 0, places=6)
        self.assertAlmostEqual(query.distance(pose_of([0, 0, 1], np.pi / 2, [10, 0, 0]), 1e-6).upper, 2, places=6)

    def test_arrays_are_filled_in_place(self):
        pose = JAW_POSES[1]
        pairs = self.query.leaf_pairs(pose)
        self.assertGreater(pairs.count, 100)
        out = np.full(50, 7, ist.LEAF_PAIR)
        short = self.query.leaf_pairs(pose, out=out)
        self.assertTrue(short.truncated and not pairs.truncated and short.count == pairs.count)
        self.assertIs(short.pairs.base, out)
        self.assertEqual(out.tolist(), pairs.pairs[:50].tolist())
        self.assertEqual(self.query.leaf_pairs(pose, most=3).pairs.tolist(), pairs.pairs[:3].tolist())
        self.assertEqual(self.query.leaf_pairs(pose, most=0).count, pairs.count)
        met = self.query.triangle_pairs(pose)
        out = np.empty(met.count + 5, ist.TRIANGLE_PAIR)
        self.assertEqual(self.query.triangle_pairs(pose, out=out).pairs.tolist(), met.pairs.tolist())
        contacts = self.query.contacts(pose)
        out = np.empty(32, ist.CONTACT)
        self.assertEqual(self.query.contacts(pose, out=out).contacts.tobytes(), contacts.contacts.tobytes())
        self.assertGreater(len(contacts.contacts), 3)

    def test_fields_go_through_dlpack(self):
        found = self.query.rows(np.array(JAW_POSES), want=["distance"])
        shared = np.from_dlpack(found["distance_lower"])
        self.assertTrue(np.shares_memory(shared, found))
        np.testing.assert_array_equal(shared, found["distance_lower"])

    def test_leaf_pairs_are_near_each_other(self):
        pose = JAW_POSES[1]
        pairs = self.query.leaf_pairs(pose).pairs
        moved = self.lower.leaf_centres @ pose[:3, :3].T + pose[:3, 3]
        apart = np.linalg.norm(self.upper.leaf_centres[pairs["fixed"]] - moved[pairs["moving"]], axis=1)
        self.assertLess(apart.max(), 2 * 0.8 * np.sqrt(3))

    def test_answers_say_how_far_the_pose_was(self):
        pose = JAW_POSES[1].copy()
        pose[:3, :3] = pose[:3, :3] @ np.diag([1 + 2e-4, 1, 1 - 2e-4])
        error = np.abs(pose[:3, :3].T @ pose[:3, :3] - np.eye(3)).max()
        self.assertGreater(error, 1e-4)
        for answer in (self.query.leaf_pairs(pose), self.query.leaf_pairs(pose, most=5), self.query.contacts(pose),
                       self.query.distance(pose, 0.1), self.query.triangle_pairs(pose), self.query.penetration(pose, 0.1),
                       self.query.near_pairs(pose, 0.1), self.query.near_parts(pose, (0, 0), 1e3),
                       self.query.first_contact(np.eye(4), pose, 0.1), self.query.occlusion(pose)):
            self.assertAlmostEqual(answer.rotation_error, error, places=14, msg=type(answer).__name__)
        self.assertAlmostEqual(ist.rotation_error(pose), error, places=14)
        rows = self.query.rows(np.array([pose, np.eye(4), 3 * np.eye(4)]))
        np.testing.assert_allclose(rows["rotation_error"], [error, 0, 8], rtol=0, atol=1e-14)
        self.assertEqual(self.query.distance(np.eye(4)).rotation_error, 0)
        pose[:3, :3] = 1.0001 * np.eye(3)
        with self.assertRaisesRegex(ist.InputError, "scale"):
            self.query.intersects(pose)

    def test_without_voxels_triangles_answer(self):
        upper, lower = (ist.build((tree.vertices, tree.faces)) for tree in (self.upper, self.lower))
        self.assertEqual((upper.voxel_size, upper.leaves, upper.depth, upper.spheres), (0, 0, 0, "none"))
        self.assertEqual(upper.leaf_centres.shape, (0, 3))
        self.assertIn("no voxels", repr(upper))
        self.assertEqual(ist.load(upper.to_bytes()).to_bytes(), upper.to_bytes())
        for fixed, moving in ((upper, lower), (upper, self.lower), (self.upper, lower)):
            query = ist.Query(fixed, moving)
            self.assertEqual(query.spheres, "none")
            self.assertLess(query.nbytes, self.query.nbytes)
            for pose in JAW_POSES:
                self.assertEqual(query.intersects(pose), self.query.intersects(pose))
                self.assertEqual(query.triangle_pairs(pose).count, self.query.triangle_pairs(pose).count)
                found, wanted = query.distance(pose, 0.01), self.query.distance(pose, 0.01)
                self.assertTrue(found.lower <= wanted.upper and wanted.lower <= found.upper)
            for ask in (query.leaf_pairs, query.contacts, lambda pose: query.rows(pose[None], want=["contacts"])):
                with self.assertRaisesRegex(ist.InputError, "voxel_size") as caught:
                    ask(JAW_POSES[0])
                self.assertEqual((caught.exception.code, caught.exception.name), (ist.VOXELS_MISSING, "voxels-missing"))
            with self.assertRaisesRegex(ist.InputError, "build it with a voxel size"):
                ist.Query(fixed, moving, spheres="slab")

    def test_a_limit_ends_a_search(self):
        stopped = self.query.leaf_pairs(JAW_POSES[2], tests=200)
        self.assertFalse(stopped.complete)
        self.assertLessEqual(stopped.sphere_tests, 201)
        low, high = stopped.distance
        self.assertTrue(0 <= low <= high)
        self.assertIsNone(self.query.intersects(JAW_POSES[2], tests=1))
        self.assertFalse(self.query.leaf_pairs(JAW_POSES[2], seconds=1e-9).complete)

    def test_forces_push_the_lower_jaw_down(self):
        felt = ist.Query(self.upper, self.lower).contacts(JAW_POSES[2])
        force, torque, about = felt.wrench(1.0)
        self.assertLess(force[2], -1)
        np.testing.assert_allclose(about, self.upper.origin)
        twice, _, _ = felt.wrench(2.0)
        np.testing.assert_array_equal(twice, 2 * force)
        self.assertEqual(torque.shape, (3,))

    def test_first_contact_on_the_way(self):
        found = self.query.first_contact(JAW_POSES[0], JAW_POSES[2], 1e-3)
        self.assertEqual(found.outcome, "contact")
        self.assertTrue(0 < found.lower <= found.upper < 1)
        self.assertIsNotNone(found.triangles)
        fixed, moving = found.place
        self.assertTrue(found.distance[0] <= np.linalg.norm(moving - fixed) <= found.distance[1])
        np.testing.assert_allclose(np.linalg.norm(found.normal), 1, rtol=1e-14)
        start = self.query.first_contact(JAW_POSES[2], JAW_POSES[0], 1e-3)
        self.assertEqual(start.outcome, "touches at start")
        np.testing.assert_allclose(*start.place, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(start.normal, [0, 0, 0])
        none = self.query.first_contact(JAW_POSES[0], JAW_POSES[0], 1e-3)
        self.assertEqual((none.outcome, none.place, none.normal), ("none", None, None))

    def test_triangles_that_pass_between_two_poses_meet(self):
        face = ist.build(([[-1, -1, 0.1], [1, -1, 0.1], [0, 1, 0.1]], [[0, 1, 2]]))
        query = ist.Query(face, ist.build(([[-0.3, -0.2, 0], [0.3, -0.2, 0], [0, 0.2, 0]], [[0, 1, 2]])))
        found = query.first_contact(pose_of([0, 0, 1], 0, [0, 0, 3]), pose_of([0, 0, 1], 0, [0, 0, -3]), 1e-6)
        self.assertEqual((found.outcome, found.passes, found.grazed), ("contact", True, False))
        self.assertTrue(found.lower <= 2.9 / 6 <= found.upper)
        self.assertFalse(self.query.first_contact(JAW_POSES[0], JAW_POSES[2], 1e-3).passes)

    def test_prepared_bodies_have_the_same_depth(self):
        ball = ist.build(box([-1, -1, -1], [1, 1, 1]))
        self.assertFalse(ball.prepared_for_depth)
        query = ist.Query(ball, ball)
        before = query.penetration(pose_of([1, 2, 3], 0.4, [0.2, 0.3, 1.5]), 1e-6)
        self.assertIs(ball.prepare_depth(), ball)
        self.assertTrue(ball.prepared_for_depth)
        after = query.penetration(pose_of([1, 2, 3], 0.4, [0.2, 0.3, 1.5]), 1e-6)
        self.assertTrue(before.lower <= after.upper and after.lower <= before.upper)
        self.assertTrue(pickle.loads(pickle.dumps(ball)).prepared_for_depth)
        with self.assertRaises(ist.MemoryLimitError):
            ist.build(box([-1, -1, -1], [1, 1, 1])).prepare_depth(max_memory=10)

    def test_crossed_bars_escape_by_their_overlap(self):
        query = ist.Query(ist.build(box([-5, -0.5, 0], [5, 0.5, 3])), ist.build(box([-0.5, -5, 0], [0.5, 5, 3])))
        start = pose_of([0, 0, 1], 0, [0, 0, 1.5])
        found = query.escape(start, 1e-4)
        self.assertEqual(found.status, "found")
        self.assertTrue(0.4999 <= found.lower <= 0.5 and 1.5 <= found.upper <= 1.5001)
        self.assertIs(query.intersects(found.pose), False)
        np.testing.assert_allclose(found.motion @ start, found.pose, rtol=0, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(found.motion[:3, 3]), 1.5, rtol=0, atol=1e-4)
        free = query.escape(found.pose)
        self.assertEqual((free.status, free.lower, free.upper), ("not needed", 0, 0))
        np.testing.assert_array_equal(free.motion, np.eye(4))
        short = query.escape(start, longest=1.4)
        self.assertEqual((short.status, short.upper), ("not found", np.inf))

    def test_a_box_settles_on_a_plate(self):
        query = ist.Query(ist.build(box([-20, -20, -2], [20, 20, 0])), ist.build(box([-5, -5, 0], [5, 5, 10])))
        start = pose_of([1, 0, 0], 0.01, [0.5, 0.25, 0.6])
        found = query.settle(start, closing=[0, 0, -1], at=[3, 2, 5])
        self.assertEqual((found.status, found.free, found.rocks), ("rests level", True, False))
        self.assertEqual(found.level.shape, (3, 6))
        self.assertAlmostEqual(found.margin, 2, 3)
        self.assertAlmostEqual(found.contacts["force"].sum(), 1, 5)
        self.assertTrue(0 <= found.distance[0] <= found.distance[1] <= 1e-3)
        np.testing.assert_allclose(found.pose[2], [0, 0, 1, 0], atol=1e-3)
        held = query.settle(start, closing=[0, 0, -1], at=[3, 2, 5], hold=["x", "y", "roll", "pitch", "yaw"], within=(3, 0.1))
        self.assertEqual(held.status, "rests")
        np.testing.assert_allclose(held.pose[:3, :3], start[:3, :3], rtol=0, atol=1e-15)
        self.assertEqual(query.settle(pose_of([1, 0, 0], 0, [0, 0, 50]), closing=[0, 0, -1]).status, "left the box")

    def test_a_ball_meets_a_plate_at_its_lowest_point(self):
        plate = ist.build(box([-3, -3, -1], [3, 3, 0]), 0.5)
        wedge = ([[0, 0, 0], [1, 0, 1], [-1, 1, 1], [-1, -1, 1]], [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]])
        query = ist.Query(plate, ist.build(wedge, 0.5))
        found = query.first_contact(pose_of([0, 0, 1], 0.3, [0.5, 0.25, 3]), pose_of([0, 0, 1], 0.3, [0.5, 0.25, -0.5]), 1e-6)
        self.assertEqual(found.outcome, "contact")
        np.testing.assert_allclose(found.place[0], [0.5, 0.25, 0], rtol=0, atol=1e-12)
        np.testing.assert_allclose(found.place[1], [0.5, 0.25, 0], rtol=0, atol=2e-6)
        np.testing.assert_allclose(found.normal, [0, 0, 1], rtol=0, atol=1e-6)
        gap = query.distance(pose_of([0, 0, 1], 0.3, [0.5, 0.25, 2]), 0)
        np.testing.assert_allclose(gap.nearest_fixed, [0.5, 0.25, 0], rtol=0, atol=1e-12)
        np.testing.assert_allclose(gap.nearest_moving, [0.5, 0.25, 2], rtol=0, atol=1e-12)
        np.testing.assert_array_equal(gap.direction, [0, 0, 1])

    def test_distance_names_its_triangles(self):
        gap = self.query.distance(JAW_POSES[0], 0.01)
        fixed, moving = gap.triangles
        parts = self.query.near_parts(JAW_POSES[0], gap.triangles, gap.upper)
        self.assertEqual(parts.pairs[["fixed", "moving"]][0].tolist(), (fixed, moving))
        way = gap.nearest_moving - gap.nearest_fixed
        length = np.linalg.norm(way)
        self.assertTrue(gap.lower <= length <= gap.upper)
        self.assertAlmostEqual(parts.pairs["distance"][0], length, places=9)
        np.testing.assert_allclose(gap.direction * length, way, rtol=0, atol=1e-12)
        self.assertEqual(gap._fields[-4:], ("nearest_fixed", "nearest_moving", "direction", "triangles"))
        self.assertIn(f"triangles=({fixed}, {moving})", repr(gap))
        self.assertNotIn("memory", repr(gap) + repr(self.query.contacts(JAW_POSES[2])))
        kept = gap.nearest_fixed.copy()
        met = self.query.distance(JAW_POSES[2], 0)
        np.testing.assert_array_equal(gap.nearest_fixed, kept)  # a later answer leaves it alone
        np.testing.assert_array_equal(met.direction, [0, 0, 0])
        bare = ist.build(box([0, 0, 0], [2, 2, 2]), 0.5, keep_triangles=False)
        unknown = ist.Query(bare, bare).distance(pose_of([0, 0, 1], 0, [5, 0, 0]))
        self.assertEqual((unknown.nearest_fixed, unknown.nearest_moving, unknown.direction, unknown.triangles), (None,) * 4)

    def test_near_pairs(self):
        margin = 0.5
        near = self.query.near_pairs(JAW_POSES[2], margin)
        self.assertTrue(near.complete and not near.truncated and not near.kept)
        self.assertEqual(near.count, len(near.pairs))
        self.assertGreater(near.count, 4096)  # more than the first array has room for
        pairs = near.pairs
        self.assertTrue((np.diff(pairs["distance"]) >= 0).all())
        self.assertLessEqual(pairs["distance"][-1], margin + near.pad)
        way = pairs["moving_point"] - pairs["fixed_point"]
        np.testing.assert_allclose(np.linalg.norm(way, axis=1), pairs["distance"], rtol=0, atol=1e-12)
        np.testing.assert_allclose(pairs["direction"] * pairs["distance"][:, None], way, rtol=0, atol=1e-12)
        met = self.query.triangle_pairs(JAW_POSES[2]).pairs
        zero = pairs[pairs["distance"] == 0]
        self.assertLessEqual(set(met.tolist()), set(zip(zero["fixed"].tolist(), zero["moving"].tolist())))
        out = np.empty(9, ist.NEAR_PAIR)
        short = self.query.near_pairs(JAW_POSES[2], margin, out=out)
        self.assertTrue(short.truncated and short.pairs.base is out and short.count == near.count)
        self.assertEqual(short.pairs.tobytes(), pairs[:9].tobytes())
        self.assertEqual(self.query.near_pairs(JAW_POSES[2], margin, most=3).pairs.tobytes(), pairs[:3].tobytes())
        self.assertFalse(self.query.near_pairs(JAW_POSES[2], margin, tests=200).complete)
        self.assertEqual(self.query.near_pairs(JAW_POSES[0], 1e-9).count, 0)

    def test_near_pairs_that_are_kept_have_the_same_bits(self):
        keeps = ist.Query(self.upper, self.lower, near_pairs=20_000)
        self.assertGreater(keeps.nbytes, ist.Query(self.upper, self.lower).nbytes + 7_000_000)
        kept = 0
        for tick in range(60):
            pose = JAW_POSES[1].copy()
            pose[0, 3] += 2e-4 * tick
            found = keeps.near_pairs(pose, 0.1)
            kept += found.kept
            self.assertEqual(found.pairs.tobytes(), self.query.near_pairs(pose, 0.1).pairs.tobytes())
        self.assertGreater(kept, 10)

    def test_depth_of_an_open_body(self):
        vertices, faces = box([0, 0, 0], [2, 2, 2])
        query = ist.Query(ist.build((vertices, faces), 0.25), ist.build((vertices, faces[:-1]), 0.25))
        depth = query.penetration(pose_of([0, 0, 1], 0.1, [0.5, 0, 0]), 0.01)
        self.assertEqual(depth.not_closed, "moving")
        self.assertTrue(np.isnan([depth.lower, depth.upper]).all())

    def test_a_soup_of_triangles_is_welded(self):
        vertices, faces = box([0, 0, 0], [2, 2, 2])
        soup = np.asarray(vertices)[np.asarray(faces)].reshape(-1, 3), np.arange(36).reshape(-1, 3)
        tree = ist.build(soup, voxel_size=0.5)
        self.assertTrue(tree.outward)
        self.assertEqual(len(tree.vertices), 36)
        found = ist.signed_distance(tree, [[1, 1, 1.5], [1, 1, 4]])
        self.assertEqual(found["distance"].tolist(), [-0.5, 2])
        self.assertFalse(ist.build(soup, voxel_size=0.5, weld=False).outward)

    def test_a_surface_that_intersects_itself_says_so(self):
        (a, f), (b, g) = box([0, 0, 0], [2, 2, 2]), box([1.5, 0.5, 0.5], [3.5, 1.5, 1.5])
        tree = ist.build((np.vstack([a, b]), np.vstack([f, np.asarray(g) + len(a)])), voxel_size=0.5)
        self.assertGreater(tree.self_intersections, 0)
        found = ist.signed_distance(tree, [[1.75, 1, 1], [1.4, 1, 1], [2.2, 1, 1], [2.2, 0.4, 1]])
        np.testing.assert_allclose(found["distance"], [-0.25, -0.1, -0.2, 0.1], rtol=0, atol=1e-15)
        self.assertTrue((found["is_signed"] == 1).all() and (found["self_intersecting"] == 1).all())
        small = ist.build(box([-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]), voxel_size=0.1)
        query = ist.Query(tree, small)
        pose = np.eye(4)
        pose[:3, 3] = 1.75, 1, 1
        depth = query.penetration(pose, 1e-6)
        self.assertEqual((depth.self_intersecting, depth.complete), ("fixed", True))
        self.assertEqual(query.rows(pose[None], want=["penetration"], tolerance=1e-6)["self_intersecting"], 1)
        self.assertGreater(depth.lower, 0)
        self.assertEqual(query.first_contact(pose, np.eye(4), 1e-3).outcome, "inside at start")
        self.assertEqual(small.self_intersections, 0)

    def test_signed_distances(self):
        tree = ist.build(box([0, 0, 0], [2, 2, 2]), 0.25)
        found = ist.signed_distance(tree, [[1, 1, 1.5], [1, 1, 4], [9, 9, 9]], reach=3)
        np.testing.assert_array_equal(found["distance"], [-0.5, 2, np.nan])
        self.assertEqual(found["triangle"][2], ist.NO_TRIANGLE)
        pose = pose_of([0, 0, 1], np.pi / 2, [0, 0, 3])
        found = ist.distance_map(tree, tree, pose)
        corners = np.c_[tree.vertices, np.ones(8)] @ pose.T
        self.assertEqual(found["distance"].shape, (8,))
        np.testing.assert_allclose(found["distance"][corners[:, 0] < -1], np.sqrt(4 + (corners[corners[:, 0] < -1][:, 2] - 2) ** 2))

    def test_occlusion(self):
        found = self.query.occlusion(JAW_POSES[2], limits=[0.1, 0.5])
        self.assertEqual(found.fixed.distances.shape, (len(self.upper.vertices),))
        self.assertEqual(found.fixed.areas.shape, (2,))
        self.assertTrue(0 < found.fixed.areas[0] < found.fixed.areas[1] < found.fixed.total_area)
        self.assertGreater(len(found.moving.regions), 1)
        self.assertTrue((np.diff(found.moving.regions["area"]) <= 0).all())
        alone = ist.occlusion(self.upper, self.lower, JAW_POSES[2], limits=[0.1, 0.5])
        self.assertEqual(alone.moving.regions.tobytes(), found.moving.regions.tobytes())

    def test_trees_keep_their_mesh(self):
        vertices, faces = self.meshes[0]
        np.testing.assert_array_equal(self.upper.vertices, vertices)
        np.testing.assert_array_equal(self.upper.faces, faces)
        self.assertFalse(self.upper.vertices.flags.writeable or self.upper.leaf_centres.flags.writeable)
        self.assertEqual(self.upper.leaf_centres.shape, (self.upper.leaves, 3))
        single = ist.build((vertices.astype(np.float32), faces.astype(np.int64)), 0.8)
        self.assertEqual(single.to_bytes(), self.upper.to_bytes())  # the built-in jaws are floats

    def test_a_file_is_read_as_the_arrays_in_it(self):
        name = os.path.join(folder(self), "box.obj")
        vertices, faces = box([0, 0, 0], [1, 2, 3])
        with open(name, "w", encoding="utf-8") as file:
            file.writelines(f"v {x} {y} {z}\n" for x, y, z in vertices)
            file.writelines(f"f {a} {b} {c}\n" for a, b, c in faces + 1)
        read = ist.read_mesh(name)
        np.testing.assert_array_equal(read[0][read[1]], vertices[faces])
        self.assertEqual(ist.build(name, 0.5).leaves, ist.build((vertices, faces), 0.5).leaves)


class Rows(Jaws):
    WANT = ["intersects", "leaf_pairs", "distance", "contacts", "penetration"]

    def poses(self, count):
        random = np.random.default_rng(5)
        poses = []
        for i in range(count):
            poses.append(pose_of(random.normal(size=3), random.normal(scale=0.02), [*random.normal(scale=0.3, size=2), -2.5 * random.random()]))
            if i % 8 == 7:
                poses[-1][0, 0] = np.nan if i % 16 == 7 else 2
        return np.array(poses)

    def test_rows_are_the_single_calls_bit_by_bit(self):
        poses = self.poses(24)
        found = self.query.rows(poses, want=self.WANT, tolerance=0.01, stiffness=1.5)
        self.assertEqual(set(found["intersects"].tolist()), {ist.UNKNOWN, ist.NO, ist.YES})
        for pose, row in zip(poses, found):
            if row["status"]:
                with self.assertRaises(ist.InputError):
                    self.query.distance(pose)
                self.assertTrue(np.isnan([row["distance_lower"], row["area"], *row["force"], *row["torque"]]).all())
                continue
            self.query.forget()
            self.assertEqual(self.query.intersects(pose), row["intersects"] == ist.YES)
            self.query.forget()
            distance = self.query.distance(pose, 0.01)
            self.assertTrue(same_bits(row["distance_lower"], distance.lower) and same_bits(row["distance_upper"], distance.upper))
            self.assertEqual(self.query.leaf_pairs(pose, most=0).count, row["leaf_pairs"])
            force, torque, _ = self.query.contacts(pose).wrench(1.5)
            self.assertEqual((force.tobytes(), torque.tobytes()), (row["force"].tobytes(), row["torque"].tobytes()))
            self.query.forget()
            depth = self.query.penetration(pose, 0.01)
            self.assertTrue(same_bits(row["depth_lower"], depth.lower) and same_bits(row["depth_upper"], depth.upper))

    def test_threads_and_out_change_nothing(self):
        poses = self.poses(100)
        one = self.query.rows(poses, threads=1)
        for threads in (2, 5, 0):
            out = np.empty(100, ist.ROW)
            self.assertIs(self.query.rows(poses, threads=threads, out=out), out)
            self.assertEqual(out.tobytes(), one.tobytes())
        self.assertEqual(self.query.rows(np.empty((0, 4, 4))).shape, (0,))


if __name__ == "__main__":
    unittest.main()
