"""The questions to a query that take milliseconds, and rows of many poses. Each of them hears Ctrl-C."""

import ctypes

from ctypes import addressof

import numpy as np

from . import _c
from ._answers import BodyOcclusion, Escape, FirstContact, Occlusion, Penetration, PoseChange, Settlement
from ._arrays import address, budget_of, by_columns, count_of, floats, number_of, place_of, pose_of
from ._c import (
    CONTACT_REGION,
    PLACED_CONTACT,
    ROW,
    SETTLE_CONTACT,
    SURFACE_DISTANCE,
    Escape as EscapeResult,
    FirstContact as FirstContactResult,
    Motion,
    OcclusionArrays,
    OcclusionOptions,
    Occlusion as OcclusionSums,
    Penetration as PenetrationResult,
    PoseChange as PoseChangeResult,
    RowsOptions,
    SettleOptions,
    Settlement as SettlementResult,
)
from ._errors import check, need_word, refuse, refuse_type
from ._follow import Follower
from ._library import LIBRARY
from ._tree import need_tree

OUTCOMES = (None, "contact", "none", "grazing", "touches at start", "inside at start", "stopped")
NOT_CLOSED = (None, "fixed", "moving")
ESCAPED = ("unknown", "found", "not needed", "not found")
SETTLED = ("unknown", "rests", "rests level", "left the box", "stopped", "no free pose")
FREEDOMS = ("x", "y", "z", "roll", "pitch", "yaw")
# The most contacts of an answer: more are left out, the weakest first.
MOST_CONTACTS = 1024
SELF_INTERSECTING = (None, "fixed", "moving", "both")
QUESTIONS = {
    "intersects": _c.IST_ASK_INTERSECTS,
    "leaf_pairs": _c.IST_ASK_LEAF_PAIRS,
    "distance": _c.IST_ASK_DISTANCE,
    "contacts": _c.IST_ASK_CONTACTS,
    "penetration": _c.IST_ASK_PENETRATION,
}


def penetration(self, pose, tolerance, *, last=None, points=0, seconds=0.0, progress=None):
    """How deep the deepest point of either surface lies inside the other body: an interval no wider than the tolerance.

    p_fixed = pose @ p_moving. Both bodies have to be closed, else `not_closed` names the one that is not, and the interval
    is NaN. last: an earlier answer, from which the search goes on. points: the most points to measure.
    """
    handle = self._enter()
    try:
        at = pose_of(pose)
        budget, limit = budget_of(points, seconds)
        result = PenetrationResult()
        before = None
        if last is not None:
            if not isinstance(last, Penetration):
                refuse_type(f"last is a {type(last).__name__}: pass an answer of penetration()")
            before = PenetrationResult(
                lower=last.lower,
                upper=last.upper,
                point=tuple(last.point),
                of_moving=int(last.of_moving),
                triangle=last.triangle,
            )
        with Follower(progress) as follower:
            status = LIBRARY.ist_query_penetration(
                handle,
                address(at),
                number_of(tolerance, "tolerance"),
                None if before is None else addressof(before),
                limit,
                follower.address,
                addressof(result),
            )
            follower.finish(status)
        return Penetration(
            result.lower,
            result.upper,
            result.complete == 1,
            np.array(result.point),
            np.array(result.direction),
            result.of_moving == 1,
            result.triangle,
            NOT_CLOSED[result.not_closed],
            result.narrowest,
            result.points,
            SELF_INTERSECTING[result.self_intersecting],
            result.capped == 1,
            result.rotation_error,
        )
    finally:
        self._lock.release()


def escape(self, pose, tolerance=0.0, *, longest=np.inf, progress=None):
    """A short rigid motion that frees the bodies, and the pose after it: no triangles meet, and no body lies inside the other.

    p_fixed = pose @ p_moving. A translation ends within the tolerance of its last contact; 0 means a 10,000th of the moving body's bounding
    radius. Motions longer than `longest` are not looked for.
    """
    handle = self._enter()
    try:
        at = pose_of(pose)
        result = EscapeResult()
        with Follower(progress) as follower:
            status = LIBRARY.ist_query_escape(
                handle,
                address(at),
                number_of(tolerance, "tolerance"),
                number_of(longest, "longest"),
                follower.address,
                addressof(result),
            )
            follower.finish(status)
        return Escape(
            ESCAPED[result.status],
            np.array(result.motion).reshape(4, 4).T.copy(),
            np.array(result.pose).reshape(4, 4).T.copy(),
            result.lower,
            result.upper,
            result.verdicts,
            result.rotation_error,
        )
    finally:
        self._lock.release()


