"""Tests the module for 3D Slicer: its matrices and measures by closed forms, and its run on stand-ins for Slicer's nodes,
which hold real vtkPolyData. Slicer itself is in no package of Debian."""

import sys
import types
import unittest
from unittest import mock

from support import ball, block, motion, moved, np, recipe, skip

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    skip(f"{missing}; scripts/setup.sh --oracles installs it, for /usr/bin/python3")

from other_libraries_test import lines_and_points, poly_data

MODULE = "slicer/IstDistances.py"
FIXED_TO_WORLD = motion((1, 2, 3), 40, (10, -20, 30))
# In the block's coordinates the ball stands 0.25 deep in its top, turned about its own axis.
POSE = motion((0, 0, 1), 30, (0, 0, 0.25))


class Node:
    """A model node, or a transform node where it has a matrix."""

    def __init__(self, data=None, parent=None, matrix=None, is_linear=True):
        self.data, self.parent, self.matrix, self.is_linear = data, parent, matrix, is_linear
        self.display = mock.Mock()

    def GetPolyData(self):
        return self.data

    def GetParentTransformNode(self):
        return self.parent

    def CreateDefaultDisplayNodes(self):
        pass

    def GetDisplayNode(self):
        return self.display

    def IsTransformToWorldLinear(self):
        return self.is_linear

    def GetMatrixTransformToWorld(self, matrix):
        for i in range(4):
            for j in range(4):
                matrix.SetElement(i, j, self.matrix[i, j])


def in_slicer():
    """The module as Slicer loads it, and what stands for Slicer."""
    slicer, base = mock.MagicMock(), types.ModuleType("slicer.ScriptedLoadableModule")
    for name in ("ScriptedLoadableModule", "ScriptedLoadableModuleLogic", "ScriptedLoadableModuleWidget"):
        setattr(base, name, type(name, (), {"__init__": lambda self, parent=None: None}))
    with mock.patch.dict(sys.modules, {"slicer": slicer, "slicer.ScriptedLoadableModule": base}):
        return recipe(MODULE), slicer


class Matrices(unittest.TestCase):
    def setUp(self):
        self.module = recipe(MODULE)
        self.points = np.random.default_rng(1).uniform(-50, 50, (5, 3))

    def test_the_pose_maps_moving_to_fixed_points(self):
        fixed, moving = FIXED_TO_WORLD, motion((3, -1, 2), 70, (5, 6, 7))
        here = moved(self.module.pose_between(fixed, moving), self.points)
        np.testing.assert_allclose(moved(fixed, here), moved(moving, self.points), atol=1e-12)

    def test_a_file_maps_points_of_the_world_back_in_lps(self):
        to_parent = motion((3, -1, 2), 70, (5, 6, 7))  # RAS
        flip = np.array([-1, -1, 1])
        in_world = moved(to_parent, self.points)
        # The file's matrix is the one that takes points of the world to the model's, x and y negated on both sides.
        ones = np.ones((5, 1))
        of_file = np.linalg.lstsq(np.hstack([in_world * flip, ones]), np.hstack([self.points * flip, ones]), rcond=None)[0].T
        np.testing.assert_allclose(self.module.matrix_of_file(of_file), to_parent, atol=1e-9)


