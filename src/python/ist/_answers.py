"""The answers of a query."""

from typing import List, NamedTuple, Optional, Tuple

import numpy as np

made = tuple.__new__  # made(LeafPairs, members): an answer, in half the time of LeafPairs(*members)


class LeafPairs(NamedTuple):
    """Pairs of voxels whose bounds overlap, sorted by fixed and then by moving voxel."""

    pairs: np.ndarray  # LEAF_PAIR
    count: int  # all pairs found, in the array or not
    complete: bool  # False: a limit ended the search
    truncated: bool  # True: the array was too short and holds the first pairs
    level: int  # the search ended so many levels above the leaves
    distance: Optional[Tuple[float, float]]  # the surfaces' distance lies between, if it is known
    resolution: float  # greatest distance between the surfaces in a pair
    sphere_tests: int
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|


class Contacts(NamedTuple):
    """Where a hand feels the other body, and the sums that forces are made of."""

    contacts: np.ndarray  # CONTACT, fixed mesh coordinates
    count: int
    complete: bool  # False: a limit ended the search; do not use the sums as a force
    leaf_pairs: int
    area: float  # sum of the weights of all leaf pairs, mesh units²
    sphere_tests: int
    sums: np.ndarray  # CONTACT_SUMS, one element: the sums over all leaf pairs
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|; of a pair of a world, of both poses, the larger one

    def wrench(self, stiffness):
        """The springs' force on the moving body, their torque, and the point that the torque is about, fixed mesh
        coordinates. A stiffness in N/mm³ and meshes in mm give N and N mm."""
        sums = self.sums[0]
        return stiffness * sums["spring_force"], stiffness * sums["spring_torque"], sums["about"].copy()


class Distance(NamedTuple):
    """The distance between the surfaces, mesh units: it lies between `lower` and `upper`."""

    lower: float
    upper: float
    complete: bool  # the interval is at most as wide as the tolerance
    narrowest: float  # a tolerance below this width may be missed here: rounding, or voxels if a tree has no triangles
    sphere_tests: int
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|
    nearest_fixed: Optional[np.ndarray]  # (3,), fixed mesh coordinates: the closest point of the nearest triangles that were
    # found, on the fixed one; None without triangles, and if no pair was measured
    nearest_moving: Optional[np.ndarray]  # the same on the moving triangle; a common point if the triangles intersect
    direction: Optional[np.ndarray]  # (3,), unit vector from nearest_fixed to nearest_moving; 0 if the triangles intersect
    triangles: Optional[Tuple[int, int]]  # the indices of these triangles, fixed and moving


class TrianglePairs(NamedTuple):
    """Pairs of triangles with a common point, exactly, sorted by fixed and then by moving triangle."""

    pairs: np.ndarray  # TRIANGLE_PAIR
    count: int
    complete: bool
    truncated: bool
    sphere_tests: int
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|


class NearPairs(NamedTuple):
    """Pairs of triangles, or of their parts, within a margin, sorted by distance."""

    pairs: np.ndarray  # NEAR_PAIR, fixed mesh coordinates
    count: int  # all pairs found, in the array or not
    complete: bool  # False: a limit ended the search, or the bodies are too far apart for float
    truncated: bool  # True: the array was too short and holds the nearest pairs
    pad: float  # no pair is farther apart than the margin and this, mesh units
    kept: bool  # the answer is of pairs kept from earlier poses, with the same bits
    sphere_tests: int
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|


class WorldAnswer(NamedTuple):
    """One row for each pair of bodies of a world that is near, sorted; all other pairs are apart.

    After distances() a row with `nearest_known` 1 has `nearest_fixed`, `nearest_moving` and `direction` in world coordinates, and
    `nearest_triangles`.
    """

    pairs: np.ndarray  # WORLD_PAIR
    count: int  # all pairs that are near, in the array or not
    complete: bool  # every near pair was asked, and its answer is complete
    truncated: bool  # True: the array, or the room of the world, was too short
    sphere_tests: int
    found: Optional[np.ndarray]  # LEAF_PAIR or TRIANGLE_PAIR, of one row after the other; None after another question

    def found_of(self, row):
        """The leaf pairs, or the pairs of triangles, of one row of `pairs`."""
        return self.found[row["first"] : row["first"] + row["written"]]


