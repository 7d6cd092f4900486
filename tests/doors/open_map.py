"""Opens a map of `ist occlusion` as ParaView does, and says what it holds: open_map.py MAP.vtp"""

import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

reader = vtk.vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
jaws = reader.GetOutput()
points = jaws.GetPointData()
arrays = {points.GetArrayName(i) for i in range(points.GetNumberOfArrays())}
if reader.GetErrorCode() != 0 or not {"Signed", "Triangle", "SignKnown", "Body"} <= arrays:
    sys.exit(f"{sys.argv[1]}: error {reader.GetErrorCode()}, arrays {sorted(arrays)}")
signed, body = (vtk_to_numpy(points.GetArray(name)) for name in ("Signed", "Body"))
for number in (0, 1):
    near = signed[(body == number) & ~np.isnan(signed)]
    if len(near) < 1000 or not -2 < near.min() < 0:  # they bite, by less than 2 mm
        sys.exit(f"body {number}: {len(near)} vertices have a distance, the least is {near.min() if len(near) else None}")
    print(f"body {number}: {(body == number).sum()} vertices, {len(near)} near the other, the deepest {near.min():.3f} mm")
print(f"{jaws.GetNumberOfPolys()} triangles")
