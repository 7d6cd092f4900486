"""Where two rigid triangle meshes touch, how deep, how far apart. Lengths are in the meshes' unit, millimetres by
habit. A pose is (4, 4) float64, row by row, and maps the moving body to the fixed one: p_fixed = pose @ p_moving."""

from os import PathLike
from pathlib import Path as _AbsolutePath
from types import TracebackType
from typing import Any, Callable, List, Literal, NamedTuple, Optional, Protocol, Sequence, Tuple, Type, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

Path = Union[str, "PathLike[str]"]
Spheres = Literal["default", "simple", "table", "tight", "slab"]
Frame = Literal["unknown", "ras", "lps"]
Question = Literal["intersects", "leaf_pairs", "distance", "contacts", "penetration"]
WorldQuestion = Literal["near_pairs", "intersects", "leaf_pairs", "distance", "distances", "contacts", "triangle_pairs"]
F8 = NDArray[np.float64]
U4 = NDArray[np.uint32]
Records = NDArray[np.void]
Mesh = Tuple[F8, U4]
Follow = Callable[[float], Any]

LEAF_PAIR: np.dtype[np.void]
TRIANGLE_PAIR: np.dtype[np.void]
NEAR_PAIR: np.dtype[np.void]
CONTACT: np.dtype[np.void]
SURFACE_DISTANCE: np.dtype[np.void]
CONTACT_REGION: np.dtype[np.void]
SETTLE_CONTACT: np.dtype[np.void]
ROW: np.dtype[np.void]
SERVO_CONTACT: np.dtype[np.void]
WORLD_PAIR: np.dtype[np.void]
NOT_PREPARED: int
TRIANGLES_MISSING: int
VOXELS_MISSING: int
POSE_INVALID: int
NO_TRIANGLE: int
UNKNOWN: int
NO: int
NEAR: int
YES: int

class Error(Exception):
    code: int
    name: str

class InputError(Error, ValueError): ...
class FileError(Error, OSError): ...
class MemoryLimitError(Error, MemoryError): ...
class BusyError(Error, RuntimeError): ...
class ChangeRefused(Error, RuntimeError): ...
class FreedError(Error, RuntimeError): ...

class _HasFaces(Protocol):  # trimesh's
    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...

class _HasTriangles(Protocol):  # Open3D's
    @property
    def vertices(self) -> Any: ...
    @property
    def triangles(self) -> Any: ...

class _HasCells(Protocol):  # meshio's
    @property
    def points(self) -> Any: ...
    @property
    def cells_dict(self) -> Any: ...

class _HasPolys(Protocol):  # vtkPolyData's
    def GetPoints(self) -> Any: ...
    def GetPolys(self) -> Any: ...

_HasMesh = Union[_HasFaces, _HasTriangles, _HasCells, _HasPolys]

