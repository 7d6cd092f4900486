"""Asks the ist command for an occlusion, and measures the same by VTK and numpy. Lengths are in mesh units."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]
FACET = [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]

try:
    import numpy as np
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
except ImportError as missing:
    print(f"{missing}; scripts/setup.sh --oracles installs it, for /usr/bin/python3", file=sys.stderr)
    sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)


def skip(reason):
    """Ends the test as skipped; as failed with IST_REQUIRE_ALL=1."""
    print(reason, file=sys.stderr)
    sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)


def holds(what, worst, bound):
    """Says the worst figure of a comparison, and fails where it is over its bound, or no number."""
    print(f"{what}: {worst:.3g}, at most {bound:.3g}", flush=True)
    assert worst <= bound, what


# Meshes: corners of shape (n, 3, 3), float32 as STL holds them.

def write_stl(file, corners):
    facets = np.zeros(len(corners), FACET)
    facets["corners"] = corners
    with open(file, "wb") as out:
        out.write(bytes(80) + np.uint32(len(facets)).tobytes() + facets.tobytes())


def read_stl(file):
    return np.fromfile(file, FACET, offset=84)["corners"]


def welded(corners):
    """Returns vertices, float64, and triangles that index them."""
    points, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return points.astype("f8"), index.reshape(-1, 3)


# The command.

class Command:
    def __init__(self, ist, folder):
        self.ist, self.folder = ist, pathlib.Path(folder)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def run(self, *arguments):
        done = subprocess.run([self.ist, *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True)
        return re.sub("\x1b\\[[0-9;]*m", "", done.stdout)

    def built_in_jaws(self):
        self.run("demo", "--keep", self.folder, "--voxel-size", 8)
        return self.folder / "upper_jaw.stl", self.folder / "lower_jaw.stl"

    def measures(self, fixed, moving, *more):
        return json.loads(self.run("occlusion", fixed, moving, "--json", *more).splitlines()[-1])

    def map(self, fixed, moving, *more):
        """Returns both bodies as the .vtp tells them, and the lines that were printed."""
        file = self.folder / "map.vtp"
        lines = self.run("occlusion", fixed, moving, "-o", file, *more).splitlines()
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(file))
        reader.Update()
        data = reader.GetOutput()
        return [MappedBody(data, body) for body in (0, 1)], lines


def jaws(*names):
    folder = pathlib.Path(os.environ.get("IST_DATA_DIR") or SOURCE.parent / "shared/data")
    files = [folder / f"{name}.stl" for name in names]
    if not all(file.is_file() for file in files):
        skip(f"no {' and '.join(names)} in {folder}: IST_DATA_DIR names the folder that holds them")
    return files


def human_jaws():
    return jaws("human_maxilla", "human_mandible")


class MappedBody:
    """A body of a .vtp: points as placed (n, 3), their arrays, and triangles that index the points."""

    def __init__(self, data, body):
        arrays = data.GetPointData()
        of_points = vtk_to_numpy(arrays.GetArray("Body"))
        of_cells = vtk_to_numpy(data.GetCellData().GetArray("Body"))
        mine = of_points == body
        self.points = vtk_to_numpy(data.GetPoints().GetData())[mine].astype("f8")
        self.signed, self.triangle, self.sign_known = (
            vtk_to_numpy(arrays.GetArray(name))[mine] for name in ("Signed", "Triangle", "SignKnown"))
        cells = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)[of_cells == body]
        self.triangles = cells - np.flatnonzero(mine)[0]
        self.corners = self.points[self.triangles]
        self.near = ~np.isnan(self.signed)


# VTK.

class Surface:
    """Distances from a surface by VTK, float64."""

    def __init__(self, points, triangles):
        self.data = vtk.vtkPolyData()
        self.data.SetPoints(vtk_points(points))
        cells = vtk.vtkCellArray()
        offsets = np.arange(0, 3 * len(triangles) + 1, 3)
        cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=1),
                      numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles, "i8").ravel(), deep=1))
        self.data.SetPolys(cells)
        self.locator = vtk.vtkStaticCellLocator()
        self.locator.SetDataSet(self.data)
        self.locator.BuildLocator()
        self.implicit = vtk.vtkImplicitPolyDataDistance()
        self.implicit.SetInput(self.data)

    def nearest(self, points, reach):
        """Returns the distance and the nearest triangle of each point; infinite and -1 beyond the reach."""
        distances, triangles = np.full(len(points), np.inf), np.full(len(points), -1)
        at, cell, squared = [0.0, 0.0, 0.0], vtk.vtkGenericCell(), vtk.reference(0.0)
        triangle, part, inside = vtk.reference(0), vtk.reference(0), vtk.reference(0)
        for i, point in enumerate(points):
            if self.locator.FindClosestPointWithinRadius(point, reach, at, cell, triangle, part, squared, inside):
                distances[i], triangles[i] = squared.get() ** 0.5, triangle.get()
        return distances, triangles

    def signed(self, points):
        """Returns signed distances by vtkImplicitPolyDataDistance."""
        out = vtk.vtkDoubleArray()
        out.SetNumberOfTuples(len(points))
        self.implicit.FunctionValue(numpy_to_vtk(np.ascontiguousarray(points), deep=1), out)
        return vtk_to_numpy(out).copy()

    def encloses(self, points):
        """Returns whether each point lies inside, by vtkSelectEnclosedPoints, which casts rays."""
        cloud, select = vtk.vtkPolyData(), vtk.vtkSelectEnclosedPoints()
        cloud.SetPoints(vtk_points(points))
        select.SetInputData(cloud)
        select.SetSurfaceData(self.data)
        select.SetTolerance(1e-9)
        select.Update()
        return vtk_to_numpy(select.GetOutput().GetPointData().GetArray("SelectedPoints")) > 0


def vtk_points(points):
    out = vtk.vtkPoints()
    out.SetData(numpy_to_vtk(np.ascontiguousarray(points, "f8"), deep=1))
    return out


# numpy.

def on_triangle(p, corners):
    """Returns of each point the weights of the corners that give the nearest point of its triangle, (n, 3)."""
    p, (a, b, c) = p.astype("f8"), corners.astype("f8").transpose(1, 0, 2)
    best, least = np.zeros((len(p), 3)), np.full(len(p), np.inf)

    def offer(weights, where):
        at = weights[:, :1] * a + weights[:, 1:2] * b + weights[:, 2:] * c
        squared = ((p - at) ** 2).sum(1)
        better = where & (squared < least)
        best[better], least[better] = weights[better], squared[better]

    with np.errstate(invalid="ignore", divide="ignore"):
        for i, (u, v) in enumerate(((a, b), (b, c), (c, a))):
            along = ((p - u) * (v - u)).sum(1) / ((v - u) ** 2).sum(1)
            along = np.clip(np.nan_to_num(along), 0, 1)
            weights = np.zeros((len(p), 3))
            weights[:, i], weights[:, (i + 1) % 3] = 1 - along, along
            offer(weights, np.ones(len(p), bool))
        normal = np.cross(b - a, c - a)
        size = (normal ** 2).sum(1)
        weights = np.stack([(np.cross(v - p, w - p) * normal).sum(1) / size
                            for v, w in ((b, c), (c, a), (a, b))], axis=1)
        offer(np.nan_to_num(weights), (weights >= 0).all(1) & (size > 0))
    return best


def distance_from(p, corners):
    """Returns the distance of each point from its own triangle."""
    at = (on_triangle(p, corners)[:, :, None] * corners).sum(1)
    return np.linalg.norm(p - at, axis=1)


def winding_number(point, corners):
    """Returns how often a closed surface goes round a point: 1 inside, 0 outside."""
    a, b, c = (corners.astype("f8") - point).transpose(1, 0, 2)
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    above = (a * np.cross(b, c)).sum(1)
    below = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return np.arctan2(above, below).sum() / (2 * np.pi)
