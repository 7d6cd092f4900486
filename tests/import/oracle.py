"""glTF, GLB and 3DS as VTK reads them, beside `ist info --json`: triangles, box, volume.

usage: oracle.py IST FOLDER. The exit code is 77 without VTK.
"""

import json
import pathlib
import struct
import subprocess
import sys

try:
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkMassProperties, vtkTriangleFilter
    from vtkmodules.vtkIOGeometry import vtkGLTFReader
    from vtkmodules.vtkIOImport import vtk3DSImporter
except ImportError:
    print("python3-vtk9 is missing: run scripts/setup.sh --oracles")
    sys.exit(77)

POINTS = [(x, y, z) for z in (0, 3) for y in (0, 2) for x in (0, 1)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = [t for q in QUADS for t in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
BUFFER = b"".join(struct.pack("<3f", *p) for p in POINTS) + b"".join(struct.pack("<3H", *t) for t in TRIANGLES)


def gltf(nodes, uri=None):
    buffer = {"byteLength": len(BUFFER), **({"uri": uri} if uri else {})}
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [buffer],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 2, 3]},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]}).encode()


def glb(nodes):
    text = gltf(nodes)
    text += b" " * (-len(text) % 4)
    size = 28 + len(text) + len(BUFFER)
    return (struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON") + text
            + struct.pack("<I4s", len(BUFFER), b"BIN\0") + BUFFER)


def three_ds():
    def chunk(number, content):
        return struct.pack("<HI", number, 6 + len(content)) + content
    mesh = chunk(0x4110, struct.pack("<H", 8) + b"".join(struct.pack("<3f", *p) for p in POINTS))
    mesh += chunk(0x4120, struct.pack("<H", 12) + b"".join(struct.pack("<4H", *t, 7) for t in TRIANGLES))
    version = struct.pack("<I", 3)
    return chunk(0x4D4D, chunk(2, version) + chunk(0x3D3D, chunk(0x3D3E, version) + chunk(0x4000, b"box\0" + chunk(0x4100, mesh))))


def joined(parts):
    append = vtkAppendPolyData()
    for part in parts:
        append.AddInputData(part)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(append.GetOutputPort())
    triangles.Update()
    return triangles.GetOutput()


def by_vtk(file):
    if file.suffix == ".3ds":
        importer = vtk3DSImporter()
        importer.SetFileName(str(file))
        importer.Read()
        actors = importer.GetRenderer().GetActors()
        actors.InitTraversal()
        parts = []
        for _ in range(actors.GetNumberOfItems()):
            mapper = actors.GetNextActor().GetMapper()
            mapper.Update()
            parts.append(mapper.GetInput())
        return joined(parts)
    reader = vtkGLTFReader()
    reader.SetFileName(str(file))
    reader.Update()
    return joined(leaves(reader.GetOutput()))


def leaves(block):
    for i in range(block.GetNumberOfBlocks()):
        part = block.GetBlock(i)
        if isinstance(part, vtkCompositeDataSet):
            yield from leaves(part)
        elif part is not None:
            yield part


def main():
    ist, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "box.bin").write_bytes(BUFFER)
    nested = [{"translation": [10, 0, 0], "children": [1, 2]}, {"mesh": 0, "rotation": [0, 0, 0.6, 0.8], "scale": [2, 2, 2]},
              {"mesh": 0, "translation": [0, 9, 0], "rotation": [0.6, 0, 0, 0.8]}]
    files = {"plain.glb": glb([{"mesh": 0}]), "nested.glb": glb(nested), "beside.gltf": gltf(nested, "box.bin"), "box.3ds": three_ds()}
    wrong = []
    for name, content in files.items():
        file = folder / name
        file.write_bytes(content)
        said = subprocess.run([ist, "info", "--json", file], capture_output=True, text=True, check=True).stdout
        ours = json.loads(said.splitlines()[-1])
        theirs = by_vtk(file)
        volume = vtkMassProperties()
        volume.SetInputData(theirs)
        pairs = [(ours["triangles"], theirs.GetNumberOfPolys()), (ours["volume"], volume.GetVolume())]
        pairs += zip(ours["box_min"] + ours["box_max"], theirs.GetBounds()[::2] + theirs.GetBounds()[1::2])
        if any(abs(a - b) > 1e-5 * max(1, abs(b)) for a, b in pairs):
            wrong.append(f"{name}: ist and VTK differ: {pairs}")
        print(name, "is the same" if not wrong else wrong[-1])
    sys.exit("\n".join(wrong) if wrong else 0)


main()
