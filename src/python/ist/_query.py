"""Queries: two trees, and the memory of their answers."""

import ctypes
import time

from ctypes import addressof

import numpy as np

from . import _measures
from ._answers import Contacts, Distance, LeafPairs, TrianglePairs
from ._arrays import address, budget_of, count_of, floats, number_of, place_of
from ._errors import check, error_of, refuse
from ._handle import Lone, Out
from ._library import LIBRARY
from ._records import (
    CONTACT,
    CONTACT_SUMS,
    LEAF_PAIR,
    TRIANGLE_PAIR,
    ContactSums,
    DistanceResult,
    QueryInfo,
    QueryOptions,
    QueryResult,
    TrianglePairsResult,
)
from ._tree import SPHERES, need_tree, spheres_number

_ANSWERS = (None, False, None, True)  # IST_ANSWER_UNKNOWN, NO, NEAR, YES
_leaf_pairs, _contacts, _distance = LIBRARY.ist_query_leaf_pairs, LIBRARY.ist_query_contacts, LIBRARY.ist_query_distance
_intersects, _triangle_pairs = LIBRARY.ist_query_intersects, LIBRARY.ist_query_triangle_pairs


def options_of(spheres, workers, contacts, push_distance, front_pairs, target):
    """Returns the library's options of a query, checked."""
    if workers not in (1, 2):
        refuse(f"workers is {workers!r}: pass 1 or 2")
    if contacts == 0:
        refuse("contacts is 0: pass a number of contacts, or -1 for none")
    most = -1 if contacts == -1 else count_of(contacts, "contacts", 4096)
    push = number_of(push_distance, "push_distance")
    if not 0 <= push <= 2:
        refuse(f"push_distance is {push}: pass a number from 0 to 2, mean voxel sizes")
    return QueryOptions(
        spheres=spheres_number(spheres),
        workers=workers,
        contacts=most,
        target=None if target is None else str(target).encode("utf-8", "replace"),
        push_distance=-1 if push == 0 else push,
        front_pairs=count_of(front_pairs, "front_pairs"),
    )


