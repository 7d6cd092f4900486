#!/usr/bin/env python3
"""Reads with one other tool the files that the command's writers write, and compares every number with the source's.

    read_back.py vtk|meshio|csv WRITE_SAMPLES IST FOLDER

    WRITE_SAMPLES  the program that writes samples, and their numbers before they were written
    IST            the ist command, whose exports are read too
    FOLDER         for what is made on the way; is emptied first

Where the tool is missing, that is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it is 1. Runs by Debian's
python3, for which scripts/setup.sh --oracles installs the tools.
"""
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

PACKAGES = {"vtk": "vtkmodules.all", "meshio": "meshio", "csv": "csv"}


def need(tool):
    try:
        __import__("numpy")
        __import__(PACKAGES[tool])
    except ImportError as missing:
        print(f"read_back: {missing}; scripts/setup.sh --oracles installs it, for /usr/bin/python3", file=sys.stderr)
        sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)


class Expected:
    """The numbers of one sample, as arrays; points rounded to float, as the files hold them."""

    def __init__(self, content):
        self.points = np.array(content["points"]).astype("f4")
        self.polygons = np.array(content["polygons"], "i4").reshape(-1, content["corners"])
        self.normals = np.array(content["normals"], "f4").reshape(-1, 3)
        self.colours = np.array(content["colours"], "u1").reshape(-1, 3)
        self.point_arrays, self.cell_arrays = (
            {name: np.array([math.nan if x is None else x for x in array["numbers"]], array["kind"])
             .reshape(-1, array["components"]) for name, array in content[of].items()}
            for of in ("point_arrays", "cell_arrays"))
        self.bodies = [body["name"] for body in content["bodies"]]
        self.counts = [body["points"] for body in content["bodies"]]

    def body(self, i):
        """Its points' places among all, and its triangles, which count from its first point."""
        first = sum(self.counts[:i])
        mine = slice(first, first + self.counts[i])
        faces = self.polygons[(self.polygons >= mine.start).all(1) & (self.polygons < mine.stop).all(1)] - first
        if faces.shape[1] == 4:
            faces = np.stack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]], axis=1).reshape(-1, 3)
        return mine, faces


