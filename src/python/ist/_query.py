"""Queries: two trees, and the memory of their answers."""

import struct
import sys
import time

from ctypes import addressof, byref, c_double, c_int32, c_size_t, c_uint32, c_uint64, c_void_p

import numpy as np

from . import _measures
from ._answers import Contacts, Distance, LeafPairs, NearPairs, TrianglePairs, made
from ._arrays import Room, address, budget_of, count_of, floats, number_of
from ._c import (
    CONTACT,
    CONTACT_SUMS,
    IST_FOUND_KEPT,
    IST_MOST_NEAR_PARTS,
    LEAF_PAIR,
    NEAR_PAIR,
    TRIANGLE_PAIR,
    ContactSums,
    DistanceResult,
    NearPairsResult,
    QueryInfo,
    QueryOptions,
    QueryResult,
    TrianglePairsResult,
)
from ._errors import check, error_of, refuse
from ._handle import Lone, Out
from ._library import LIBRARY, bare
from ._tree import need_tree, spheres_name, spheres_number

_FLOAT64 = np.dtype(np.float64)
_ANSWERS = (None, False, None, True)  # IST_ANSWER_UNKNOWN, NO, NEAR, YES
_intersects, _leaf_pairs, _contacts = bare("ist_query_intersects"), bare("ist_query_leaf_pairs"), bare("ist_query_contacts")
_distance, _triangle_pairs = bare("ist_query_distance"), bare("ist_query_triangle_pairs")
_near_pairs, _near_parts = bare("ist_query_near_pairs"), bare("ist_query_near_parts")
_CODES = {c_double: "d", c_int32: "i", c_uint64: "Q"}
_FLAG = "?3x" if sys.byteorder == "little" else "3x?"  # a c_int32 of 0 or 1: one byte is read as a bool


def reader(record, members):
    """Returns a function that reads members of a struct at once, in their order. A flag ends in ?."""
    form, end, types = "=", 0, dict(record._fields_)
    for member in members.split():
        name = member.rstrip("?")
        place = getattr(record, name)
        gap = f"{place.offset - end}x" if place.offset > end else ""
        form += gap + (_CODES[types[name]] if member == name else _FLAG)
        end = place.offset + place.size
    return struct.Struct(form).unpack_from


read_leaf_pairs = reader(
    QueryResult,
    "leaf_pairs written sphere_tests complete? truncated? level distance_known? distance_lower distance_upper resolution "
    "rotation_error",
)
read_contacts = reader(QueryResult, "leaf_pairs contacts written sphere_tests complete? rotation_error")
_POINTS = DistanceResult.nearest_fixed.offset
_TRIANGLES = struct.Struct(f"={DistanceResult.nearest_triangles.offset}x2I").unpack_from
read_distance = reader(DistanceResult, "lower upper sphere_tests complete? nearest_known? narrowest rotation_error")
read_triangle_pairs = reader(TrianglePairsResult, "pairs written sphere_tests truncated? complete? rotation_error")
read_near_pairs = reader(NearPairsResult, "pairs written sphere_tests truncated? complete? found pad rotation_error")


def nearest_of(found):
    """Returns the nearest points of a DistanceResult, the direction, and the triangles, which do not change with it."""
    memory = bytearray(found)
    numbers = np.frombuffer(memory, np.float64, 9, _POINTS)  # nearest_fixed, nearest_moving and direction lie in a row
    return numbers[:3], numbers[3:6], numbers[6:], _TRIANGLES(memory)


def options_of(spheres, workers, contacts, margin, front_pairs, target, near_pairs=0):
    """Returns the library's options of a query, checked."""
    if workers not in (1, 2):
        refuse(f"workers is {workers!r}: pass 1 or 2")
    if contacts == 0:
        refuse("contacts is 0: pass a number of contacts, or -1 for none")
    most = -1 if contacts == -1 else count_of(contacts, "contacts", 4096)
    begins = number_of(margin, "margin")
    if not 0 <= begins <= 2:
        refuse(f"margin is {begins}: pass a number from 0, where surfaces meet, to 2 mean voxel sizes")
    return QueryOptions(
        spheres=spheres_number(spheres),
        workers=workers,
        contacts=most,
        target=None if target is None else str(target).encode("utf-8", "replace"),
        margin=begins,
        front_pairs=count_of(front_pairs, "front_pairs"),
        near_pairs=count_of(near_pairs, "near_pairs"),
    )