class Query(Lone):
    """Asks where two bodies are near each other, intersect and push each other, and how far apart they are.

    A pose is (4, 4) float64, row by row, and maps the moving body to the fixed one: p_fixed = pose @ p_moving. Lengths are in
    mesh units. `tests` and `seconds` limit one question; 0 is no limit. A query belongs to one thread at a time: another one
    gets a BusyError. Calls let other threads of Python run. Arrays given as `out` are filled in place.

    contacts: the most contacts, -1 for none. push_distance: where springs begin, mean voxel sizes before the surfaces meet,
    0 to 2. front_pairs: leaf pairs kept in slow motion, from pose to pose. workers: 2 for a resident thread that helps.

    >>> import ist, numpy as np
    >>> upper, lower = (ist.build(jaw, voxel_size=0.8) for jaw in ist.jaws())
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
        push_distance=2.0,
        front_pairs=0,
        target=None,
    ):
        for tree, name in ((fixed, "fixed"), (moving, "moving")):
            need_tree(tree, name)
        options = options_of(spheres, workers, contacts, push_distance, front_pairs, target)
        out = Out()
        check(LIBRARY.ist_query_create(fixed._need(), moving._need(), addressof(options), out.address))
        super().__init__(out.handle)
        self.fixed, self.moving = fixed, moving
        self._info = QueryInfo()
        check(LIBRARY.ist_query_get_info(self._handle, addressof(self._info)))
        # Arguments that every call needs are made once.
        self._pose = np.eye(4)
        self._pose_at = address(self._pose)
        self._by_row = self._pose.T  # the same numbers, row by row
        self._found = QueryResult()
        self._found_at = addressof(self._found)
        self._sums = ContactSums()
        self._sums_at = addressof(self._sums)
        self._answer = ctypes.c_int32()
        self._answer_at = addressof(self._answer)
        self._apart = DistanceResult()
        self._apart_at = addressof(self._apart)
        self._met = TrianglePairsResult()
        self._met_at = addressof(self._met)

    spheres = property(lambda self: SPHERES[self._info.spheres], doc="The bounds in use.")
    target = property(lambda self: self._info.target.decode(), doc="The instruction set in use.")
    workers = property(lambda self: self._info.workers, doc="Threads that search, 1 or 2.")
    has_triangles = property(lambda self: bool(self._info.has_triangles), doc="Whether both trees have triangles.")
    nbytes = property(lambda self: self._info.bytes, doc="Memory reserved, bytes.")

    # Copies a pose to the place that calls read it from.
    def _take(self, pose):
        if type(pose) is np.ndarray and pose.shape == (4, 4) and pose.dtype == np.float64:
            self._by_row[...] = pose
        else:
            self._by_row[...] = floats(pose, (4, 4), "pose")

    def intersects(self, pose, *, tests=0, seconds=0.0):
        """Whether the bodies intersect: exact where both trees have triangles.

        None: voxels overlap, and there are no triangles to ask, or a limit ended the search. False also where one body lies
        inside the other. p_fixed = pose @ p_moving.
        """
        handle = self._enter()
        try:
            self._take(pose)
            budget, limit = budget_of(tests, seconds)
            status = _intersects(handle, self._pose_at, limit, self._answer_at)
            if status:
                raise error_of(status)
            return _ANSWERS[self._answer.value]
        finally:
            self._lock.release()

    def leaf_pairs(self, pose, *, out=None, most=None, tests=0, seconds=0.0):
        """All pairs of voxels whose bounds overlap. p_fixed = pose @ p_moving.

        out: an array of LEAF_PAIR that is filled; `pairs` is a view of it. Without it the answer holds all pairs, or the
        first `most` of them.
        """
        handle = self._enter()
        try:
            self._take(pose)
            budget, limit = budget_of(tests, seconds)
            found = self._found
            if out is None:
                out = self._room(LEAF_PAIR, most, budget, lambda at, room: _leaf_pairs(
                    handle, self._pose_at, limit, at, room, self._found_at), lambda: found.leaf_pairs)
            else:
                status = _leaf_pairs(handle, self._pose_at, limit, place_of(out, LEAF_PAIR), len(out), self._found_at)
                if status:
                    raise error_of(status)
            distance = (found.distance_lower, found.distance_upper) if found.distance_known else None
            return LeafPairs(
                out[: found.written],
                found.leaf_pairs,
                found.complete == 1,
                found.truncated == 1,
                found.level,
                distance,
                found.resolution,
                found.sphere_tests,
            )
        finally:
            self._lock.release()

    def triangle_pairs(self, pose, *, out=None, most=None, tests=0, seconds=0.0):
        """All pairs of triangles with a common point, exactly. p_fixed = pose @ p_moving. `out`, `most`: as leaf_pairs()."""
        handle = self._enter()
        try:
            self._take(pose)
            budget, limit = budget_of(tests, seconds)
            found = self._met
            if out is None:
                out = self._room(TRIANGLE_PAIR, most, budget, lambda at, room: _triangle_pairs(
                    handle, self._pose_at, limit, at, room, self._met_at), lambda: found.pairs)
            else:
                place = place_of(out, TRIANGLE_PAIR)
                status = _triangle_pairs(handle, self._pose_at, limit, place, len(out), self._met_at)
                if status:
                    raise error_of(status)
            return TrianglePairs(
                out[: found.written], found.pairs, found.complete == 1, found.truncated == 1, found.sphere_tests
            )
        finally:
            self._lock.release()

    # Asks once with some room, and again where there was too little.
    def _room(self, dtype, most, budget, ask, count):
        room = 4096 if most is None else count_of(most, "most")
        end = time.monotonic_ns() + budget.nanoseconds if budget is not None and budget.nanoseconds > 0 else None
        while True:
            array = np.empty(room, dtype)
            status = ask(address(array), room)
            if status:
                raise error_of(status)
            if most is not None or count() <= room:
                return array
            room = count()
            if end is not None:  # the time is that of the whole call
                budget.nanoseconds = max(1, end - time.monotonic_ns())

    def contacts(self, pose, *, out=None, tests=0, seconds=0.0):
        """A few contacts, and the sums over all leaf pairs that forces are made of. p_fixed = pose @ p_moving.

        out: an array of CONTACT that is filled.

        >>> import ist, numpy as np
        >>> upper, lower = (ist.build(jaw, voxel_size=0.8) for jaw in ist.jaws())
        >>> felt = ist.Query(upper, lower, push_distance=0).contacts(np.eye(4))
        >>> force, torque, about = felt.wrench(stiffness=1.0)
        >>> bool(force[2] < 0)                                     # the lower jaw is pushed down
        True
        """
        handle = self._enter()
        try:
            self._take(pose)
            budget, limit = budget_of(tests, seconds)
            if out is None:
                out = np.empty(self._info.contacts, CONTACT)
            found, sums = self._found, self._sums
            status = _contacts(
                handle, self._pose_at, limit, place_of(out, CONTACT), len(out), self._sums_at, self._found_at
            )
            if status:
                raise error_of(status)
            return Contacts(
                out[: found.written],
                found.contacts,
                found.complete == 1,
                found.leaf_pairs,
                sums.weight,
                found.sphere_tests,
                np.frombuffer(bytearray(sums), CONTACT_SUMS),
            )
        finally:
            self._lock.release()

    def distance(self, pose, tolerance=0.0, *, tests=0, seconds=0.0):
        """The distance between the surfaces, an interval no wider than the tolerance. p_fixed = pose @ p_moving.

        A body wholly inside another has a positive distance.
        """
        handle = self._enter()
        try:
            self._take(pose)
            budget, limit = budget_of(tests, seconds)
            status = _distance(handle, self._pose_at, number_of(tolerance, "tolerance"), limit, self._apart_at)
            if status:
                raise error_of(status)
            apart = self._apart
            return Distance(apart.lower, apart.upper, apart.complete == 1, apart.narrowest, apart.sphere_tests)
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
    first_contact = _measures.first_contact
    occlusion = _measures.occlusion_of
    rows = _measures.rows

    def __repr__(self):
        if self._handle is None:
            return "<ist.Query, freed>"
        return f"<ist.Query of {self.fixed!r} and {self.moving!r}, {self.spheres}, {self.target}>"
