"""Meshes as a pair of arrays, from files and from the objects of other libraries."""

import ctypes
import os

import numpy as np

from ._arrays import address, count_of, floats, indices
from ._errors import check, refuse
from ._follow import Follower
from ._handle import Handle, Out
from ._library import LIBRARY


class MeshHandle(Handle):
    """A mesh of the library, for the time of a call."""

    _free = LIBRARY.ist_mesh_free

    def arrays(self):
        """Returns the vertices, (V, 3) float64, and the triangles, (T, 3) uint32."""
        points, triangles = ctypes.c_uint64(), ctypes.c_uint64()
        check(LIBRARY.ist_mesh_get_size(self._need(), ctypes.addressof(points), ctypes.addressof(triangles)))
        vertices = np.empty((points.value, 3))
        faces = np.empty((triangles.value, 3), np.uint32)
        check(LIBRARY.ist_mesh_copy(self._handle, address(vertices), len(vertices), address(faces), len(faces)))
        return vertices, faces


def path_bytes(path, what):
    """Returns a path as the library takes it."""
    name = os.fsencode(path)
    if b"\0" in name:
        refuse(f"{what} has a zero in its name: {path!r}")
    return name


def made(create, *arguments):
    out = Out()
    check(create(*arguments, out.address))
    return MeshHandle(out.handle)


def read(path, what, progress):
    """Returns the library's mesh of a file."""
    out = Out()
    with Follower(progress) as follower:
        status = LIBRARY.ist_mesh_read(path_bytes(path, what), follower.address, out.address)
        mesh = None if status else MeshHandle(out.handle)  # it owns the handle whatever finish() raises
        follower.finish(status)
    return mesh


def of_vtk(data):
    """The points and triangles of a vtkPolyData; polygons with more corners are refused."""
    points, cells = data.GetPoints(), data.GetPolys()
    if points is None or cells is None or cells.GetNumberOfCells() == 0:
        refuse("the vtkPolyData has no polygons: pass a surface")
    if cells.GetMaxCellSize() != 3:
        refuse("the vtkPolyData has polygons that are no triangles: put it through vtkTriangleFilter")
    from vtkmodules.util.numpy_support import vtk_to_numpy  # only where a vtkPolyData came from

    connectivity = vtk_to_numpy(cells.GetConnectivityArray())
    if len(connectivity) != 3 * cells.GetNumberOfCells():
        refuse("the vtkPolyData has polygons that are no triangles: put it through vtkTriangleFilter")
    return vtk_to_numpy(points.GetData()), connectivity.reshape(-1, 3)


def of_meshio(mesh):
    """The points and triangles of a meshio.Mesh; other cells are refused where there are no triangles."""
    triangles = mesh.cells_dict.get("triangle")
    if triangles is None or len(triangles) == 0:
        refuse(f"the mesh has no cells of the type triangle, but {sorted(mesh.cells_dict) or 'none'}: triangulate it")
    return mesh.points, triangles


def arrays_of(mesh):
    """The vertices and faces of a pair of arrays or of another library's object, as they are."""
    if isinstance(mesh, (tuple, list)):
        if len(mesh) != 2:
            refuse(f"a mesh of {len(mesh)} parts: pass (vertices, faces)")
        return mesh
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):  # trimesh and many others
        return mesh.vertices, mesh.faces
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):  # open3d
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if hasattr(mesh, "points") and hasattr(mesh, "cells_dict"):
        return of_meshio(mesh)
    if hasattr(mesh, "GetPolys") and hasattr(mesh, "GetPoints"):
        return of_vtk(mesh)
    return refuse(
        f"a {type(mesh).__name__} is no mesh: pass a path, (vertices, faces), or an object with vertices and faces, "
        "such as trimesh's, meshio's or a vtkPolyData"
    )


def handle_of(mesh, progress=None):
    """Returns the library's copy of a mesh: a path, a pair of arrays, or an object of another library."""
    if isinstance(mesh, (str, bytes, os.PathLike)):
        return read(mesh, "mesh", progress)
    vertices, faces = arrays_of(mesh)
    triangles = indices(faces, "faces")
    single = isinstance(vertices, np.ndarray) and vertices.dtype == np.float32
    points = floats(vertices, (None, 3), "vertices", np.float32 if single else np.float64)
    create = LIBRARY.ist_mesh_create_float if single else LIBRARY.ist_mesh_create
    return made(create, address(points), len(points), address(triangles), len(triangles))


def read_mesh(path, *, progress=None):
    """Reads a mesh file: returns vertices, (V, 3) float64, and faces, (T, 3) uint32.

    STL, PLY, OBJ, OFF and VTK PolyData; by the program ist-import glTF, 3MF, COLLADA, FBX, X3D, AMF, 3DS, AC3D and LightWave.

    Vertices with equal coordinates are merged. The arrays have no unit and no frame: build() of a path keeps those that
    the file states. progress: called while the file is read; what it raises ends that. Raises
    FileError and InputError, which name the file and the place.
    """
    return read(path, "path", progress).arrays()


def jaws(seed=1):
    """Makes two human jaws from nothing: (vertices, faces) of the upper and of the lower one, in millimetres.

    Both share a frame, in which they are closed on each other. One seed gives the same bytes on every machine.

    >>> import ist
    >>> (upper, _), (lower, faces) = ist.jaws()
    >>> faces.shape, faces.dtype
    ((119096, 3), dtype('uint32'))
    """
    number = count_of(seed, "seed")
    return tuple(made(LIBRARY.ist_jaw_create, jaw, number).arrays() for jaw in (1, 0))
