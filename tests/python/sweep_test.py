"""The poses of a sweep from Python, against numpy's own Philox, and its rows, against Query.rows."""

import numpy as np
import unittest
from support import box, turn
from sweep_support import ABOUT, ANSWERS, GRID, Moved, Sweeps, box_poses

import ist


class Poses(Sweeps):
    def test_a_box_moves_as_numpys_philox_says_bit_for_bit(self):
        for seed in (0, 7, 2**40 + 3, 2**63 - 1):
            found = self.job(box_poses(seed, 50)).poses(0, 50)
            self.assertEqual((found.shape, found.dtype, found.flags.c_contiguous), ((50, 4, 4), np.float64, True))
            expected = np.tile(np.eye(4), (50, 1, 1))
            expected[:, :3, 3] = [Moved(seed, index).move for index in range(50)]
            self.assertEqual(found.tobytes(), expected.tobytes())

    def test_a_box_turns_within(self):
        found = self.job(box_poses(7, 60) + f"turns_within = [3, 0, 45]\nabout = {ABOUT.tolist()}\n").poses(0, 60)
        np.testing.assert_allclose(found, [Moved(7, index).within([3, 0, 45]) for index in range(60)], atol=1e-13)
        self.assertGreater(np.ptp(found[:, 0, 1]), 0.3)

    def test_a_box_turns_any_way(self):
        found = self.job(box_poses(8, 60) + f'turns = "any"\nabout = {ABOUT.tolist()}\n').poses(0, 60)
        np.testing.assert_allclose(found, [Moved(8, index).any() for index in range(60)], atol=1e-13)
        self.assertLess(found[:, 0, 0].min(), -0.5)

    def test_a_grid_moves_by_its_last_axis_first(self):
        sweep = self.job(GRID)
        found, expected = sweep.poses(0, sweep.rows), []
        for angle in (-4, -0.5, 3):
            for z in (-3, -3 + 3.3 / 3, -3 + 3.3 * 2 / 3, 0.3):
                for y in (0, -1):
                    pose = np.eye(4)
                    pose[:3, :3] = turn([1, 2, -2], np.radians(angle))
                    pose[:3, 3] = pose[:3, :3] @ [0, y, z] + ABOUT - pose[:3, :3] @ ABOUT
                    expected.append(pose)
        np.testing.assert_allclose(found, expected, atol=1e-13)

    def test_a_grid_of_moves_is_exact(self):
        found = self.job(GRID[GRID.index("[[poses.axes]]\nmove"):]).poses(0, 8)
        z = [-3 + (0.3 - -3) * (step / 3) for step in range(3)] + [0.3]
        np.testing.assert_array_equal(found[:, 2, 3], np.repeat(z, 2))
        np.testing.assert_array_equal(found[:, 1, 3], [0, -1] * 4)

    def test_a_file_has_them_row_by_row(self):
        poses = np.array([Moved(3, index).any() for index in range(30)])
        np.save(self.place / "poses.npy", poses)
        sweep = self.job('[poses]\nfile = "poses.npy"\n')
        self.assertEqual(sweep.rows, 30)
        self.assertEqual(sweep.poses(0, 30).tobytes(), poses.tobytes())
        self.assertEqual(sweep.poses(11, 7).tobytes(), poses[11:18].tobytes())

    def test_they_are_the_same_in_every_order(self):
        for text in (box_poses(5, 40) + 'turns = "any"\n', GRID):
            sweep = self.job(text)
            whole = sweep.poses(0, sweep.rows)
            for first, count in ((0, 0), (3, 1), (17, 7), (sweep.rows - 2, 2), (sweep.rows, 0)):
                self.assertEqual(sweep.poses(first, count).tobytes(), whole[first : first + count].tobytes())


POSE = ("x", "y", "z", "qx", "qy", "qz", "qw")


def matrices(table):
    """The poses of a table's columns as matrices, (N, 4, 4)."""
    x, y, z, w = (table[name] for name in POSE[3:])
    poses = np.tile(np.eye(4), (len(table), 1, 1))
    poses[:, :3, 3] = np.stack([table[name] for name in "xyz"], axis=1)
    poses[:, :3, :3] += 2 * np.stack([
        np.stack([-y * y - z * z, x * y - w * z, x * z + w * y], axis=1),
        np.stack([x * y + w * z, -x * x - z * z, y * z - w * x], axis=1),
        np.stack([x * z - w * y, y * z + w * x, -x * x - y * y], axis=1)], axis=1)
    return poses


