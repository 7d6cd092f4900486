"""Worlds: many bodies at poses, and the answers of all pairs that are near each other."""

from ctypes import addressof, c_uint32, c_uint64, pointer

import numpy as np

from . import _c
from ._answers import Contacts, LeastDistance, WorldAnswer
from ._arrays import address, budget_of, by_columns, count_of, number_of, place_of, pose_of
from ._c import (
    CONTACT,
    CONTACT_SUMS,
    LEAF_PAIR,
    TRIANGLE_PAIR,
    WORLD_PAIR,
    ContactSums,
    LeastDistance as LeastDistanceResult,
    WorldInfo,
    WorldOptions,
    WorldQuestion,
    WorldResult,
)
from ._errors import check, error_of, need_word, refuse
from ._handle import Lone, Out
from ._library import LIBRARY
from ._query import options_of
from ._tree import need_tree

_ask = LIBRARY.ist_world_ask
ALL_PAIRS = 2**64 - 1
# The questions, by their names: the library's number, and the dtype of the pairs that it fills an array with.
QUESTIONS = {
    "near_pairs": (_c.IST_ASK_NEAR, None),
    "intersects": (_c.IST_ASK_INTERSECTS, None),
    "leaf_pairs": (_c.IST_ASK_LEAF_PAIRS, LEAF_PAIR),
    "distance": (_c.IST_ASK_DISTANCE, None),
    "contacts": (_c.IST_ASK_CONTACTS, None),
    "triangle_pairs": (_c.IST_ASK_TRIANGLE_PAIRS, TRIANGLE_PAIR),
}
QUESTIONS["distances"] = QUESTIONS["distance"]  # as the method is named


