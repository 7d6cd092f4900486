"""Builds trees of objects of other libraries: the tree is the same, byte for byte, as of their arrays."""

import unittest

from support import ball, block, np, skip

try:
    import meshio
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError as missing:
    skip(f"{missing}; scripts/setup.sh --oracles installs it, for /usr/bin/python3")

import ist


class TrimeshLike:
    """As trimesh.Trimesh is: arrays that it made of others, int64 faces, and much else."""

    def __init__(self, vertices, faces):
        self._vertices, self._faces = np.asarray(vertices).view(), np.asarray(faces, np.int64)
        self._vertices.flags.writeable = False

    @property
    def vertices(self):
        return self._vertices

    @property
    def faces(self):
        return self._faces

    @property
    def area(self):
        raise AssertionError("nobody asks for that")


def poly_data(vertices, faces):
    data = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(vertices, float), deep=True))
    data.SetPoints(points)
    cells = vtk.vtkCellArray()
    for face in faces:
        cells.InsertNextCell(len(face))
        for index in face:
            cells.InsertCellPoint(int(index))
    data.SetPolys(cells)
    return data


def lines_and_points():
    """A vtkPolyData without any polygon."""
    source = vtk.vtkLineSource()
    source.Update()
    return source.GetOutput()


class SameTree(unittest.TestCase):
    def same(self, other, vertices, faces, voxel_size=0.5):
        expected = ist.build((vertices, faces), voxel_size)
        built = ist.build(other, voxel_size)
        np.testing.assert_array_equal(built.vertices, expected.vertices)
        np.testing.assert_array_equal(built.faces, expected.faces)
        self.assertEqual(built.to_bytes(), expected.to_bytes())

    def test_trimesh_like(self):
        self.same(TrimeshLike(*ball(1.0)), *ball(1.0))
        single = ball(1.0)[0].astype(np.float32)
        self.same(TrimeshLike(single, ball(1.0)[1]), single, ball(1.0)[1])

    def test_meshio(self):
        vertices, faces = ball(1.0)
        half = len(faces) // 2
        for cells in ([("triangle", faces)], [("triangle", faces[:half]), ("triangle", faces[half:])]):
            self.same(meshio.Mesh(vertices, cells), vertices, faces)

    def test_meshio_of_a_file_with_other_cells_too(self):
        vertices, faces = block()
        self.same(meshio.Mesh(vertices, [("vertex", [[0], [1]]), ("line", [[0, 1]]), ("triangle", faces)]), vertices, faces)

    def test_vtk_triangles(self):
        self.same(poly_data(*ball(1.0)), *ball(1.0))

    def test_vtk_of_a_source(self):
        source = vtk.vtkSphereSource()
        source.SetRadius(5)
        source.SetThetaResolution(24)
        source.Update()
        data = source.GetOutput()
        faces = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        self.same(data, vtk_to_numpy(data.GetPoints().GetData()), faces)

    def test_vtk_of_a_distance_by_vtk(self):
        """Answers on what VTK holds agree with VTK's own."""
        data = poly_data(*ball(1.0))
        points = np.random.default_rng(1).uniform(-8, 8, (200, 3))
        by_vtk = vtk.vtkImplicitPolyDataDistance()
        by_vtk.SetInput(data)
        expected = np.array([by_vtk.EvaluateFunction(point) for point in points])
        np.testing.assert_allclose(ist.signed_distance(ist.build(data, 0.5), points)["distance"], expected, atol=1e-9)


class Refused(unittest.TestCase):
    def test_bad_input(self):
        vertices, faces = block()
        for name, thing in (
            ("an object that is no mesh", object()),
            ("a number", 3.5),
            ("nothing", None),
            ("vertices alone", TrimeshLike(vertices, np.empty((0, 3)))),
            ("meshio without triangles", meshio.Mesh(vertices, [("line", [[0, 1]])])),
            ("meshio of points in a plane", meshio.Mesh(vertices[:, :2], [("triangle", faces)])),
            ("VTK without polygons", lines_and_points()),
            ("VTK without anything", vtk.vtkPolyData()),
            ("VTK of volumes", vtk.vtkUnstructuredGrid()),
            ("an index beyond the vertices", TrimeshLike(vertices, faces + 1)),
            ("faces of four", TrimeshLike(vertices, [[0, 1, 3, 2]])),
        ):
            with self.subTest(name):
                with self.assertRaises((ist.InputError, TypeError)) as refused:
                    ist.build(thing, 0.5)
                self.assertGreater(len(str(refused.exception)), 20, "it names cause and remedy")


if __name__ == "__main__":
    unittest.main()