class Rows(Sweeps):
    def test_a_table_has_its_poses(self):
        grid = GRID.replace("from = -4", 'name = "turned"\nfrom = -4').replace("from = -3", 'name = "height"\nfrom = -3')
        for text in (box_poses(8, 60) + 'turns = "any"\n', box_poses(9, 60), grid):
            sweep = self.job(text, settings="rows_per_part = 60")
            sweep.run(0)
            table = np.load(sweep.folder / "part-000000.npy")
            np.testing.assert_allclose(matrices(table), sweep.poses(0, sweep.rows), atol=1e-13)
            self.assertGreaterEqual(table["qw"].min(), 0)
        np.testing.assert_array_equal(table["turned"], np.repeat([-4, -0.5, 3], 8))
        np.testing.assert_array_equal(table["height"], np.tile(np.repeat([-3 + (0.3 - -3) * (step / 3) for step in range(3)] + [0.3], 2), 3))

    def test_a_mesh_answers_as_its_tree(self):
        upper = self.place / "upper.stl"
        (vertices, faces) = box([-2, -2, 0], [2, 2, 1.5])
        triangles = np.asarray(vertices, "<f4")[np.asarray(faces)]
        records = np.zeros(len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
        records["corners"] = triangles
        upper.write_bytes(bytes(80) + np.uint32(len(records)).tobytes() + records.tobytes())
        ist.build(upper, 0.25).save(self.place / "of_mesh.ist")
        tables = []
        for fixed in ('"of_mesh.ist"', '{ file = "upper.stl", voxel_size = 0.25 }'):
            sweep = self.job(box_poses(3, 40), ANSWERS, f"rows_per_part = 40\ntolerance = 0.01\nfixed = {fixed}\nmoving = 'lower.ist'", "")
            sweep.run(0)
            tables.append((sweep.folder / "part-000000.npy").read_bytes())
        self.assertEqual(*tables)
        bodies = 'fixed = "upper.stl"\nmoving = "lower.ist"\n'
        self.refuses(ist.InputError, [".toml:", "fixed", "need voxels", "voxel_size"], self.job, GRID, ["contacts"], bodies=bodies)

    def test_columns_are_those_of_the_answers(self):
        pose = [(name, "<f8") for name in POSE]
        first = [("index", "<u8"), *pose, ("status", "<i4"), ("complete", "<i4")]
        self.assertEqual(self.job(GRID, ["intersects"]).columns, np.dtype([*first, ("intersects", "<i4"), ("sphere_tests", "<u8")]))
        of_all = self.job(GRID, ANSWERS).columns
        self.assertEqual(of_all.itemsize, sum(of_all[name].itemsize for name in of_all.names))
        self.assertEqual(set(of_all.names) - {"index", *POSE}, self.names_of_row())

    @staticmethod
    def names_of_row():
        vectors = {f"{vector}_{axis}" for vector in ("force", "torque") for axis in "xyz"}
        return set(ist.ROW.names) - {"force", "torque", "rotation_error"} | vectors

    def same_as_single_rows(self, table, sweep, **options):
        """Compares a table, column by column and bit by bit, with what Query.rows says of the same poses."""
        rows = ist.Query(self.upper, self.lower).rows(sweep.poses(0, sweep.rows), **options)
        self.assertEqual(table.dtype, sweep.columns)
        np.testing.assert_array_equal(table["index"], np.arange(sweep.rows))
        np.testing.assert_allclose(matrices(table), sweep.poses(0, sweep.rows), atol=1e-14)
        for name in set(table.dtype.names) - {"index", *POSE}:
            vector, _, axis = name.rpartition("_")
            expected = rows[vector][:, "xyz".index(axis)] if vector in ("force", "torque") else rows[name]
            self.assertEqual(table[name].tobytes(), expected.tobytes(), name)
        return rows

    def test_each_is_that_of_a_query(self):
        sweep = self.job(box_poses(11, 64) + "turns_within = [20, 20, 20]\n", ANSWERS, "rows_per_part = 25\ntolerance = 0.01\nstiffness = 2.5")
        for part in sweep.parts:
            sweep.run(part)
        self.assertEqual(sweep.merge(), (64, [], []))
        rows = self.same_as_single_rows(np.load(sweep.folder / "rows.npy"), sweep, want=ANSWERS, tolerance=0.01, stiffness=2.5)
        self.assertEqual(set(rows["intersects"]), {ist.YES, ist.NO})
        self.assertTrue((rows["force"] != 0).any() and (rows["depth_lower"] > 0).any())

    def test_a_limit_and_spheres_are_heard(self):
        settings = 'rows_per_part = 64\ntests = 40\nspheres = "simple"'
        sweep = self.job(box_poses(12, 64), ["distance"], settings)
        sweep.run(0)
        table = np.load(sweep.folder / "part-000000.npy")
        rows = ist.Query(self.upper, self.lower, spheres="simple").rows(sweep.poses(0, 64), want=["distance"], tests=40)
        self.assertEqual(table["distance_lower"].tobytes(), rows["distance_lower"].tobytes())
        self.assertEqual(set(table["complete"]), set(rows["complete"]))
        self.assertIn(0, table["complete"])

    def test_a_pose_that_is_no_motion_is_a_status(self):
        poses = np.tile(np.eye(4), (5, 1, 1))
        poses[2] *= 2
        np.save(self.place / "bad.npy", poses)
        sweep = self.job('[poses]\nfile = "bad.npy"\n')
        sweep.run(0)
        table = np.load(sweep.folder / "part-000000.npy")
        self.assertEqual(table["status"].tolist(), [0, 0, ist.POSE_INVALID, 0, 0])
        self.assertEqual(np.isnan(table["x"]).tolist(), [False, False, True, False, False])


if __name__ == "__main__":
    unittest.main()