def first_contact(self, start, stop, tolerance, *, distances=0, seconds=0.0, progress=None):
    """The first contact on the way from one pose to another, by the screw that turns least, and its place and normal.

    p_fixed = pose @ p_moving. From `lower` to `upper` no point of the moving body goes farther than the tolerance. distances: the most lists of near
    pairs, and pairs to measure.
    """
    handle = self._enter()
    try:
        begin, end = pose_of(start, "start"), pose_of(stop, "stop")
        motion = Motion(from_=address(begin), to=address(end))
        budget, limit = budget_of(distances, seconds)
        result = FirstContactResult()
        with Follower(progress) as follower:
            status = LIBRARY.ist_query_first_contact(
                handle, addressof(motion), number_of(tolerance, "tolerance"), limit, follower.address, addressof(result)
            )
            follower.finish(status)
        return FirstContact(
            OUTCOMES[result.outcome],
            result.lower,
            result.upper,
            (result.distance_lower, result.distance_upper),
            (result.fixed, result.moving) if result.triangles_known else None,
            result.grazed == 1,
            result.narrowest,
            result.distances,
            SELF_INTERSECTING[result.self_intersecting],
            result.rotation_error,
            (np.array(result.place_fixed), np.array(result.place_moving)) if result.place_known else None,
            np.array(result.normal) if result.place_known else None,
            result.passes == 1,
        )
    finally:
        self._lock.release()


def settle(
    self,
    pose=None,
    *,
    closing=(0.0, 0.0, 1.0),
    at=None,
    hold=(),
    within=None,
    reach=0.0,
    steps=0,
    progress=None,
):
    """Moves the moving body along `closing` until it rests on the fixed one, and proves that it rests.

    p_fixed = pose @ p_moving. at: the load point, coordinates of the moving body; by default the middle of what touches first. hold: some of
    "x", "y", "z", "roll", "pitch" and "yaw". within: (way in mesh units, angle in radians), the box round the pose; by default 2 mm and 3 degrees.
    reach: length of the motions that the proof speaks of; by default 50 µm. steps: the most steps. One rest is one of several: the start decides.
    """
    handle = self._enter()
    try:
        begin = pose_of(np.eye(4) if pose is None else pose)
        options = SettleOptions(closing=tuple(floats(closing, (3,), "closing")), reach=number_of(reach, "reach"), steps=count_of(steps, "steps"))
        if at is not None:
            options.load_point = tuple(floats(at, (3,), "at"))
            options.has_load_point = 1
        for word in [hold] if isinstance(hold, str) else hold:
            need_word(word, FREEDOMS, "hold")
            options.held |= 1 << FREEDOMS.index(word)
        if within is not None:
            way, turn = floats(within, (2,), "within").tolist()
            options.largest_way, options.largest_turn = way, turn
        result = SettlementResult()
        contacts = np.zeros(MOST_CONTACTS, SETTLE_CONTACT)
        with Follower(progress) as follower:
            status = LIBRARY.ist_query_settle(
                handle, address(begin), addressof(options), follower.address, address(contacts), len(contacts), addressof(result)
            )
            follower.finish(status)
        return Settlement(
            SETTLED[result.status],
            np.array(result.pose).reshape(4, 4).T.copy(),
            result.is_free == 1,
            contacts[: result.contacts].copy(),
            (result.distance_lower, result.distance_upper),
            result.residual,
            result.remaining,
            result.second_order,
            result.margin,
            result.rocks == 1,
            np.array(result.level).reshape(6, 6)[: result.levels].copy(),
            np.array(result.moved),
            result.closed,
            np.array(result.load_point),
            result.radius,
            result.reach,
            result.load_guessed == 1,
            result.unit_guessed == 1,
            result.opened == 1,
            result.steps,
            result.rotation_error,
        )
    finally:
        self._lock.release()


