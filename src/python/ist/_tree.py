"""Trees: bodies prepared for queries."""

import ctypes

import numpy as np

from ._arrays import address, count_of, number_of
from ._c import BuildOptions, TreeInfo
from ._errors import check, need_word, refuse_type
from ._follow import Follower
from ._handle import Handle, Out
from ._library import LIBRARY
from ._mesh import MeshHandle, handle_of, path_bytes

SPHERES = ("default", "simple", "table", "tight", "slab")
UNITS = ("unknown", "mm", "m", "inch", "µm")
FRAMES = ("unknown", "ras", "lps")


def spheres_number(name):
    """Returns the library's number of a kind of spheres."""
    need_word(name, SPHERES, "spheres")
    return SPHERES.index(name)


def spheres_name(number):
    """Returns the name of the spheres of a tree or a query; "none" without voxels."""
    return SPHERES[number] if number else "none"


class Tree(Handle):
    """A body prepared for queries, by build() or load(). It never changes; any number of threads may share it.

    It may be pickled, as the bytes of its file. Arrays that it gives are read-only.
    """

    _free = LIBRARY.ist_tree_free

    def __init__(self, handle):
        super().__init__(handle)
        self._arrays = {}
        info = TreeInfo()
        check(LIBRARY.ist_tree_get_info(handle, ctypes.addressof(info)))
        self._info = info

    voxel_size = property(lambda self: self._info.voxel_size, doc="The edge of a voxel, mesh units; 0 without voxels.")
    leaves = property(lambda self: self._info.leaves, doc="The number of voxels on the surface; 0 without voxels.")
    triangles = property(lambda self: self._info.triangles, doc="The number of triangles kept; 0: no exact answers.")
    depth = property(lambda self: self._info.depth, doc="Levels above the leaves; 0 without voxels.")
    nbytes = property(lambda self: self._info.bytes, doc="Memory in use, bytes.")
    spheres = property(
        lambda self: spheres_name(self._info.spheres),
        doc="The tightest bounds: simple, table, tight, slab; none without voxels.",
    )
    unit = property(lambda self: UNITS[self._info.unit], doc="The unit of its lengths, where it is known.")
    frame = property(lambda self: FRAMES[self._info.frame], doc="The frame that the mesh's file names: ras, lps, unknown.")
    outward = property(lambda self: bool(self._info.outward), doc="Whether the surface is closed, so that inside is known.")

    @property
    def self_intersections(self):
        """The number of pairs of its triangles that meet beyond the corners and edges that they share.

        Signs stay right if the surface is closed. The first call takes 1.2 µs a triangle.
        """

        pairs = ctypes.c_uint64()
        check(LIBRARY.ist_tree_self_intersections(self._need(), ctypes.addressof(pairs)))
        return pairs.value

    @property
    def prepared_for_depth(self):
        """Whether the tree has outer balls: prepare_depth()."""
        info = TreeInfo()
        check(LIBRARY.ist_tree_get_info(self._need(), ctypes.addressof(info)))
        return bool(info.prepared_for_depth)

    def prepare_depth(self, *, max_memory=1 << 30, progress=None):
        """Makes the outer balls of the body: if both bodies of a query have them, penetration() takes a 20th of the time.

        save() saves them. A body needs at most 28 bytes a triangle, and 9 to 18 µs, on all cores. Returns the tree.
        """
        with Follower(progress) as follower:
            status = LIBRARY.ist_tree_prepare_depth(self._need(), count_of(max_memory, "max_memory", least=1), follower.address)
            follower.finish(status)
        return self

    @property
    def origin(self):
        """The origin of the tree's frame, (3,), mesh coordinates. Torques are about the fixed tree's origin."""
        return self._kept("origin", lambda: np.array(self._info.origin))

    @property
    def vertices(self):
        """The vertices of its mesh, (V, 3) float64. Raises InputError where no triangles were kept."""
        return self._mesh()[0]

    @property
    def faces(self):
        """The triangles of its mesh, (T, 3) uint32, turned outward where the mesh was inside out."""
        return self._mesh()[1]

    @property
    def leaf_centres(self):
        """The centres of the voxels, (leaves, 3), mesh coordinates, in the order of the indices of leaf pairs."""

        def copy():
            centres = np.empty((self.leaves, 3))
            check(LIBRARY.ist_tree_copy_leaf_centres(self._need(), address(centres), len(centres)))
            return centres

        return self._kept("leaf_centres", copy)

    def save(self, path, *, progress=None):
        """Writes the tree's file, whole or not at all. Raises FileError.

        progress: called meanwhile; what it raises ends it, and is raised here. Where that comes while the finished file waits for
        the disk, it is too late: the new file is there all the same.
        """
        with Follower(progress) as follower:
            follower.finish(
                LIBRARY.ist_tree_save(self._need(), path_bytes(path, "path"), follower.address)
            )

    def to_bytes(self, *, progress=None):
        """Returns the bytes of the tree's file, for load(). progress: called meanwhile; what it raises ends it.

        >>> import ist
        >>> tree = ist.build(ist.jaws()[0], voxel_size=2)
        >>> ist.load(tree.to_bytes()).leaves == tree.leaves
        True
        """
        size = ctypes.c_uint64()

        def fill(memory, capacity):
            handle, place = self._need(), ctypes.addressof(size)
            follower.finish(LIBRARY.ist_tree_to_memory(handle, memory, capacity, follower.address, place))

        with Follower(progress) as follower:
            fill(None, 0)
            memory = ctypes.create_string_buffer(size.value)
            fill(memory, len(memory))
        return memory.raw

    def __reduce__(self):
        return load, (self.to_bytes(),)

    def __repr__(self):
        if self._handle is None:
            return "<ist.Tree, freed>"
        voxels = f"{self.leaves} voxels of {self.voxel_size:g} and " if self.leaves else ""
        kind = f", {self.spheres}" if self.leaves else ", no voxels"
        return f"<ist.Tree of {voxels}{self.triangles} triangles{kind}>"

    def _kept(self, name, make):
        self._need()
        array = self._arrays.get(name)
        if array is None:
            array = make()
            array.setflags(write=False)
            self._arrays[name] = array
        return array

    def _mesh(self):
        self._need()
        if "vertices" not in self._arrays:
            out = Out()
            check(LIBRARY.ist_tree_get_mesh(self._handle, out.address))
            vertices, faces = MeshHandle(out.handle).arrays()
            self._kept("faces", lambda: faces)
            self._kept("vertices", lambda: vertices)
        return self._arrays["vertices"], self._arrays["faces"]


