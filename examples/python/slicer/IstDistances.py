"""A module of 3D Slicer: distances of two models from each other, and where they touch.

Install the package once, in Slicer's Python console: slicer.util.pip_install("FOLDER/ist-VERSION-py3-none-PLATFORM.whl").
Then add this file's folder in Edit > Application Settings > Modules > Additional module paths, and start Slicer again.

Both models get the point array "Signed" (mm; negative inside the other model, NaN beyond the reach). A table gets a row
for each contact region.

Which matrix is which:
- A transform node of Slicer maps the points of a model to the world, in RAS (GetMatrixTransformToWorld).
- A query wants moving points to fixed points: `pose_between` of two such matrices, in RAS, as models in Slicer are.
- A transform file that Slicer or ITK writes (.tfm, .h5) holds the inverse, in LPS: `matrix_of_file` turns it back.
"""

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

try:
    import slicer
    from slicer.ScriptedLoadableModule import ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleWidget
except ImportError:  # outside Slicer all that stands before its classes works alone
    slicer, ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleWidget = None, object, object, object

LPS = np.diag([-1.0, -1.0, 1.0, 1.0])  # maps RAS to LPS, and back
COLUMNS = ("area", "least_distance", "penetrating_area", "share")


def pose_between(fixed_to_world, moving_to_world):
    """The pose that maps moving to fixed points, of the matrices that map each model's points to the world."""
    return np.linalg.inv(fixed_to_world) @ moving_to_world


def matrix_of_file(itk_matrix):
    """Slicer's matrix to the parent, in RAS, of the matrix that a transform file holds."""
    return LPS @ np.linalg.inv(itk_matrix) @ LPS


def triangles_of(name, data):
    """A surface as triangles, with the same points in the same order."""
    if data is None or data.GetNumberOfPolys() + data.GetNumberOfStrips() == 0:
        raise ValueError(f"the {name} model has no triangles: choose a surface model")
    cut = vtk.vtkTriangleFilter()
    cut.SetInputData(data)
    cut.PassVertsOff()
    cut.PassLinesOff()
    cut.Update()
    return cut.GetOutput()


def measure(fixed, moving, pose, reach=2.0, contact=0.1, progress=None):
    """The occlusion of two vtkPolyData in millimetres, with distances in the order of their points."""
    try:
        import ist
    except ImportError as missing:
        raise RuntimeError("the package ist is missing: install its wheel by slicer.util.pip_install") from missing
    trees = [ist.build(triangles_of(name, data)) for name, data in (("fixed", fixed), ("moving", moving))]
    return ist.occlusion(*trees, pose, reach=reach, contact=contact, progress=progress)


def set_signed(data, distances):
    """Gives a vtkPolyData the point array "Signed"."""
    if len(distances) != data.GetNumberOfPoints():
        raise ValueError(f"{len(distances)} distances for {data.GetNumberOfPoints()} points")
    array = numpy_to_vtk(distances["distance"].astype("f4"), deep=True)
    array.SetName("Signed")
    data.GetPointData().AddArray(array)
    data.GetPointData().SetActiveScalars("Signed")


def table_of(occlusion, fixed_to_world):
    """A vtkTable: a row for each contact region, its lengths in mm and its centre in the world, RAS. A partner is the
    number of the region of the other model that it faces; -1: it faces none."""
    table = vtk.vtkTable()
    bodies = (("fixed", occlusion.fixed.regions), ("moving", occlusion.moving.regions))
    names = vtk.vtkStringArray()
    names.SetName("model")
    for name, regions in bodies:
        for _ in regions:
            names.InsertNextValue(name)
    table.AddColumn(names)
    rows = np.concatenate([regions for _, regions in bodies])
    centres = rows["centre"] @ fixed_to_world[:3, :3].T + fixed_to_world[:3, 3]
    columns = [("region", np.concatenate([np.arange(len(regions)) for _, regions in bodies])), ("partner", rows["partner"])]
    columns += [(name, rows[name]) for name in COLUMNS] + [(name, centres[:, i]) for i, name in enumerate("RAS")]
    for name, values in columns:
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        table.AddColumn(array)
    return table


class IstDistances(ScriptedLoadableModule):
    def __init__(self, parent):
        super().__init__(parent)
        parent.title = "Distances and contacts (IST)"
        parent.categories = ["Surface Models"]
        parent.contributors = ["The authors of IST"]
        parent.helpText = "Distances of two models from each other, and where they touch. Research software, not a medical device."


class IstDistancesWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        super().setup()
        import qt
        form = qt.QFormLayout()
        self.layout.addLayout(form)
        self.fixed = self.selector(form, "Fixed model", "vtkMRMLModelNode")
        self.moving = self.selector(form, "Moving model", "vtkMRMLModelNode")
        self.transform = self.selector(form, "Transform of the moving model", "vtkMRMLLinearTransformNode")
        self.transform.noneEnabled = True
        self.transform.toolTip = "Maps the moving model to the world. None: the transform that the model is under."
        self.reach = qt.QDoubleSpinBox()
        self.reach.value, self.reach.suffix = 2.0, " mm"
        form.addRow("Reach", self.reach)
        button = qt.QPushButton("Measure")
        button.clicked.connect(self.on_measure)
        form.addRow(button)
        self.layout.addStretch(1)

    def selector(self, form, title, kind):
        chosen = slicer.qMRMLNodeComboBox()
        chosen.nodeTypes = [kind]
        chosen.addEnabled = chosen.removeEnabled = False
        chosen.setMRMLScene(slicer.mrmlScene)
        form.addRow(title, chosen)
        return chosen

    def on_measure(self, *_):
        with slicer.util.tryWithErrorDisplay("The models could not be measured.", waitCursor=True):
            IstDistancesLogic().run(self.fixed.currentNode(), self.moving.currentNode(), self.transform.currentNode(), self.reach.value)


class IstDistancesLogic(ScriptedLoadableModuleLogic):
    def run(self, fixed, moving, transform=None, reach=2.0, contact=0.1):
        """Measures two model nodes where they stand in the scene, or the moving one where `transform` places it. Returns the
        node of the table."""
        if fixed is None or moving is None or fixed is moving:
            raise ValueError("choose two models")
        fixed_to_world = to_world(fixed.GetParentTransformNode())
        moving_to_world = to_world(transform or moving.GetParentTransformNode())
        found = measure(fixed.GetPolyData(), moving.GetPolyData(), pose_between(fixed_to_world, moving_to_world), reach, contact)
        for node, body in ((fixed, found.fixed), (moving, found.moving)):
            set_signed(node.GetPolyData(), body.distances)
            node.CreateDefaultDisplayNodes()
            node.GetDisplayNode().SetActiveScalarName("Signed")
            node.GetDisplayNode().SetScalarVisibility(True)
        table = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLTableNode", "Contact regions")
        table.SetAndObserveTable(table_of(found, fixed_to_world))
        return table


def to_world(transform):
    """The matrix of a transform node to the world; of None the identity."""
    matrix = vtk.vtkMatrix4x4()
    if transform is not None:
        if not transform.IsTransformToWorldLinear():
            raise ValueError("a model is under a transform that is not linear: harden that transform first")
        transform.GetMatrixTransformToWorld(matrix)
    return np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