def rows(
    self,
    poses,
    *,
    want=("intersects", "distance"),
    tolerance=0.0,
    stiffness=1.0,
    tests=0,
    threads=0,
    out=None,
    progress=None,
):
    """Answers the same questions at many poses, (N, 4, 4), p_fixed = pose @ p_moving: an array of ROW, one element a pose.

    Each row is bit for bit what the single calls say after forget(), whatever the number of threads (0: one for each core).
    want: of intersects, leaf_pairs, distance, contacts, penetration. A pose that is no rigid motion is a row with a status,
    and no error. What was not asked for is NaN, or 0 in whole numbers. stiffness: of the contacts' force, N/mm³, and its torque about
    the fixed tree's origin. tests: the most of each search.

    >>> import ist, numpy as np
    >>> upper, lower = (ist.build(jaw) for jaw in ist.jaws())
    >>> poses = np.tile(np.eye(4), (3, 1, 1))
    >>> poses[:, 2, 3] = 0, -1, -2
    >>> rows = ist.Query(upper, lower).rows(poses, want=["intersects"])
    >>> (rows["intersects"] == ist.YES).tolist()
    [True, True, False]
    """
    handle = self._enter()
    try:
        at = by_columns(floats(poses, (None, 4, 4), "poses"))
        if isinstance(want, str) or len(want) == 0:
            refuse(f"want is {want!r}: pass a list of some of {', '.join(QUESTIONS)}")
        for name in want:
            need_word(name, QUESTIONS, "a word of want")
        found = np.empty(len(at), ROW) if out is None else out
        place = place_of(found, ROW, len(at))
        options = RowsOptions(
            questions=sum({QUESTIONS[name] for name in want}),
            threads=count_of(threads, "threads", 1024),
            tolerance=number_of(tolerance, "tolerance"),
            stiffness=number_of(stiffness, "stiffness"),
            tests=count_of(tests, "tests"),
        )
        with Follower(progress) as follower:
            options.progress = follower.pointer
            status = LIBRARY.ist_query_rows(handle, address(at), len(at), addressof(options), place)
            follower.finish(status)
        return found
    finally:
        self._lock.release()


# The library takes 0 for a default, and -1 for 0.
def _or_none(value, what):
    number = number_of(value, what)
    if number < 0:
        refuse(f"{what} is {number}: pass a number of at least 0")
    return -1.0 if number == 0 else number


def _arrays(vertices, regions, limits):
    distances = np.empty(vertices, SURFACE_DISTANCE)
    found = np.empty(regions, CONTACT_REGION)
    areas = np.empty(len(limits))
    struct = OcclusionArrays(
        distances=address(distances),
        distance_capacity=vertices,
        regions=address(found),
        region_capacity=regions,
        areas=address(areas) if len(limits) else None,
    )
    return struct, distances, found, areas


def occlusion_of(
    self,
    pose=None,
    *,
    limits=(0.05, 0.1, 0.2, 0.35),
    reach=2.0,
    contact=0.1,
    least_area=0.01,
    longest_edge=0.2,
    foundation=0.1,
    change=0.05,
    progress=None,
):
    """Measures the occlusion of two bodies: distance maps, areas within limits, contact regions, for each surface.

    p_fixed = pose @ p_moving; without a pose the bodies are as stored. The defaults are made for millimetres. Distances are
    negative inside the other body and NaN beyond `reach`; surfaces no farther apart than `contact` touch.
    """
    handle = self._enter()
    try:
        at = pose_of(pose)
        bounds = floats(limits, (None,), "limits").copy()  # it stays in the answer
        options = OcclusionOptions(
            reach=number_of(reach, "reach"),
            contact=_or_none(contact, "contact"),
            least_area=_or_none(least_area, "least_area"),
            longest_edge=number_of(longest_edge, "longest_edge"),
            foundation=_or_none(foundation, "foundation"),
            change=_or_none(change, "change"),
            limits=address(bounds) if len(bounds) else None,
            limit_count=len(bounds),
        )
        for name in ("reach", "longest_edge"):
            if getattr(options, name) <= 0:
                refuse(f"{name} is {getattr(options, name)}: pass a number above 0")
        room = [1024, 1024]
        trees = (self.fixed, self.moving)
        while True:
            arrays = [_arrays(len(tree.vertices), size, bounds) for tree, size in zip(trees, room)]
            sums = [OcclusionSums(), OcclusionSums()]
            with Follower(progress) as follower:
                status = LIBRARY.ist_query_occlusion(
                    handle,
                    address(at),
                    addressof(options),
                    follower.address,
                    addressof(arrays[0][0]),
                    addressof(arrays[1][0]),
                    addressof(sums[0]),
                    addressof(sums[1]),
                )
                follower.finish(status)
            if all(each.regions <= size for each, size in zip(sums, room)):
                break
            room = [each.regions for each in sums]
        bodies = [
            BodyOcclusion(
                distances,
                regions[: each.regions],
                areas,
                each.total_area,
                each.penetrating_area,
                each.depth_integral,
                each.depth_at_vertices,
            )
            for (_, distances, regions, areas), each in zip(arrays, sums)
        ]
        return Occlusion(bounds, *bodies, sums[0].rotation_error)
    finally:
        self._lock.release()


def rotation_error(pose):
    """How far the rotation R of a pose is from orthonormal: the largest entry of |RᵀR - I|.

    p_fixed = pose @ p_moving. Each question answers at the nearest rotation. Infinite if a number is not finite.
    """
    at, error = pose_of(pose), ctypes.c_double()
    check(LIBRARY.ist_rotation_error(address(at), addressof(error)))
    return error.value