class LeastDistance(NamedTuple):
    """The least distance between any two bodies of a world, mesh units: it lies between `lower` and `upper`."""

    lower: float
    upper: float
    complete: bool  # the interval is at most as wide as the tolerance, and counts all pairs
    nearest: Optional[Tuple[int, int]]  # the bodies with the least upper end; None if no pair counts
    pose_missing: bool  # True: the pose of a body is invalid, and the interval counts the other bodies alone
    sphere_tests: int
    nearest_fixed: Optional[np.ndarray] = None  # (3,), world coordinates: of `nearest`, as a Distance has it
    nearest_moving: Optional[np.ndarray] = None
    direction: Optional[np.ndarray] = None
    triangles: Optional[Tuple[int, int]] = None


class Penetration(NamedTuple):
    """How deep the deepest point of either surface lies inside the other body, mesh units."""

    lower: float  # NaN, as `upper`, if `not_closed` names a body
    upper: float  # 0: the bodies do not intersect
    complete: bool
    point: np.ndarray  # (3,), fixed mesh coordinates, `lower` deep
    direction: np.ndarray  # (3,), from there to the other surface's nearest point
    of_moving: bool  # whose surface the point lies on
    triangle: int  # of that surface
    not_closed: Optional[str]  # "fixed" or "moving": the inside of that body is uncertain, and the depth unknown
    narrowest: float
    points: int  # points whose distance was measured
    self_intersecting: Optional[str] = None  # "fixed", "moving" or "both": that surface intersects itself
    capped: bool = False  # the search ended after 4 million pieces of triangles, and `complete` is False
    rotation_error: float = 0.0  # of the given pose: the largest entry of |RᵀR - I|


class Escape(NamedTuple):
    """The shortest rigid motion found that frees two bodies, mesh units: no triangles meet, and no body lies inside the other.

    The length of a motion is the distance from a point's first to its last place, of the point that goes farthest.
    """

    status: str  # "found", "not needed", "not found", "unknown"
    motion: np.ndarray  # (4, 4), from places at the given pose to places at `pose`, fixed coordinates
    pose: np.ndarray  # (4, 4), moving to fixed coordinates after the motion
    lower: float  # no motion that frees the bodies is shorter; 0 if a body is not closed
    upper: float  # the motion is no longer; infinity without a motion
    verdicts: int  # poses at which exact triangles were asked
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|


class FirstContact(NamedTuple):
    """The first contact along a motion: at `upper`, 0 to 1, triangles intersect; before `lower` none do."""

    outcome: str  # "contact", "none", "grazing", "touches at start", "inside at start", "stopped"
    lower: float
    upper: float
    distance: Tuple[float, float]  # of the surfaces at `lower`
    triangles: Optional[Tuple[int, int]]  # fixed and moving, that intersect at `upper`, if they are known
    grazed: bool
    narrowest: float
    distances: int  # lists of near pairs, and pairs that were measured
    self_intersecting: Optional[str]  # "fixed", "moving" or "both": that surface intersects itself
    rotation_error: float  # of the given poses, the larger one
    place: Optional[Tuple[np.ndarray, np.ndarray]]  # closest points before the contact, on the fixed and on the moving
    # surface, (3,) each, fixed mesh coordinates; twice a common point with "touches at start"; None without a contact
    normal: Optional[np.ndarray]  # (3,), unit vector from the fixed to the moving body there; 0 with "touches at start"
    passes: bool  # the triangles pass through each other between `lower` and `upper`, and intersect at no pose that was tried


class Settlement(NamedTuple):
    """Where a body settled, and the proof. docs/settle.md explains the numbers."""

    status: str  # "rests", "rests level", "left the box", "stopped", "no free pose", "unknown"
    pose: np.ndarray  # (4, 4)
    free: bool  # proven: no triangles meet, and no body lies inside the other
    contacts: np.ndarray  # SETTLE_CONTACT, the strongest first
    distance: Tuple[float, float]  # of the surfaces
    residual: float  # what the forces leave of the load, as a part of it
    remaining: float  # a motion of a size of `reach` closes no farther, to first order
    second_order: float  # and what curves may add
    margin: float  # the load is so far inside the contacts' hull; negative outside
    rocks: bool
    level: np.ndarray  # (n, 6), directions that nothing holds: way of the load point and rotation vector
    moved: np.ndarray  # (6,), from the given pose
    closed: float  # way of the load point along the load
    load_point: np.ndarray  # (3,), moving mesh coordinates
    radius: float
    reach: float
    load_guessed: bool
    unit_guessed: bool
    opened: bool  # the given pose was not free
    steps: int
    rotation_error: float