def need_tree(tree, what):
    if not isinstance(tree, Tree):
        refuse_type(f"{what} is a {type(tree).__name__}: pass an ist.Tree, from ist.build or ist.load")


def build(
    mesh,
    voxel_size=0.0,
    *,
    spheres="default",
    keep_triangles=True,
    proximity=False,
    weld=True,
    frame="unknown",
    max_memory=4 << 30,
    progress=None,
):
    """Builds a tree from a mesh, on all cores.

    mesh: a path; (vertices, faces), (V, 3) and (T, 3), counter-clockwise seen from outside; or an object of another library
    with vertices and faces (trimesh, open3d, meshio, vtkPolyData). voxel_size: the edge of a voxel, mesh units, for leaf pairs
    and contacts; 0: no voxels, and triangles answer all else. spheres, proximity: of voxels.
    keep_triangles: for exact answers and all measures; a tree without voxels needs them.
    weld: vertices at exactly one position count as one; all keep their
    numbers. frame: "ras" or "lps"; a file that names the other one is turned into it, so that x and y change their signs.
    progress: called with the part of the build that is done, 0 while a
    file is read; what it raises ends both. Raises InputError, FileError, MemoryLimitError.

    >>> import ist
    >>> upper, lower = ist.jaws()
    >>> tree = ist.build(upper)
    >>> tree.leaves, tree.outward
    (0, True)
    >>> ist.build(upper, voxel_size=1).leaves
    21863
    """
    kind = spheres_number(spheres)
    need_word(frame, FRAMES, "frame")
    options = BuildOptions(
        voxel_size=number_of(voxel_size, "voxel_size"),
        spheres=kind,
        drop_triangles=int(not keep_triangles),
        proximity=int(bool(proximity)),
        no_weld=int(not weld),
        frame=FRAMES.index(frame),
        max_memory=count_of(max_memory, "max_memory", least=1),
    )
    source = handle_of(mesh, progress)
    with Follower(progress) as follower:
        options.progress = follower.pointer
        out = Out()
        status = LIBRARY.ist_tree_build(source._need(), ctypes.addressof(options), out.address)
        tree = None if status else Tree(out.handle)  # it owns the handle whatever finish() raises
        follower.finish(status)
    return tree


def load(source, *, progress=None):
    """Reads a tree from its file: a path, or its bytes. Every number in it is checked. progress: called meanwhile; what it
    raises ends that. Raises FileError, InputError.
    """
    out = Out()
    with Follower(progress) as follower:
        if isinstance(source, (bytes, bytearray, memoryview)):
            memory = np.frombuffer(source, np.uint8)
            status = LIBRARY.ist_tree_from_memory(address(memory), len(memory), follower.address, out.address)
        else:
            status = LIBRARY.ist_tree_load(path_bytes(source, "source"), follower.address, out.address)
        tree = None if status else Tree(out.handle)
        follower.finish(status)
    return tree