class Run(unittest.TestCase):
    def nodes(self):
        fixed = Node(poly_data(*block()), parent=Node(matrix=FIXED_TO_WORLD))
        moving = Node(poly_data(*ball(9.5)), parent=Node(matrix=motion((1, 0, 0), 10, (0, 0, 500))))
        return fixed, moving, Node(matrix=FIXED_TO_WORLD @ POSE)

    def test_both_models_get_signed_and_the_table_their_regions(self):
        module, slicer = in_slicer()
        fixed, moving, transform = self.nodes()
        made = module.IstDistancesLogic().run(fixed, moving, transform, reach=2.0)
        signed = vtk_to_numpy(moving.data.GetPointData().GetArray("Signed"))
        heights = moved(POSE, ball(9.5)[0])[:, 2] - 5
        self.assertLess(np.nanmin(signed), -0.24)
        np.testing.assert_allclose(signed, np.where(heights <= 2, heights, np.nan), atol=1e-6)
        self.assertEqual(fixed.data.GetPointData().GetArray("Signed").GetNumberOfTuples(), 8)
        for node in (fixed, moving):
            node.display.SetActiveScalarName.assert_called_with("Signed")
        self.assertIs(made, slicer.mrmlScene.AddNewNodeByClass.return_value)
        table = made.SetAndObserveTable.call_args.args[0]
        names = [table.GetColumnName(i) for i in range(table.GetNumberOfColumns())]
        self.assertEqual(names, ["model", "region", "partner", "area", "least_distance", "penetrating_area", "share", "R", "A", "S"])
        rows = [[table.GetValue(i, j) for j in range(len(names))] for i in range(table.GetNumberOfRows())]
        self.assertEqual([(row[0].ToString(), row[1].ToInt(), row[2].ToInt()) for row in rows], [("fixed", 0, 0), ("moving", 0, 0)])
        # The ball's cap meets the top's middle, which is there in the world:
        for row in rows:
            there = np.array([cell.ToDouble() for cell in row[7:]])
            np.testing.assert_allclose(there, moved(FIXED_TO_WORLD, np.array([0, 0, 5.0])), atol=0.15)
        cap = 2 * np.pi * 5 * 0.25  # of a sphere, in which the ball's triangles lie
        self.assertAlmostEqual(rows[1][5].ToDouble(), cap, delta=0.06 * cap)

    def test_quads_and_strips_keep_their_points(self):
        module, _ = in_slicer()
        quads, strips = vtk.vtkCubeSource(), vtk.vtkStripper()
        quads.SetBounds(-20, 20, -20, 20, -5, 5)
        quads.Update()
        strips.SetInputData(poly_data(*ball(9.5)))
        strips.Update()
        self.assertEqual((quads.GetOutput().GetPolys().GetMaxCellSize(), strips.GetOutput().GetNumberOfPolys()), (4, 0))
        fixed, moving, transform = Node(quads.GetOutput()), Node(strips.GetOutput()), Node(matrix=POSE)
        module.IstDistancesLogic().run(fixed, moving, transform)
        signed = vtk_to_numpy(moving.data.GetPointData().GetArray("Signed"))
        heights = moved(POSE, vtk_to_numpy(moving.data.GetPoints().GetData()))[:, 2] - 5
        np.testing.assert_allclose(signed, np.where(heights <= 2, heights, np.nan), atol=1e-6)

    def test_without_a_transform_the_models_own_places_count(self):
        module, _ = in_slicer()
        fixed, moving, transform = self.nodes()
        module.IstDistancesLogic().run(fixed, moving)
        self.assertTrue(np.isnan(vtk_to_numpy(moving.data.GetPointData().GetArray("Signed"))).all())
        moving.parent = transform
        module.IstDistancesLogic().run(fixed, moving)
        self.assertLess(np.nanmin(vtk_to_numpy(moving.data.GetPointData().GetArray("Signed"))), -0.24)

    def test_bad_input(self):
        module, slicer = in_slicer()
        fixed, moving, _ = self.nodes()
        bent = Node(matrix=POSE, is_linear=False)
        for models, said in (
            ((fixed, None, None), "choose two models"),
            ((fixed, fixed, None), "choose two models"),
            ((fixed, Node(lines_and_points()), None), "the moving model has no triangles"),
            ((Node(vtk.vtkPolyData()), moving, None), "the fixed model has no triangles"),
            ((Node(None), moving, None), "the fixed model has no triangles"),
            ((fixed, moving, bent), "harden"),
        ):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                module.IstDistancesLogic().run(*models)
        slicer.mrmlScene.AddNewNodeByClass.assert_not_called()
        with mock.patch.dict(sys.modules, {"ist": None}), self.assertRaisesRegex(RuntimeError, "slicer.util.pip_install"):
            module.measure(fixed.data, moving.data, POSE)
        with self.assertRaisesRegex(ValueError, "3 distances for 8 points"):
            module.set_signed(fixed.data, np.zeros(3, [("distance", "f8")]))

    def test_the_widget_asks_the_logic(self):
        module, slicer = in_slicer()
        slicer.qMRMLNodeComboBox.side_effect = lambda: mock.MagicMock()
        qt = mock.MagicMock()
        widget = module.IstDistancesWidget()
        widget.layout = mock.MagicMock()
        with mock.patch.dict(sys.modules, {"qt": qt}), mock.patch.object(type(widget).__mro__[1], "setup", lambda self: None, create=True):
            widget.setup()
        self.assertEqual([each.nodeTypes for each in (widget.fixed, widget.moving, widget.transform)],
                         [["vtkMRMLModelNode"], ["vtkMRMLModelNode"], ["vtkMRMLLinearTransformNode"]])
        with mock.patch.object(module.IstDistancesLogic, "run") as run:
            qt.QPushButton.return_value.clicked.connect.call_args.args[0]()
        run.assert_called_once_with(widget.fixed.currentNode(), widget.moving.currentNode(), widget.transform.currentNode(), 2.0)


if __name__ == "__main__":
    unittest.main()