class BodyOcclusion(NamedTuple):
    """One surface against the other body."""

    distances: np.ndarray  # SURFACE_DISTANCE, of its vertices
    regions: np.ndarray  # CONTACT_REGION, the largest first
    areas: np.ndarray  # within each limit, mesh units²
    total_area: float
    penetrating_area: float
    depth_integral: float
    depth_at_vertices: float


class Occlusion(NamedTuple):
    """Distance maps, areas and contact regions of two bodies; docs/occlusion.md defines each number."""

    limits: np.ndarray  # distances whose areas were measured, mesh units
    fixed: BodyOcclusion
    moving: BodyOcclusion
    rotation_error: float  # of the given pose: the largest entry of |RᵀR - I|


class PoseChange(NamedTuple):
    """The motion of a body from one pose to another, fixed coordinates."""

    about: np.ndarray  # (3,), the named point, at the first pose
    translation: np.ndarray  # (3,), the way of that point, mesh units
    rotation: np.ndarray  # (3,), along the axis of the turn, as long as its angle, radians
    axis: np.ndarray  # (3,), of the screw, of unit length; 0 if nothing moves
    axis_point: Optional[np.ndarray]  # (3,), the axis' nearest point to `about`; None if nothing turns
    angle: float  # of the turn, radians, 0 to pi
    along: float  # the way along the axis, mesh units
    rotation_error: float  # of the given poses, the larger one: the largest entry of |RᵀR - I|


class ServoBody(NamedTuple):
    """A body of a servo's scene."""

    name: str
    held: bool  # in the hand
    pose: np.ndarray  # (4, 4), maps the mesh to the scene after the last tick


class ServoState(NamedTuple):
    """A tick as any thread sees it. Vectors are along the scene's axes, translations in the servo's unit."""

    tick: int  # its number, from 0
    device: np.ndarray  # (4, 4), the pose of the device, or its last valid one
    tool: np.ndarray  # (4, 4), the pose of the tool after the tick, which is the pose to draw
    force: np.ndarray  # (3,), on the hand, N
    torque: np.ndarray  # (3,), on the hand, N m, about the tool's origin
    contacts: np.ndarray  # SERVO_CONTACT: they push the tool; empty with springs
    device_known: bool  # False: the device had no valid pose
    fault: bool  # the force was zero after an error
    held: bool  # the tool stayed where it was: the time did not suffice, or no motion was free
    halved: bool  # the tool met a body on its way, and stopped before it
    steps: int  # that the tool made; 0 with springs
    begin_ns: int  # the tick's start; on Linux by the clock of time.monotonic_ns()
    execution_ns: int  # from the tick's start to its end


class ServoTick(NamedTuple):
    """The output of a tick for the hand, along the scene's axes."""

    force: np.ndarray  # (3,), N
    torque: np.ndarray  # (3,), N m, about the tool's origin


class SweepPart(NamedTuple):
    """How Sweep.run() ended."""

    part: int
    outcome: str  # "made"; "there": it was there before; "given up": begun and lost three times, and not tried again
    rows: int
    seconds: float  # spent on making it, now or before; NaN if unknown


class SweepTable(NamedTuple):
    """How Sweep.merge() ended: with a table of all rows, or with the parts that are not there."""

    rows: int  # of the table; 0: nothing was written
    missing: List[int]  # parts that nobody has made yet
    given_up: List[int]  # parts that were begun and lost three times


class SweepStatus(NamedTuple):
    """The parts of a sweep by how they stand in its folder."""

    done: List[int]
    missing: List[int]  # nobody has made them yet, or somebody is making them
    given_up: List[int]  # begun and lost three times: not tried again
    damaged: List[int]  # their files are not those that were written
    seconds: float  # spent on making the parts that are done