class Tree:
    @property
    def voxel_size(self) -> float: ...
    @property
    def leaves(self) -> int: ...
    @property
    def triangles(self) -> int: ...
    @property
    def depth(self) -> int: ...
    @property
    def nbytes(self) -> int: ...
    @property
    def spheres(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def frame(self) -> Frame: ...
    @property
    def outward(self) -> bool: ...
    @property
    def self_intersections(self) -> int: ...
    @property
    def prepared_for_depth(self) -> bool: ...
    def prepare_depth(self, *, max_memory: int = 1073741824, progress: Optional[Follow] = None) -> Tree: ...
    @property
    def origin(self) -> F8: ...
    @property
    def vertices(self) -> F8: ...
    @property
    def faces(self) -> U4: ...
    @property
    def leaf_centres(self) -> F8: ...
    def save(self, path: Path, *, progress: Optional[Follow] = None) -> None: ...
    def to_bytes(self, *, progress: Optional[Follow] = None) -> bytes: ...
    def free(self) -> None: ...
    def __enter__(self) -> Tree: ...
    def __exit__(
        self, kind: Optional[Type[BaseException]], value: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None: ...

def build(
    mesh: Union[Path, _HasMesh, Tuple[ArrayLike, ArrayLike]],
    voxel_size: float = 0.0,
    *,
    spheres: Spheres = "default",
    keep_triangles: bool = True,
    proximity: bool = False,
    weld: bool = True,
    frame: Frame = "unknown",
    max_memory: int = 4 << 30,
    progress: Optional[Follow] = None,
) -> Tree: ...
def load(source: Union[Path, bytes, bytearray, memoryview], *, progress: Optional[Follow] = None) -> Tree: ...
def read_mesh(path: Path, *, progress: Optional[Follow] = None) -> Mesh: ...
def jaws(seed: int = 1) -> Tuple[Mesh, Mesh]: ...

class LeafPairs(NamedTuple):
    pairs: Records
    count: int  # type: ignore[assignment]  # not the method of tuples
    complete: bool
    truncated: bool
    level: int
    distance: Optional[Tuple[float, float]]
    resolution: float
    sphere_tests: int
    rotation_error: float

class Contacts(NamedTuple):
    contacts: Records
    count: int  # type: ignore[assignment]  # not the method of tuples
    complete: bool
    leaf_pairs: int
    area: float
    sphere_tests: int
    sums: Records
    rotation_error: float
    def wrench(self, stiffness: float) -> Tuple[F8, F8, F8]: ...

class Distance(NamedTuple):
    lower: float
    upper: float
    complete: bool
    narrowest: float
    sphere_tests: int
    rotation_error: float
    nearest_fixed: Optional[F8]
    nearest_moving: Optional[F8]
    direction: Optional[F8]
    triangles: Optional[Tuple[int, int]]

class TrianglePairs(NamedTuple):
    pairs: Records
    count: int  # type: ignore[assignment]  # not the method of tuples
    complete: bool
    truncated: bool
    sphere_tests: int
    rotation_error: float

class NearPairs(NamedTuple):
    pairs: Records
    count: int  # type: ignore[assignment]  # not the method of tuples
    complete: bool
    truncated: bool
    pad: float
    kept: bool
    sphere_tests: int
    rotation_error: float

class Penetration(NamedTuple):
    lower: float
    upper: float
    complete: bool
    point: F8
    direction: F8
    of_moving: bool
    triangle: int
    not_closed: Optional[Literal["fixed", "moving"]]
    narrowest: float
    points: int
    self_intersecting: Optional[Literal["fixed", "moving", "both"]] = ...
    capped: bool = ...
    rotation_error: float = ...

class Escape(NamedTuple):
    status: Literal["found", "not needed", "not found", "unknown"]
    motion: F8
    pose: F8
    lower: float
    upper: float
    verdicts: int
    rotation_error: float

class FirstContact(NamedTuple):
    outcome: Literal["contact", "none", "grazing", "touches at start", "inside at start", "stopped"]
    lower: float
    upper: float
    distance: Tuple[float, float]
    triangles: Optional[Tuple[int, int]]
    grazed: bool
    narrowest: float
    distances: int
    self_intersecting: Optional[Literal["fixed", "moving", "both"]]
    rotation_error: float
    place: Optional[Tuple[F8, F8]]
    normal: Optional[F8]
    passes: bool

class Settlement(NamedTuple):
    status: Literal["rests", "rests level", "left the box", "stopped", "no free pose", "unknown"]
    pose: F8
    free: bool
    contacts: Records
    distance: Tuple[float, float]
    residual: float
    remaining: float
    second_order: float
    margin: float
    rocks: bool
    level: F8
    moved: F8
    closed: float
    load_point: F8
    radius: float
    reach: float
    load_guessed: bool
    unit_guessed: bool
    opened: bool
    steps: int
    rotation_error: float

class BodyOcclusion(NamedTuple):
    distances: Records
    regions: Records
    areas: F8
    total_area: float
    penetrating_area: float
    depth_integral: float
    depth_at_vertices: float

class Occlusion(NamedTuple):
    limits: F8
    fixed: BodyOcclusion
    moving: BodyOcclusion
    rotation_error: float

class Query:
    def __init__(
        self,
        fixed: Tree,
        moving: Tree,
        *,
        spheres: Spheres = "default",
        workers: Literal[1, 2] = 1,
        contacts: int = 32,
        margin: float = 0.0,
        front_pairs: int = 0,
        near_pairs: int = 0,
        target: Optional[str] = None,
    ) -> None: ...
    @property
    def fixed(self) -> Tree: ...
    @property
    def moving(self) -> Tree: ...
    @property
    def spheres(self) -> str: ...
    @property
    def target(self) -> str: ...
    @property
    def workers(self) -> int: ...
    @property
    def has_triangles(self) -> bool: ...
    @property
    def nbytes(self) -> int: ...
    def intersects(self, pose: ArrayLike, *, tests: int = 0, seconds: float = 0.0) -> Optional[bool]: ...
    def leaf_pairs(
        self,
        pose: ArrayLike,
        *,
        out: Optional[Records] = None,
        most: Optional[int] = None,
        tests: int = 0,
        seconds: float = 0.0,
    ) -> LeafPairs: ...
    def contacts(
        self, pose: ArrayLike, *, out: Optional[Records] = None, tests: int = 0, seconds: float = 0.0
    ) -> Contacts: ...
    def distance(
        self, pose: ArrayLike, tolerance: float = 0.0, *, tests: int = 0, seconds: float = 0.0
    ) -> Distance: ...
    def triangle_pairs(
        self,
        pose: ArrayLike,
        *,
        out: Optional[Records] = None,
        most: Optional[int] = None,
        tests: int = 0,
        seconds: float = 0.0,
    ) -> TrianglePairs: ...
    def near_pairs(
        self,
        pose: ArrayLike,
        margin: float,
        *,
        out: Optional[Records] = None,
        most: Optional[int] = None,
        tests: int = 0,
        seconds: float = 0.0,
    ) -> NearPairs: ...
    def near_parts(self, pose: ArrayLike, triangles: Sequence[int], margin: float) -> NearPairs: ...
    def penetration(
        self,
        pose: ArrayLike,
        tolerance: float,
        *,
        last: Optional[Penetration] = None,
        points: int = 0,
        seconds: float = 0.0,
        progress: Optional[Follow] = None,
    ) -> Penetration: ...
    def escape(
        self,
        pose: ArrayLike,
        tolerance: float = 0.0,
        *,
        longest: float = ...,
        progress: Optional[Follow] = None,
    ) -> Escape: ...
    def first_contact(
        self,
        start: ArrayLike,
        stop: ArrayLike,
        tolerance: float,
        *,
        distances: int = 0,
        seconds: float = 0.0,
        progress: Optional[Follow] = None,
    ) -> FirstContact: ...
    def settle(
        self,
        pose: Optional[ArrayLike] = None,
        *,
        closing: ArrayLike = (0.0, 0.0, 1.0),
        at: Optional[ArrayLike] = None,
        hold: Sequence[Literal["x", "y", "z", "roll", "pitch", "yaw"]] = (),
        within: Optional[Tuple[float, float]] = None,
        reach: float = 0.0,
        steps: int = 0,
        progress: Optional[Follow] = None,
    ) -> Settlement: ...
    def occlusion(
        self,
        pose: Optional[ArrayLike] = None,
        *,
        limits: Sequence[float] = (0.05, 0.1, 0.2, 0.35),
        reach: float = 2.0,
        contact: float = 0.1,
        least_area: float = 0.01,
        longest_edge: float = 0.2,
        foundation: float = 0.1,
        change: float = 0.05,
        progress: Optional[Follow] = None,
    ) -> Occlusion: ...
    def rows(
        self,
        poses: ArrayLike,
        *,
        want: Sequence[Question] = ("intersects", "distance"),
        tolerance: float = 0.0,
        stiffness: float = 1.0,
        tests: int = 0,
        threads: int = 0,
        out: Optional[Records] = None,
        progress: Optional[Follow] = None,
    ) -> Records: ...
    def forget(self) -> None: ...
    def free(self) -> None: ...
    def __enter__(self) -> Query: ...
    def __exit__(
        self, kind: Optional[Type[BaseException]], value: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None: ...

class WorldAnswer(NamedTuple):
    pairs: Records
    count: int  # type: ignore[assignment]  # not the method of tuples
    complete: bool
    truncated: bool
    sphere_tests: int
    found: Optional[Records]
    def found_of(self, row: Any) -> Records: ...

class LeastDistance(NamedTuple):
    lower: float
    upper: float
    complete: bool
    nearest: Optional[Tuple[int, int]]
    pose_missing: bool
    sphere_tests: int
    nearest_fixed: Optional[F8] = ...
    nearest_moving: Optional[F8] = ...
    direction: Optional[F8] = ...
    triangles: Optional[Tuple[int, int]] = ...

class World:
    def __init__(
        self,
        *,
        spheres: Spheres = "default",
        contacts: int = 32,
        margin: float = 0.0,
        front_pairs: int = 0,
        frontier_pairs: int = 0,
        target: Optional[str] = None,
        reach: float = 0.0,
        threads: int = 1,
        pair_caches: int = 16,
        max_memory: int = 4 << 30,
    ) -> None: ...
    @property
    def bodies(self) -> Tuple[Tree, ...]: ...
    @property
    def names(self) -> Tuple[str, ...]: ...
    @property
    def nbytes(self) -> int: ...
    def add(self, tree: Tree, pose: Optional[ArrayLike] = None, name: Optional[str] = None) -> int: ...
    def ignore(self, a: int, b: int) -> None: ...
    def bytes_needed(self, near_pairs: Optional[int] = None) -> int: ...
    def reserve(self, near_pairs: Optional[int] = None) -> None: ...
    def set_pose(self, body: int, pose: ArrayLike) -> None: ...
    def pose_of(self, a: int, b: int) -> F8: ...
    def ask(
        self,
        question: WorldQuestion,
        *,
        tolerance: float = 0.0,
        into: Optional[Records] = None,
        out: Optional[Records] = None,
        tests: int = 0,
        seconds: float = 0.0,
    ) -> WorldAnswer: ...
    def near_pairs(self, *, out: Optional[Records] = None) -> WorldAnswer: ...
    def intersects(self, *, out: Optional[Records] = None, tests: int = 0, seconds: float = 0.0) -> WorldAnswer: ...
    def contacts(self, *, out: Optional[Records] = None, tests: int = 0, seconds: float = 0.0) -> WorldAnswer: ...
    def contacts_of(self, a: int, b: int, *, out: Optional[Records] = None) -> Contacts: ...
    def distances(
        self, tolerance: float = 0.0, *, out: Optional[Records] = None, tests: int = 0, seconds: float = 0.0
    ) -> WorldAnswer: ...
    def leaf_pairs(
        self,
        *,
        into: Optional[Records] = None,
        out: Optional[Records] = None,
        tests: int = 0,
        seconds: float = 0.0,
    ) -> WorldAnswer: ...
    def triangle_pairs(
        self,
        *,
        into: Optional[Records] = None,
        out: Optional[Records] = None,
        tests: int = 0,
        seconds: float = 0.0,
    ) -> WorldAnswer: ...
    def distance(self, tolerance: float = 0.0, *, tests: int = 0, seconds: float = 0.0) -> LeastDistance: ...
    def forget(self) -> None: ...
    def free(self) -> None: ...
    def __enter__(self) -> World: ...
    def __exit__(
        self, kind: Optional[Type[BaseException]], value: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None: ...

class PoseChange(NamedTuple):
    about: F8
    translation: F8
    rotation: F8
    axis: F8
    axis_point: Optional[F8]
    angle: float
    along: float
    rotation_error: float

def motion_between(before: ArrayLike, after: ArrayLike, about: ArrayLike = ...) -> PoseChange: ...
def match_contacts(
    before: ArrayLike,
    after: ArrayLike,
    within: float = ...,
    *,
    before_teeth: Optional[ArrayLike] = None,
    after_teeth: Optional[ArrayLike] = None,
) -> NDArray[np.int32]: ...
def rotation_error(pose: ArrayLike) -> float: ...
def signed_distance(
    tree: Tree,
    points: ArrayLike,
    *,
    reach: float = ...,
    out: Optional[Records] = None,
    progress: Optional[Follow] = None,
) -> Records: ...
def distance_map(
    body: Tree,
    other: Tree,
    pose: Optional[ArrayLike] = None,
    *,
    reach: float = ...,
    out: Optional[Records] = None,
    progress: Optional[Follow] = None,
) -> Records: ...
def occlusion(fixed: Tree, moving: Tree, pose: Optional[ArrayLike] = None, **options: Any) -> Occlusion: ...

class ServoBody(NamedTuple):
    name: str
    held: bool
    pose: F8

class ServoState(NamedTuple):
    tick: int
    device: F8
    tool: F8
    force: F8
    torque: F8
    contacts: Records
    device_known: bool
    fault: bool
    held: bool
    halved: bool
    steps: int
    begin_ns: int
    execution_ns: int

class ServoTick(NamedTuple):
    force: F8
    torque: F8

class Servo:
    def __init__(
        self,
        scene: Path,
        *,
        unit: Literal["m", "mm"] = "mm",
        query_time_fraction: float = 0.7,
        sphere_tests: int = 0,
        max_memory: int = 4 << 30,
        progress: Optional[Follow] = None,
    ) -> None: ...
    @property
    def warnings(self) -> Tuple[str, ...]: ...
    @property
    def tick_seconds(self) -> float: ...
    @property
    def tool(self) -> F8: ...
    @property
    def ticks(self) -> int: ...
    @property
    def held(self) -> int: ...
    @property
    def faults(self) -> int: ...
    @property
    def late(self) -> int: ...
    @property
    def bodies(self) -> Tuple[ServoBody, ...]: ...
    @property
    def contacts(self) -> Records: ...
    def last(self) -> Optional[ServoState]: ...
    def tick(self, pose: Optional[ArrayLike], *, out: Optional[F8] = None) -> ServoTick: ...
    def attach(self, body: str) -> None: ...
    def release(self, body: str) -> None: ...
    def free(self) -> None: ...
    def __enter__(self) -> Servo: ...
    def __exit__(
        self, kind: Optional[Type[BaseException]], value: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None: ...

class SweepPart(NamedTuple):
    part: int
    outcome: Literal["made", "there", "given up"]
    rows: int
    seconds: float

class SweepTable(NamedTuple):
    rows: int
    missing: List[int]
    given_up: List[int]

class SweepStatus(NamedTuple):
    done: List[int]
    missing: List[int]
    given_up: List[int]
    damaged: List[int]
    seconds: float

class Sweep:
    def __init__(self, path: Path, folder: Optional[Path] = None, *, progress: Optional[Follow] = None) -> None: ...
    @property
    def path(self) -> _AbsolutePath: ...
    @property
    def folder(self) -> _AbsolutePath: ...
    @property
    def rows(self) -> int: ...
    @property
    def rows_per_part(self) -> int: ...
    @property
    def parts(self) -> range: ...
    @property
    def hash(self) -> str: ...
    @property
    def columns(self) -> np.dtype[np.void]: ...
    def poses(self, first: int, count: int) -> F8: ...
    def run(
        self, part: int, folder: Optional[Path] = None, *, threads: int = 0, progress: Optional[Follow] = None
    ) -> SweepPart: ...
    def merge(self, folder: Optional[Path] = None, *, progress: Optional[Follow] = None) -> SweepTable: ...
    def status(
        self, folder: Optional[Path] = None, *, verify: bool = False, progress: Optional[Follow] = None
    ) -> SweepStatus: ...
    def free(self) -> None: ...
    def __enter__(self) -> Sweep: ...
    def __exit__(
        self, kind: Optional[Type[BaseException]], value: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None: ...