class Query(Lone):
    """Asks where two bodies are near each other, intersect and push each other, and how far apart they are.

    A pose is (4, 4) float64, row by row, and maps the moving body to the fixed one: p_fixed = pose @ p_moving. Lengths are in
    mesh units. `tests` and `seconds` limit one question; 0 is no limit. A query belongs to one thread at a time: another one
    gets a BusyError. Calls let other threads of Python run. Arrays given as `out` are filled in place.

    contacts: the most contacts, -1 for none. margin: the distance at which springs begin, 0 to 2 mean voxel
    sizes; 0: where surfaces meet. front_pairs, near_pairs: the most leaf pairs, and near pairs of triangles, that are kept in
    slow motion from pose to pose. workers: 2 for a resident thread that helps.

    >>> import ist, numpy as np
    >>> upper, lower = (ist.build(jaw) for jaw in ist.jaws())
    >>> query = ist.Query(upper, lower)
    >>> pose = np.eye(4)
    >>> pose[2, 3] = -1.5                                   # the lower jaw goes down by 1.5 mm
    >>> query.intersects(pose), query.intersects(np.eye(4))
    (False, True)
    >>> gap = query.distance(pose, tolerance=0.01)
    >>> gap.upper - gap.lower <= 0.01
    True
    """

    _free = LIBRARY.ist_query_free

    def __init__(
        self,
        fixed,
        moving,
        *,
        spheres="default",
        workers=1,
        contacts=32,
        margin=0.0,
        front_pairs=0,
        near_pairs=0,
        target=None,
    ):
        for tree, name in ((fixed, "fixed"), (moving, "moving")):
            need_tree(tree, name)
        options = options_of(spheres, workers, contacts, margin, front_pairs, target, near_pairs)
        out = Out()
        check(LIBRARY.ist_query_create(fixed._need(), moving._need(), addressof(options), out.address))
        super().__init__(out.handle)
        self.fixed, self.moving = fixed, moving
        self._info = QueryInfo()
        check(LIBRARY.ist_query_get_info(self._handle, addressof(self._info)))
        # Arguments that every call needs are made once, as bare functions take them.
        self._self = c_void_p(self._handle)
        pose = (c_double * 16)()
        self._by_row = np.frombuffer(pose).reshape(4, 4).T  # the library's numbers, row by row
        self._pose = byref(pose)
        self._pairs, self._points, self._triangles = Room(LEAF_PAIR), Room(CONTACT), Room(TRIANGLE_PAIR)
        self._near = Room(NEAR_PAIR)
        self._tolerance, self._margin = c_double(), c_double()
        self._found, self._sums, self._answer = QueryResult(), ContactSums(), c_int32()
        self._apart, self._met, self._listed = DistanceResult(), TrianglePairsResult(), NearPairsResult()
        self._found_at, self._sums_at, self._answer_at = byref(self._found), byref(self._sums), byref(self._answer)
        self._apart_at, self._met_at, self._listed_at = byref(self._apart), byref(self._met), byref(self._listed)

    spheres = property(lambda self: spheres_name(self._info.spheres), doc="The bounds in use; none without voxels.")
    target = property(lambda self: self._info.target.decode(), doc="The instruction set in use.")
    workers = property(lambda self: self._info.workers, doc="Threads that search, 1 or 2.")
    has_triangles = property(lambda self: bool(self._info.has_triangles), doc="Whether both trees have triangles.")
    nbytes = property(lambda self: self._info.bytes, doc="Memory reserved, bytes.")

    # Begins a call, which has to end with self._lock.release(): notes the pose, and returns what budget_of() does.
    def _begin(self, pose, tests, seconds):
        self._enter()
        try:
            if type(pose) is np.ndarray and pose.dtype is _FLOAT64 and pose.shape == (4, 4):
                self._by_row[...] = pose
            else:
                self._by_row[...] = floats(pose, (4, 4), "pose")
            return (None, None) if tests == 0 and seconds == 0 else budget_of(tests, seconds)
        except BaseException:
            self._lock.release()
            raise

    def intersects(self, pose, *, tests=0, seconds=0.0):
        """Whether the bodies intersect: exact where both trees have triangles.

        None is not a no: voxels overlap, and there are no triangles to ask, or a limit ended the search. False also where one
        body lies inside the other. p_fixed = pose @ p_moving.
        """
        budget, limit = self._begin(pose, tests, seconds)
        try:
            status = _intersects(self._self, self._pose, limit, self._answer_at)
            if status:
                raise error_of(status)
            return _ANSWERS[self._answer.value]
        finally:
            self._lock.release()

    def leaf_pairs(self, pose, *, out=None, most=None, tests=0, seconds=0.0):
        """All pairs of voxels whose bounds overlap. p_fixed = pose @ p_moving. Both trees need voxels.

        out: an array of LEAF_PAIR that is filled; `pairs` is a view of it. Without it the answer holds all pairs, or the
        first `most` of them.
        """
        budget, limit = self._begin(pose, tests, seconds)
        try:
            if out is None:
                out = self._room(LEAF_PAIR, most, budget, _leaf_pairs, limit, self._found, "leaf_pairs")
            else:
                room = self._pairs
                room.take(out)
                status = _leaf_pairs(self._self, self._pose, limit, room.place, room.length, self._found_at)
                if status:
                    raise error_of(status)
            count, written, tested, complete, truncated, level, known, lower, upper, resolution, off = read_leaf_pairs(self._found)
            distance = (lower, upper) if known else None
            return made(LeafPairs, (out[:written], count, complete, truncated, level, distance, resolution, tested, off))
        finally:
            self._lock.release()

    def triangle_pairs(self, pose, *, out=None, most=None, tests=0, seconds=0.0):
        """All pairs of triangles with a common point, exactly. p_fixed = pose @ p_moving. `out`, `most`: as leaf_pairs()."""
        budget, limit = self._begin(pose, tests, seconds)
        try:
            if out is None:
                out = self._room(TRIANGLE_PAIR, most, budget, _triangle_pairs, limit, self._met, "pairs")
            else:
                room = self._triangles
                room.take(out)
                status = _triangle_pairs(self._self, self._pose, limit, room.place, room.length, self._met_at)
                if status:
                    raise error_of(status)
            count, written, tested, truncated, complete, off = read_triangle_pairs(self._met)
            return made(TrianglePairs, (out[:written], count, complete, truncated, tested, off))
        finally:
            self._lock.release()

    def near_pairs(self, pose, margin, *, out=None, most=None, tests=0, seconds=0.0):
        """All pairs of triangles within a margin, mesh units, with their closest points.

        Pairs that intersect are among them. They are sorted by distance. p_fixed = pose @ p_moving. `out`, `most`: as
        leaf_pairs(). For a body that moves slowly, Query(near_pairs=2048) keeps pairs, and answers many times faster.

        >>> import ist, numpy as np
        >>> upper, lower = (ist.build(jaw, voxel_size=0.8) for jaw in ist.jaws())
        >>> near = ist.Query(upper, lower).near_pairs(np.eye(4), 0.1)
        >>> bool(near.complete and (near.pairs["distance"] <= 0.1 + near.pad).all())
        True
        """
        budget, limit = self._begin(pose, tests, seconds)
        try:
            self._margin.value = number_of(margin, "margin")
            if out is None:
                out = self._room(NEAR_PAIR, most, budget, _near_pairs, limit, self._listed, "pairs", self._margin)
            else:
                room = self._near
                room.take(out)
                status = _near_pairs(self._self, self._pose, self._margin, limit, room.place, room.length, self._listed_at)
                if status:
                    raise error_of(status)
            return self._made_near(out)
        finally:
            self._lock.release()

    def near_parts(self, pose, triangles, margin):
        """The parts of two triangles, (fixed, moving) by index, within a margin, mesh units.

        Each corner above the face of the other triangle, and of each two edges the closest points: 15 at most, sorted by
        distance. p_fixed = pose @ p_moving.
        """
        self._begin(pose, 0, 0.0)
        try:
            try:
                fixed, moving = triangles
            except (TypeError, ValueError):
                refuse(f"triangles is {triangles!r}: pass two indices, of the fixed and of the moving mesh")
            most = 2**32 - 1
            indices = c_uint32(count_of(fixed, "triangles[0]", most)), c_uint32(count_of(moving, "triangles[1]", most))
            self._margin.value = number_of(margin, "margin")
            out = np.empty(IST_MOST_NEAR_PARTS, NEAR_PAIR)
            place, length = c_void_p(address(out)), c_size_t(len(out))
            status = _near_parts(self._self, self._pose, *indices, self._margin, place, length, self._listed_at)
            if status:
                raise error_of(status)
            return self._made_near(out)
        finally:
            self._lock.release()

    # The last answer of near_pairs() or near_parts(), in an array.
    def _made_near(self, out):
        count, written, tested, truncated, complete, found, pad, off = read_near_pairs(self._listed)
        return made(NearPairs, (out[:written], count, complete, truncated, pad, found == IST_FOUND_KEPT, tested, off))

    # Asks once with some room, and again if there was too little: the member `count` of the result says how much it takes.
    # `before` stands before the limit in the arguments.
    def _room(self, dtype, most, budget, ask, limit, found, count, *before):
        room = 4096 if most is None else count_of(most, "most")
        end = time.monotonic_ns() + budget.nanoseconds if budget is not None and budget.nanoseconds > 0 else None
        while True:
            array = np.empty(room, dtype)
            status = ask(self._self, self._pose, *before, limit, c_void_p(address(array)), c_size_t(room), byref(found))
            if status:
                raise error_of(status)
            if most is not None or getattr(found, count) <= room:
                return array
            room = getattr(found, count)
            if end is not None:  # the limit holds for the whole call
                budget.nanoseconds = max(1, end - time.monotonic_ns())

    def contacts(self, pose, *, out=None, tests=0, seconds=0.0):
        """A few contacts, and the sums over all leaf pairs that forces are made of. p_fixed = pose @ p_moving.

        Both trees need voxels.

        out: an array of CONTACT that is filled.

        >>> import ist, numpy as np
        >>> upper, lower = (ist.build(jaw, voxel_size=0.8) for jaw in ist.jaws())
        >>> felt = ist.Query(upper, lower).contacts(np.eye(4))
        >>> force, torque, about = felt.wrench(stiffness=1.0)
        >>> bool(force[2] < 0)                                     # the lower jaw is pushed down
        True
        """
        budget, limit = self._begin(pose, tests, seconds)
        try:
            if out is None:
                out = np.empty(self._info.contacts, CONTACT)
            room = self._points
            room.take(out)
            status = _contacts(self._self, self._pose, limit, room.place, room.length, self._sums_at, self._found_at)
            if status:
                raise error_of(status)
            leaf_pairs, count, written, tested, complete, off = read_contacts(self._found)
            sums = self._sums
            return made(Contacts, (out[:written], count, complete, leaf_pairs, sums.weight, tested,
                                   np.frombuffer(bytearray(sums), CONTACT_SUMS), off))
        finally:
            self._lock.release()

    def distance(self, pose, tolerance=0.0, *, tests=0, seconds=0.0):
        """The distance between the surfaces, an interval no wider than the tolerance, and the nearest triangles that were found.

        p_fixed = pose @ p_moving. A body wholly inside another has a positive distance.

        >>> import ist, numpy as np
        >>> upper, lower = (ist.build(jaw, voxel_size=0.8) for jaw in ist.jaws())
        >>> pose = np.eye(4)
        >>> pose[2, 3] = -1.5
        >>> gap = ist.Query(upper, lower).distance(pose, 0.01)
        >>> bool(gap.lower <= np.linalg.norm(gap.nearest_moving - gap.nearest_fixed) <= gap.upper)
        True
        """
        budget, limit = self._begin(pose, tests, seconds)
        try:
            self._tolerance.value = number_of(tolerance, "tolerance")
            status = _distance(self._self, self._pose, self._tolerance, limit, self._apart_at)
            if status:
                raise error_of(status)
            lower, upper, tested, complete, known, narrowest, off = read_distance(self._apart)
            nearest = nearest_of(self._apart) if known else (None, None, None, None)
            return made(Distance, (lower, upper, complete, narrowest, tested, off, *nearest))
        finally:
            self._lock.release()

    def forget(self):
        """Forgets what earlier poses left behind: the next answers are those of a new query."""
        handle = self._enter()
        try:
            check(LIBRARY.ist_query_forget(handle))
        finally:
            self._lock.release()

    penetration = _measures.penetration
    escape = _measures.escape
    first_contact = _measures.first_contact
    settle = _measures.settle
    occlusion = _measures.occlusion_of
    rows = _measures.rows

    def __repr__(self):
        if self._handle is None:
            return "<ist.Query, freed>"
        return f"<ist.Query of {self.fixed!r} and {self.moving!r}, {self.spheres}, {self.target}>"
