"""Where two rigid triangle meshes touch, how deep, how far apart.

Lengths are in the meshes' unit, millimetres by habit. A pose is (4, 4) float64, row by row, and maps the moving body to the
fixed one: p_fixed = pose @ p_moving. Answers are structured arrays and named tuples.

>>> import ist, numpy as np
>>> upper, lower = (ist.build(jaw) for jaw in ist.jaws())
>>> query = ist.Query(upper, lower)
>>> query.intersects(np.eye(4))
True

Research software, not a medical device.
"""

from ._answers import (
    BodyOcclusion,
    Contacts,
    Distance,
    Escape,
    FirstContact,
    LeafPairs,
    LeastDistance,
    NearPairs,
    Occlusion,
    Penetration,
    PoseChange,
    ServoBody,
    ServoState,
    ServoTick,
    Settlement,
    SweepPart,
    SweepStatus,
    SweepTable,
    TrianglePairs,
    WorldAnswer,
)
from ._c import CONTACT, CONTACT_REGION, LEAF_PAIR, NEAR_PAIR, ROW, SERVO_CONTACT, SETTLE_CONTACT, SURFACE_DISTANCE, TRIANGLE_PAIR, WORLD_PAIR
from ._c import IST_ANSWER_NEAR as NEAR, IST_ANSWER_NO as NO, IST_ANSWER_UNKNOWN as UNKNOWN, IST_ANSWER_YES as YES
from ._c import IST_NO_TRIANGLE as NO_TRIANGLE
from ._errors import (
    NOT_PREPARED,
    POSE_INVALID,
    TRIANGLES_MISSING,
    VOXELS_MISSING,
    BusyError,
    ChangeRefused,
    Error,
    FileError,
    FreedError,
    InputError,
    MemoryLimitError,
)
from ._library import LIBRARY as _LIBRARY
from ._measures import distance_map, match_contacts, motion_between, rotation_error, signed_distance
from ._mesh import jaws, read_mesh
from ._query import Query
from ._servo import Servo
from ._sweep import Sweep
from ._tree import Tree, build, load
from ._world import World

__version__ = _LIBRARY.ist_version_string().decode()


def occlusion(fixed, moving, pose=None, **options):
    """Measures the occlusion of two trees, as Query.occlusion() does, by a query of its own. p_fixed = pose @ p_moving."""
    with Query(fixed, moving, contacts=-1) as query:
        return query.occlusion(pose, **options)


__all__ = [name for name in dir() if not name.startswith("_")]