def signed_distance(tree, points, *, reach=np.inf, out=None, progress=None):
    """The distances of points, (N, 3) mesh coordinates, from the surface of a tree: an array of SURFACE_DISTANCE.

    Negative inside; NaN beyond `reach`. is_signed is 0 if the nearest point lies at an open border.
    self_intersecting is 1 if the surface intersects itself; signs are right all the same.

    >>> import ist
    >>> box = ist.build(([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> ist.signed_distance(box, [[1, 1, 1], [1, 1, -2]])["distance"].round(3).tolist()
    [-0.577, 2.0]
    """
    need_tree(tree, "tree")
    at = floats(points, (None, 3), "points")
    found = np.empty(len(at), SURFACE_DISTANCE) if out is None else out
    place = place_of(found, SURFACE_DISTANCE, len(at))
    with Follower(progress) as follower:
        status = LIBRARY.ist_tree_signed_distance(
            tree._need(), address(at), len(at), number_of(reach, "reach"), follower.address, place
        )
        follower.finish(status)
    return found


def distance_map(body, other, pose=None, *, reach=np.inf, out=None, progress=None):
    """The signed distances of the vertices of `body` from the surface of `other`: an array of SURFACE_DISTANCE.

    p_other = pose @ p_body; `closest` is in coordinates of `other`.
    """
    need_tree(body, "body")
    need_tree(other, "other")
    at = pose_of(pose)
    count = len(body.vertices)
    found = np.empty(count, SURFACE_DISTANCE) if out is None else out
    place = place_of(found, SURFACE_DISTANCE, count)
    written = ctypes.c_uint64()
    with Follower(progress) as follower:
        status = LIBRARY.ist_tree_distance_map(
            body._need(),
            other._need(),
            address(at),
            number_of(reach, "reach"),
            follower.address,
            place,
            len(found),
            addressof(written),
        )
        follower.finish(status)
    return found


def motion_between(before, after, about=(0.0, 0.0, 0.0)):
    """The motion that takes a body from one pose to another: as six numbers about a point, and as a screw.

    p_fixed = pose @ p_moving. about: a point that the body carries from its first pose, fixed coordinates.

    >>> import ist, numpy as np
    >>> pose = np.eye(4)
    >>> pose[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    >>> change = ist.motion_between(np.eye(4), pose, [2, 0, 0])
    >>> change.translation.round(9).tolist(), round(float(np.degrees(change.angle)), 9)
    ([-2.0, 2.0, 0.0], 90.0)
    """
    first, last = pose_of(before, "before"), pose_of(after, "after")
    point, result = floats(about, (3,), "about"), PoseChangeResult()
    check(LIBRARY.ist_motion_between(address(first), address(last), address(point), addressof(result)))
    return PoseChange(
        np.array(result.about),
        np.array(result.translation),
        np.array(result.rotation),
        np.array(result.axis),
        np.array(result.axis_point) if result.turns else None,
        result.angle,
        result.along,
        result.rotation_error,
    )


def _placed(contacts, teeth, what):
    centres = floats(contacts, (None, 3), what)
    placed = np.zeros(len(centres), PLACED_CONTACT)
    placed["centre"] = centres
    if teeth is not None:
        labels = floats(teeth, (None,), f"{what}_teeth")
        if len(labels) != len(centres):
            refuse(f"{what}_teeth has {len(labels)} numbers, and {what} has {len(centres)} contacts: pass one for each")
        if not np.all((labels >= 0) & (labels < 2**31) & (labels == np.floor(labels))):
            refuse(f"{what}_teeth: pass whole numbers from 0 on")
        placed["tooth"] = labels
    return placed


def match_contacts(before, after, within=2.0, *, before_teeth=None, after_teeth=None):
    """Matches the contacts of two bites by their centres, (N, 3), on the fixed body: the nearest two first.

    Returns for each contact of the first bite the index of its contact in the second one, or -1 if it is lost. An index of
    the second bite that is missing is a new contact. Contacts with different teeth, other than 0, are never matched.

    >>> import ist
    >>> ist.match_contacts([[0, 0, 0], [9, 0, 0]], [[5, 0, 0], [0.5, 0, 0]]).tolist()
    [1, -1]
    """
    first, second = _placed(before, before_teeth, "before"), _placed(after, after_teeth, "after")
    matches = np.empty(len(first), np.int32)
    check(
        LIBRARY.ist_match_contacts(
            address(first), len(first), address(second), len(second), number_of(within, "within"), address(matches)
        )
    )
    return matches
