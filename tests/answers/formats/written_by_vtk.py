#!/usr/bin/env python3
"""Writes PolyData with VTK in every form, reads each file with VTK and with IST, and compares all triangles.

    written_by_vtk.py READ_MESHES FOLDER

    READ_MESHES  the program that reads meshes as IST does
    FOLDER       for what is made on the way; is emptied first

Where VTK is missing, that is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it is 1. Runs by Debian's python3, for which
scripts/setup.sh --oracles installs VTK.
"""
import itertools
import os
import pathlib
import shutil
import subprocess
import sys


def need():
    try:
        __import__("numpy")
        __import__("vtkmodules.all")
    except ImportError as missing:
        print(f"written_by_vtk: {missing}; scripts/setup.sh --oracles installs it, for /usr/bin/python3", file=sys.stderr)
        sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)


def output(source):
    source.Update()
    data = vtk.vtkPolyData()
    data.DeepCopy(source.GetOutput())
    return data


def sphere():
    source = vtk.vtkSphereSource()
    source.SetThetaResolution(13)
    source.SetPhiResolution(11)
    source.SetRadius(7.3)
    return source


def strips():
    stripper = vtk.vtkStripper()
    stripper.SetInputData(output(sphere()))
    return output(stripper)


def box(precision):
    source = vtk.vtkCubeSource()
    source.SetXLength(1.1)
    source.SetOutputPointsPrecision(precision)
    return output(source)


def everything():
    """Vertices, lines, polygons and strips, with arrays of every type."""
    parts = vtk.vtkAppendPolyData()
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(box(0))
    glyph = vtk.vtkVertexGlyphFilter()
    glyph.SetInputData(box(0))
    for part in (output(edges), output(glyph), box(0), strips()):
        parts.AddInputData(part)
    data = output(parts)
    for kind in ("Bit", "Char", "SignedChar", "UnsignedChar", "Short", "UnsignedShort", "Int", "UnsignedInt", "Long",
                 "UnsignedLong", "LongLong", "UnsignedLongLong", "IdType", "Float", "Double"):
        for attributes, count in ((data.GetCellData(), data.GetNumberOfCells()), (data.GetPointData(), data.GetNumberOfPoints())):
            array = getattr(vtk, f"vtk{kind}Array")()
            array.SetName(f"a {kind}%")
            array.SetNumberOfTuples(count)
            for i in range(count):
                array.SetVariantValue(i, vtk.vtkVariant(i % 2))
            attributes.AddArray(array)
    scalars = vtk.vtkUnsignedCharArray()
    scalars.SetName("colours")
    scalars.SetNumberOfComponents(3)
    scalars.SetNumberOfTuples(data.GetNumberOfPoints())
    scalars.Fill(10)
    data.GetPointData().SetScalars(scalars)
    data.GetPoints().GetData().GetRange(-1)  # is written as metadata
    text = vtk.vtkStringArray()
    text.SetName("remark")
    for line in ("", "two\nlines", "x" * 300):
        text.InsertNextValue(line)
    data.GetFieldData().AddArray(text)
    return data


def with_frame(data, name):
    text = vtk.vtkStringArray()
    text.SetName("SPACE")
    text.InsertNextValue(name)
    data.GetFieldData().AddArray(text)
    return data


def write_legacy(data, folder, name):
    for version, binary in itertools.product((42, 51), (False, True)):
        writer = vtk.vtkPolyDataWriter()
        writer.SetFileVersion(version)
        if binary:
            writer.SetFileTypeToBinary()
        else:
            writer.SetFileTypeToASCII()
        file = folder / f"{name}-{version}-{'binary' if binary else 'ascii'}.vtk"
        writer.SetFileName(str(file))
        writer.SetInputData(data)
        assert writer.Write() == 1
        yield file


def write_xml(data, folder, name):
    forms = itertools.product(("Ascii", "Binary", "Appended", "Encoded"), ("None", "ZLib"), ("32", "64"), ("Little", "Big"))
    for mode, packed, header, order in forms:
        writer = vtk.vtkXMLPolyDataWriter()
        getattr(writer, f"SetDataModeTo{mode.replace('Encoded', 'Appended')}")()
        writer.SetEncodeAppendedData(mode == "Encoded")
        getattr(writer, f"SetCompressorTypeTo{packed}")()
        getattr(writer, f"SetHeaderTypeToUInt{header}")()
        getattr(writer, f"SetByteOrderTo{order}Endian")()
        writer.SetBlockSize(1024)
        file = folder / f"{name}-{mode}-{packed}-{header}-{order}.vtp"
        writer.SetFileName(str(file))
        writer.SetInputData(data)
        assert writer.Write() == 1
        yield file


def cells_of(array):
    offsets, corners = vtk_to_numpy(array.GetOffsetsArray()), vtk_to_numpy(array.GetConnectivityArray())
    return [corners[begin:end] for begin, end in zip(offsets, offsets[1:])]


def faces_by_vtk(file):
    """The corners of each polygon, then of each triangle of strips, in double."""
    reader = vtk.vtkPolyDataReader() if file.suffix == ".vtk" else vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(file))
    data = output(reader)
    points = vtk_to_numpy(data.GetPoints().GetData()).astype("f8")
    faces = [points[cell] for cell in cells_of(data.GetPolys())]
    for strip in cells_of(data.GetStrips()):
        for i in range(len(strip) - 2):
            a, b, c = strip[i:i + 3]
            faces.append(points[[a, b, c] if i % 2 == 0 else [b, a, c]])
    return faces


def area_vector(polygon):
    return sum(np.cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]) for i in range(1, len(polygon) - 1))


def compare(file):
    triangles = np.fromfile(f"{file}.corners").reshape(-1, 3, 3)
    at = 0
    for face in faces_by_vtk(file):
        mine = triangles[at:at + len(face) - 2]
        at += len(mine)
        if len(face) == 3:
            np.testing.assert_array_equal(mine[0], face + 0.0, file.name)
            continue
        assert {tuple(p) for p in mine.reshape(-1, 3)} == {tuple(p) for p in face + 0.0}, file
        np.testing.assert_allclose(sum(map(area_vector, mine)), area_vector(face), rtol=1e-12, atol=1e-12, err_msg=file.name)
    assert at == len(triangles), f"{file}: {at} of {len(triangles)}"


def main(read_meshes, folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    samples = {"sphere": with_frame(output(sphere()), "RAS"), "strips": strips(), "box": with_frame(box(1), "LPS"),
               "everything": everything()}
    files = []
    for name, data in samples.items():
        files += [*write_legacy(data, folder, name), *write_xml(data, folder, name)]
    run = subprocess.run([read_meshes, *map(str, files)], check=True, stdout=subprocess.PIPE, universal_newlines=True)
    frames = {"sphere": "RAS", "box": "LPS"}
    for file, frame in zip(files, run.stdout.split("\n")):
        compare(file)
        assert frame == frames.get(file.name.split("-")[0], ""), f"{file}: {frame}"
    print(f"{len(files)} files are read alike")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    need()
    import numpy as np
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import vtk_to_numpy
    main(*sys.argv[1:])