class World(Lone):
    """Bodies with poses: asks all pairs of them that are near each other what a Query asks of two.

    A pose is (4, 4) float64, row by row, and maps a body's mesh to the world: p_world = pose @ p_body. Bodies are numbers, from
    0 in the order of add(). An answer has one row of WORLD_PAIR for each pair that is near, sorted: its `status` is 0, or
    NOT_PREPARED, POSE_INVALID, TRIANGLES_MISSING or VOXELS_MISSING; all other pairs are apart, by more than `reach`. Of a pair
    the body added first is the fixed one. `tests` and `seconds` limit a whole call. A world belongs to one thread at a time:
    another one gets a BusyError.

    reach: pairs whose root bounds are no farther apart are near too, mesh units. threads: threads that ask pairs; the answer does
    not depend on it. pair_caches: most pairs that have a pair cache at a time, with front_pairs. max_memory: bytes. All else as
    of Query, for all pairs; contacts=-1: the sums alone.

    >>> import ist, numpy as np
    >>> upper, lower = (ist.build(jaw) for jaw in ist.jaws())
    >>> world = ist.World()
    >>> a, b = world.add(upper, name="upper"), world.add(lower, name="lower")
    >>> world.reserve()
    >>> row = world.intersects().pairs[0]
    >>> int(row["a"]), int(row["b"]), bool(row["answer"] == ist.YES)
    (0, 1, True)
    >>> pose = np.eye(4)
    >>> pose[2, 3] = -1.5                                   # the lower jaw goes down by 1.5 mm
    >>> world.set_pose(b, pose)
    >>> least = world.distance(tolerance=0.01)
    >>> least.nearest, least.upper - least.lower <= 0.01
    ((0, 1), True)
    """

    _free = LIBRARY.ist_world_free

    def __init__(
        self,
        *,
        spheres="default",
        contacts=32,
        margin=0.0,
        front_pairs=0,
        frontier_pairs=0,
        target=None,
        reach=0.0,
        threads=1,
        pair_caches=16,
        max_memory=4 << 30,
    ):
        query = options_of(spheres, 1, contacts, margin, front_pairs, target)
        query.frontier_pairs = count_of(frontier_pairs, "frontier_pairs")
        options = WorldOptions(
            query=pointer(query),
            reach=number_of(reach, "reach"),
            pair_caches=count_of(pair_caches, "pair_caches", least=1),
            max_memory=count_of(max_memory, "max_memory", least=1),
            threads=count_of(threads, "threads", _c.IST_MOST_THREADS, least=1),
        )
        out = Out()
        check(LIBRARY.ist_world_create(addressof(options), out.address))
        super().__init__(out.handle)
        self._contacts = max(query.contacts, 0)
        self._trees, self._names = [], []
        self._reserved = 0
        self._question, self._found = WorldQuestion(), WorldResult()
        self._question_at, self._found_at = addressof(self._question), addressof(self._found)
        self._least = LeastDistanceResult()
        self._felt = np.empty(0, WORLD_PAIR)  # the rows of the last contacts()

    bodies = property(lambda self: tuple(self._trees), doc="The trees of the bodies, by their numbers.")
    names = property(lambda self: tuple(self._names), doc="The names of the bodies, by their numbers.")

    @property
    def nbytes(self):
        """The bytes that reserve() took."""
        info = WorldInfo()
        self._call(LIBRARY.ist_world_get_info, addressof(info))
        return info.bytes

    # Calls a function of the library with the handle.
    def _call(self, function, *arguments):
        handle = self._enter()
        try:
            check(function(handle, *arguments))
        finally:
            self._lock.release()

    def add(self, tree, pose=None, name=None):
        """Adds a body and returns its number. reserve() has to follow.

        p_world = pose @ p_body; without a pose the body is where its mesh is.
        """
        need_tree(tree, "tree")
        at = pose_of(pose)
        body = c_uint32()
        handle = self._enter()
        try:
            name = f"body {len(self._trees)}" if name is None else str(name)
            check(LIBRARY.ist_world_add(handle, tree._need(), address(at), name.encode("utf-8", "replace"), addressof(body)))
            self._trees.append(tree)
            self._names.append(name)
        finally:
            self._lock.release()
        return body.value

    def ignore(self, a, b):
        """Never looks at a pair of bodies again."""
        self._call(LIBRARY.ist_world_ignore, self._body(a, "a"), self._body(b, "b"))

    def bytes_needed(self, near_pairs=None):
        """The bytes that reserve(near_pairs) takes."""
        needed = c_uint64()
        self._call(LIBRARY.ist_world_bytes_needed, self._count(near_pairs), addressof(needed))
        return needed.value

    def reserve(self, near_pairs=None):
        """Reserves memory for all bodies, and for so many pairs that are near at a time; without a number, for all pairs.

        If more pairs are near, an answer has rows for the first of them. Frees what was reserved before, and forgets earlier
        questions. Raises MemoryLimitError; the world is then as it was.
        """
        count = self._count(near_pairs)
        handle = self._enter()
        try:
            check(LIBRARY.ist_world_reserve(handle, count))
            self._reserved = max(1, min(count, self._all_pairs()))
        finally:
            self._lock.release()

    def set_pose(self, body, pose):
        """Moves a body. p_world = pose @ p_body.

        Raises InputError for a pose that is no rigid motion: the pairs of the body then have the status POSE_INVALID until its
        next pose.
        """
        at = pose_of(pose)
        self._call(LIBRARY.ist_world_set_pose, self._body(body, "body"), address(at))

    def pose_of(self, a, b):
        """The pose at which a pair is asked, (4, 4): p_a = pose @ p_b. A Query of the two at this pose has the pair's
        answers."""
        columns = np.empty((4, 4))
        self._call(LIBRARY.ist_world_get_pose, self._body(a, "a"), self._body(b, "b"), address(columns))
        return by_columns(columns)

    def ask(self, question, *, tolerance=0.0, into=None, out=None, tests=0, seconds=0.0):
        """Asks each pair of bodies that is near a question, and returns a WorldAnswer.

        question: "near_pairs" lists the pairs with the distance of their root bounds, and asks none. "intersects" tells by
        `answer` whether they intersect: NO, NEAR or YES. "contacts" finds their contacts, for contacts_of(). "distance" bounds
        their distance by an interval no wider than `tolerance`, and finds the nearest points; "distances" does the same.
        "leaf_pairs" finds all pairs of voxels whose bounds overlap, "triangle_pairs" all pairs of triangles with a common
        point: found_of(row) of the answer has those of one pair of bodies.

        into: an array of LEAF_PAIR or TRIANGLE_PAIR that is filled by one pair of bodies after the other; by default one of
        65,536. out: an array of WORLD_PAIR that is filled by the rows; by default one with room for all.
        """
        need_word(question, QUESTIONS, "question")
        number, dtype = QUESTIONS[question]
        width = number_of(tolerance, "tolerance")
        place, length = None, 0
        if dtype is not None:
            into = np.empty(1 << 16, dtype) if into is None else into
            place, length = place_of(into, dtype), len(into)
        elif into is not None:
            refuse(f"into: {question} fills no array: leave it out")
        keep = question == "contacts"  # the rows of all pairs stay here, whatever `out` has room for
        handle = self._enter()
        try:
            budget, limit = budget_of(tests, seconds)
            asked, found, rows = self._question, self._found, out
            asked.ask, asked.tolerance = number, width
            asked.leaf_pairs, asked.leaf_capacity = (place, length) if dtype is LEAF_PAIR else (None, 0)
            asked.triangles, asked.triangle_capacity = (place, length) if dtype is TRIANGLE_PAIR else (None, 0)
            at = None if out is None else place_of(out, WORLD_PAIR)
            if out is None or keep:
                rows = np.empty(self._reserved, WORLD_PAIR)
                at = address(rows)
            if keep:
                self._felt = rows[:0]
            status = _ask(handle, self._question_at, limit, at, len(rows), self._found_at)
            if status:
                raise error_of(status)
            truncated = found.truncated == 1
            if keep:
                self._felt = rows[: found.written].copy()
                if out is not None:
                    given = min(len(out), found.written)
                    out[:given] = rows[:given]
                    rows, found.written, truncated = out, given, given < found.near_pairs
            return WorldAnswer(
                rows[: found.written], found.near_pairs, found.complete == 1, truncated, found.sphere_tests, into
            )
        finally:
            self._lock.release()

    def near_pairs(self, *, out=None):
        """ask("near_pairs")"""
        return self.ask("near_pairs", out=out)

    def intersects(self, *, out=None, tests=0, seconds=0.0):
        """ask("intersects")"""
        return self.ask("intersects", out=out, tests=tests, seconds=seconds)

    def contacts(self, *, out=None, tests=0, seconds=0.0):
        """ask("contacts")"""
        return self.ask("contacts", out=out, tests=tests, seconds=seconds)

    def distances(self, tolerance=0.0, *, out=None, tests=0, seconds=0.0):
        """ask("distance")"""
        return self.ask("distance", tolerance=tolerance, out=out, tests=tests, seconds=seconds)

    def leaf_pairs(self, *, into=None, out=None, tests=0, seconds=0.0):
        """ask("leaf_pairs")"""
        return self.ask("leaf_pairs", into=into, out=out, tests=tests, seconds=seconds)

    def triangle_pairs(self, *, into=None, out=None, tests=0, seconds=0.0):
        """ask("triangle_pairs")"""
        return self.ask("triangle_pairs", into=into, out=out, tests=tests, seconds=seconds)

    def contacts_of(self, a, b, *, out=None):
        """The contacts of a pair, and its sums, from the last contacts(); coordinates of the body added first.

        `complete` is that of the pair's row: where a limit ended its search, there is no force. out: an array of CONTACT that
        is filled. Raises InputError where contacts() did not ask the pair.
        """
        if out is None:
            out = np.empty(self._contacts, CONTACT)
        a, b = self._body(a, "a"), self._body(b, "b")
        count, sums, place = c_uint64(), ContactSums(), place_of(out, CONTACT)
        handle = self._enter()
        try:
            check(LIBRARY.ist_world_get_contacts(handle, a, b, place, len(out), addressof(sums), addressof(count)))
            rows = self._felt[(self._felt["a"] == min(a, b)) & (self._felt["b"] == max(a, b))]
        finally:
            self._lock.release()
        if len(rows) == 0:
            refuse("the last contacts() was interrupted: call it again")
        row = rows[0]
        return Contacts(
            out[: min(count.value, len(out))],
            count.value,
            bool(row["complete"] == 1),
            int(row["found"]),
            sums.weight,
            int(row["sphere_tests"]),
            np.frombuffer(bytearray(sums), CONTACT_SUMS),
            float(row["rotation_error"]),
        )

    def distance(self, tolerance=0.0, *, tests=0, seconds=0.0):
        """The least distance of all pairs, near or not: an interval no wider than the tolerance, and the nearest points."""
        handle = self._enter()
        try:
            budget, limit = budget_of(tests, seconds)
            least = self._least
            check(LIBRARY.ist_world_distance(handle, number_of(tolerance, "tolerance"), limit, addressof(least)))
            nearest = (least.a, least.b) if least.nearest_known else None
            points = ()
            if least.points_known:
                points = (*map(np.array, (least.nearest_fixed, least.nearest_moving, least.direction)), tuple(least.nearest_triangles))
            return LeastDistance(
                least.lower, least.upper, least.complete == 1, nearest, least.pose_missing == 1, least.sphere_tests, *points
            )
        finally:
            self._lock.release()

    def forget(self):
        """Forgets what earlier poses left behind."""
        self._call(LIBRARY.ist_world_forget)

    def _all_pairs(self):
        return len(self._trees) * (len(self._trees) - 1) // 2

    @staticmethod
    def _body(number, what):
        return count_of(number, what, 0xFFFFFFFF)

    # A number of near pairs; None for all.
    @staticmethod
    def _count(near_pairs):
        return ALL_PAIRS if near_pairs is None else count_of(near_pairs, "near_pairs")

    def __repr__(self):
        if self._handle is None:
            return "<ist.World, freed>"
        return f"<ist.World of {len(self._trees)} bodies>"