def same(what, found, expected):
    """Every number, bit for bit; where it is no number, neither must the other be."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, f"{what}: {found.shape} for {expected.shape}"
    assert found.dtype.itemsize >= expected.dtype.itemsize, f"{what}: {found.dtype} for {expected.dtype}"
    np.testing.assert_array_equal(found, expected, what)


def same_kind(what, found, expected):
    same(what, found, expected)
    assert found.dtype == expected.dtype, f"{what}: {found.dtype} for {expected.dtype}"


def close(what, found, expected):
    """Numbers that the reader has computed with, in float."""
    found, expected = np.asarray(found, "f8"), np.asarray(expected, "f8")
    assert found.shape == expected.shape, f"{what}: {found.shape} for {expected.shape}"
    np.testing.assert_allclose(found, expected, rtol=3e-7, atol=1e-7 * np.abs(expected).max(), err_msg=what)


def turned(points, metres):
    """The places of points in a GLB: up is y, in metres."""
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1).astype("f8") * metres


# VTK: .vtp, .ply and .glb.

def vtk_output(reader, file):
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
    reader.SetFileName(str(file))
    reader.Update()
    assert not errors, f"VTK complains of {file}"
    return reader.GetOutput()


def vtk_cells(cells):
    if cells.GetNumberOfCells() == 0:
        return np.empty((0, 0), "i8")
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(cells.GetNumberOfCells(), -1)


def vtk_arrays(attributes):
    arrays = (attributes.GetArray(i) for i in range(attributes.GetNumberOfArrays()))
    return {a.GetName(): vtk_to_numpy(a).reshape(-1, a.GetNumberOfComponents()) for a in arrays}


def vtk_vtp(file, expected):
    data = vtk_output(vtk.vtkXMLPolyDataReader(), file)
    same_kind("points", vtk_to_numpy(data.GetPoints().GetData()), expected.points)
    if len(expected.polygons):
        same("polygons", vtk_cells(data.GetPolys()), expected.polygons)
    else:
        same("vertices", vtk_cells(data.GetVerts()), np.arange(len(expected.points)).reshape(-1, 1))
    assert data.GetNumberOfCells() == (len(expected.polygons) or len(expected.points))
    arrays = dict(expected.point_arrays)
    if len(expected.colours):
        arrays["RGB"] = expected.colours
    if len(expected.normals):
        arrays["Normals"] = expected.normals
        assert data.GetPointData().GetNormals().GetName() == "Normals"
    for found, wanted in ((vtk_arrays(data.GetPointData()), arrays), (vtk_arrays(data.GetCellData()), expected.cell_arrays)):
        assert sorted(found) == sorted(wanted), f"{file}: {sorted(found)}"
        for name, numbers in wanted.items():
            same_kind(f"{file} {name}", found[name], numbers)


def vtk_ply(file, expected):
    """VTK passes over the properties that it does not know."""
    data = vtk_output(vtk.vtkPLYReader(), file)
    same_kind("points", vtk_to_numpy(data.GetPoints().GetData()), expected.points)
    if len(expected.polygons):
        same("polygons", vtk_cells(data.GetPolys()), expected.polygons)
    found = vtk_arrays(data.GetPointData())
    if len(expected.colours):
        same_kind("colours", found["RGB"], expected.colours)
    if len(expected.normals):
        same_kind("normals", found["Normals"], expected.normals)


def vtk_meshes(block):
    """Each mesh that is drawn, in the order of the nodes."""
    if block is not None and not block.IsA("vtkMultiBlockDataSet"):
        yield block
    elif block is not None:
        for i in range(block.GetNumberOfBlocks()):
            yield from vtk_meshes(block.GetBlock(i))


def linear(srgb):
    """The shares of light of sRGB colours (IEC 61966-2-1), in 16 bits."""
    return np.rint(65535 * np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)) / 65535


def vtk_glb(file, expected, metres):
    meshes = list(vtk_meshes(vtk_output(vtk.vtkGLTFReader(), file)))
    assert len(meshes) == len(expected.bodies)
    for i, data in enumerate(meshes):
        mine, faces = expected.body(i)
        close("points", vtk_to_numpy(data.GetPoints().GetData()), turned(expected.points[mine], metres))
        if len(faces):
            same("triangles", vtk_cells(data.GetPolys()), faces)
        found = vtk_arrays(data.GetPointData())
        if len(expected.normals):
            close("normals", found["NORMAL"], turned(expected.normals[mine], 1))
        if len(expected.colours):
            close("colours", found["COLOR_0"][:, :3], linear(expected.colours[mine] / 255))


def vtk_samples(folder, expected, samples):
    for name, sample in samples.items():
        vtk_vtp(folder / f"{name}.vtp", sample)
        vtk_ply(folder / f"{name}.ply", sample)
        vtk_glb(folder / f"{name}.glb", sample, expected["metres_per_unit"])


def vtk_exports(folder):
    """The three files of an export hold the same cubes, and the two of spheres the same spheres."""
    vtp = vtk_output(vtk.vtkXMLPolyDataReader(), folder / "voxels.vtp")
    ply = vtk_output(vtk.vtkPLYReader(), folder / "voxels.ply")
    points, quads = vtk_to_numpy(vtp.GetPoints().GetData()), vtk_cells(vtp.GetPolys())
    same("points", vtk_to_numpy(ply.GetPoints().GetData()), points)
    same("quads", vtk_cells(ply.GetPolys()), quads)
    assert len(np.unique(points, axis=0)) == len(points), "a corner is there twice"
    feature = vtk.vtkFeatureEdges()
    feature.SetInputData(vtp)
    feature.FeatureEdgesOff()
    feature.NonManifoldEdgesOff()
    feature.Update()
    assert feature.GetOutput().GetNumberOfCells() == 0, "the cubes' surface has a border"
    (glb,) = vtk_meshes(vtk_output(vtk.vtkGLTFReader(), folder / "voxels.glb"))
    close("points", vtk_to_numpy(glb.GetPoints().GetData()), turned(points, 0.0254))
    same("triangles", vtk_cells(glb.GetPolys()).reshape(-1, 6), quads[:, [0, 1, 2, 0, 2, 3]])
    spheres = vtk_output(vtk.vtkXMLPolyDataReader(), folder / "spheres.vtp")
    assert spheres.GetNumberOfVerts() == spheres.GetNumberOfPoints() > 0
    assert vtk_arrays(spheres.GetPointData())["radius"].min() > 0
    bounds = np.array(vtp.GetBounds()).reshape(3, 2)
    centres = vtk_to_numpy(spheres.GetPoints().GetData())
    assert (centres > bounds[:, 0]).all() and (centres < bounds[:, 1]).all()


# meshio: .ply; it reads no .vtp and no .glb.

def meshio_ply(file, expected):
    mesh = meshio.read(file)
    same_kind("points", mesh.points, expected.points)
    if len(expected.polygons):
        (cells,) = mesh.cells
        assert cells.type == {3: "triangle", 4: "quad"}[expected.polygons.shape[1]]
        same("polygons", cells.data, expected.polygons)
    else:
        assert not mesh.cells
    wanted = {}
    for names, columns in ((("nx", "ny", "nz"), expected.normals), (("red", "green", "blue"), expected.colours)):
        if len(columns):
            wanted.update(zip(names, columns.T))
    for name, columns in expected.point_arrays.items():
        parts = {1: [""], 3: ["_x", "_y", "_z"]}.get(columns.shape[1]) or [f"_{i}" for i in range(columns.shape[1])]
        wanted.update(zip([name.lower() + part for part in parts], columns.T))
    assert sorted(mesh.point_data) == sorted(wanted), f"{file}: {sorted(mesh.point_data)}"
    for name, numbers in wanted.items():
        found = mesh.point_data[name]
        if numbers.dtype == "u1":
            found = found.view("u1")  # meshio 5.0.0 reads uchar with a sign
        same_kind(f"{file} {name}", found, numbers)


def meshio_samples(folder, _, samples):
    for name, sample in samples.items():
        meshio_ply(folder / f"{name}.ply", sample)


def meshio_exports(folder):
    voxels, spheres = meshio.read(folder / "voxels.ply"), meshio.read(folder / "spheres.ply")
    assert [cells.type for cells in voxels.cells] == ["quad"]
    assert list(spheres.point_data) == ["radius"] and spheres.point_data["radius"].min() > 0


# Python's csv.

def csv_samples(folder, expected, _):
    table = expected["table"]
    with open(folder / "table.csv", newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file, strict=True)
    assert header == table["columns"], header
    assert [row[0] for row in rows] == table["names"], rows
    same("floats", np.array([row[1] for row in rows]).astype("f4"), np.array(table["floats"], "f4"))
    numbers = [math.nan if x is None else x for x in table["numbers"]]
    same("numbers", np.array([float(row[2]) for row in rows]), np.array(numbers))


def main(tool, write_samples, ist, folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    subprocess.run([write_samples, folder], check=True)
    expected = json.loads((folder / "expected.json").read_text())
    samples = {name: Expected(content) for name, content in expected["files"].items()}
    globals()[f"{tool}_samples"](folder, expected, samples)
    if tool == "csv":
        return

    def run(*arguments):
        subprocess.run([ist, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    run("demo", "--keep", folder, "--voxel-size", 8)
    run("build", folder / "lower_jaw.stl", "-o", folder / "jaw.ist", "--voxel-size", 2)
    for name, more in (("voxels.vtp", []), ("voxels.ply", []), ("voxels.glb", ["--unit", "inch"]), ("spheres.vtp", []), ("spheres.ply", [])):
        run("export", folder / "jaw.ist", "--what", name.split(".")[0], "--level", 1, "-o", folder / name, *more)
    globals()[f"{tool}_exports"](folder)


if __name__ == "__main__":
    if len(sys.argv) != 5 or sys.argv[1] not in PACKAGES:
        sys.exit(__doc__)
    need(sys.argv[1])
    import numpy as np

    if sys.argv[1] == "vtk":
        import vtkmodules.all as vtk
        from vtkmodules.util.numpy_support import vtk_to_numpy
    elif sys.argv[1] == "meshio":
        import meshio
    main(*sys.argv[1:])
