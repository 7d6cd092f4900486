"""The library's structs: as dtypes where they are elements of arrays, as ctypes where they are options and results."""

import ctypes
import struct
import sys

from ctypes import POINTER, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p

import numpy as np

LEAF_PAIR = np.dtype([("fixed", "u4"), ("moving", "u4")])
TRIANGLE_PAIR = np.dtype([("fixed", "u4"), ("moving", "u4")])
CONTACT = np.dtype([("position", "f8", 3), ("normal", "f8", 3), ("depth", "f8"), ("weight", "f8")])
SURFACE_DISTANCE = np.dtype([("distance", "f8"), ("closest", "f8", 3), ("triangle", "u4"), ("is_signed", "i2"), ("self_intersecting", "i2")])
CONTACT_REGION = np.dtype(
    [
        ("area", "f8"),
        ("centre", "f8", 3),
        ("least_distance", "f8"),
        ("closest", "f8", 3),
        ("penetrating_area", "f8"),
        ("depth_integral", "f8"),
        ("share", "f8"),
        ("share_thinner", "f8"),
        ("share_thicker", "f8"),
        ("triangle", "u4"),
        ("partner", "i4"),
    ]
)
ROW = np.dtype(
    [
        ("status", "i4"),
        ("intersects", "i4"),
        ("complete", "i4"),
        ("not_closed", "i4"),
        ("leaf_pairs", "u8"),
        ("sphere_tests", "u8"),
        ("distance_lower", "f8"),
        ("distance_upper", "f8"),
        ("depth_lower", "f8"),
        ("depth_upper", "f8"),
        ("area", "f8"),
        ("force", "f8", 3),
        ("torque", "f8", 3),
        ("rotation_error", "f8"),
        ("self_intersecting", "i4"),
        ("capped", "i4"),
    ]
)
WORLD_PAIR = np.dtype(
    [
        ("a", "u4"),
        ("b", "u4"),
        ("status", "i4"),
        ("answer", "i4"),
        ("complete", "i4"),
        ("truncated", "i4"),
        ("distance_lower", "f8"),
        ("distance_upper", "f8"),
        ("found", "u8"),
        ("first", "u8"),
        ("written", "u8"),
        ("contacts", "u8"),
        ("resolution", "f8"),
        ("narrowest", "f8"),
        ("sphere_tests", "u8"),
        ("rotation_error", "f8"),
    ]
)
CONTACT_SUMS = np.dtype(
    [
        ("struct_size", "u8"),
        ("pairs", "u8"),
        ("weight", "f8"),
        ("pressure_force", "f8", 3),
        ("pressure_torque", "f8", 3),
        ("spring_force", "f8", 3),
        ("spring_torque", "f8", 3),
        ("about", "f8", 3),
    ]
)


class Sized(ctypes.Structure):
    """A struct that begins with its size."""

    def __init__(self, **members):
        super().__init__(struct_size=ctypes.sizeof(type(self)), **members)


REPORT = ctypes.CFUNCTYPE(c_int32, c_void_p, c_double)


class Progress(Sized):
    _fields_ = [("struct_size", c_size_t), ("report", REPORT), ("user", c_void_p)]


class BuildOptions(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("voxel_size", c_double),
        ("spheres", c_int32),
        ("drop_triangles", c_int32),
        ("proximity", c_int32),
        ("no_weld", c_int32),
        ("max_memory", c_uint64),
        ("progress", POINTER(Progress)),
        ("frame", c_int32),
        ("reserved", c_int32),
    ]


class TreeInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("voxel_size", c_double),
        ("leaves", c_uint64),
        ("triangles", c_uint64),
        ("bytes", c_uint64),
        ("depth", c_int32),
        ("spheres", c_int32),
        ("has_triangles", c_int32),
        ("has_proximity", c_int32),
        ("outward", c_int32),
        ("unit", c_int32),
        ("origin", c_double * 3),
        ("bounding_radius", c_double),
        ("largest_leaf_radius", c_double),
        ("frame", c_int32),
        ("reserved", c_int32),
    ]


class ContactSums(Sized):
    """One element of CONTACT_SUMS."""

    _fields_ = [
        ("struct_size", c_size_t),
        ("pairs", c_uint64),
        ("weight", c_double),
        ("pressure_force", c_double * 3),
        ("pressure_torque", c_double * 3),
        ("spring_force", c_double * 3),
        ("spring_torque", c_double * 3),
        ("about", c_double * 3),
    ]


class QueryOptions(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("spheres", c_int32),
        ("workers", c_int32),
        ("period_ns", c_int64),
        ("frontier_pairs", c_uint64),
        ("reserved", c_uint64),
        ("contacts", c_int64),
        ("target", ctypes.c_char_p),
        ("margin", c_double),
        ("front_pairs", c_uint64),
    ]


class QueryInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("bytes", c_uint64),
        ("contacts", c_uint64),
        ("spheres", c_int32),
        ("workers", c_int32),
        ("has_triangles", c_int32),
        ("reserved", c_int32),
        ("target", ctypes.c_char * 16),
    ]


class Budget(Sized):
    _fields_ = [("struct_size", c_size_t), ("tests", c_uint64), ("nanoseconds", c_uint64)]


class QueryResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("leaf_pairs", c_uint64),
        ("contacts", c_uint64),
        ("written", c_uint64),
        ("sphere_tests", c_uint64),
        ("complete", c_int32),
        ("truncated", c_int32),
        ("level", c_int32),
        ("distance_known", c_int32),
        ("distance_lower", c_double),
        ("distance_upper", c_double),
        ("resolution", c_double),
        ("found", c_int32),
        ("reserved", c_int32),
        ("rotation_error", c_double),
    ]


class DistanceResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lower", c_double),
        ("upper", c_double),
        ("sphere_tests", c_uint64),
        ("complete", c_int32),
        ("reserved", c_int32),
        ("narrowest", c_double),
        ("rotation_error", c_double),
    ]


class TrianglePairsResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("pairs", c_uint64),
        ("written", c_uint64),
        ("sphere_tests", c_uint64),
        ("truncated", c_int32),
        ("complete", c_int32),
        ("rotation_error", c_double),
    ]


class PenetrationResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lower", c_double),
        ("upper", c_double),
        ("point", c_double * 3),
        ("direction", c_double * 3),
        ("of_moving", c_int32),
        ("triangle", c_uint32),
        ("complete", c_int32),
        ("not_closed", c_int32),
        ("narrowest", c_double),
        ("points", c_uint64),
        ("self_intersecting", c_int32),
        ("capped", c_int32),
        ("rotation_error", c_double),
    ]


class Motion(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("from_", c_void_p),
        ("to", c_void_p),
        ("point", c_double * 3),
        ("direction", c_double * 3),
        ("angle", c_double),
        ("along", c_double),
    ]


class FirstContactResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lower", c_double),
        ("upper", c_double),
        ("distance_lower", c_double),
        ("distance_upper", c_double),
        ("outcome", c_int32),
        ("grazed", c_int32),
        ("triangles_known", c_int32),
        ("fixed", c_uint32),
        ("moving", c_uint32),
        ("self_intersecting", c_int32),
        ("narrowest", c_double),
        ("distances", c_uint64),
        ("rotation_error", c_double),
    ]


class OcclusionOptions(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("reach", c_double),
        ("contact", c_double),
        ("least_area", c_double),
        ("longest_edge", c_double),
        ("foundation", c_double),
        ("change", c_double),
        ("limits", c_void_p),
        ("limit_count", c_size_t),
    ]


class OcclusionArrays(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("distances", c_void_p),
        ("distance_capacity", c_size_t),
        ("regions", c_void_p),
        ("region_capacity", c_size_t),
        ("areas", c_void_p),
    ]


class OcclusionSums(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("vertices", c_uint64),
        ("regions", c_uint64),
        ("total_area", c_double),
        ("penetrating_area", c_double),
        ("depth_integral", c_double),
        ("depth_at_vertices", c_double),
        ("rotation_error", c_double),
    ]


class RowsOptions(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("questions", c_int32),
        ("threads", c_int32),
        ("tolerance", c_double),
        ("stiffness", c_double),
        ("tests", c_uint64),
        ("progress", POINTER(Progress)),
    ]


class ServoOptions(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("unit", c_int32),
        ("reserved", c_int32),
        ("query_time_fraction", c_double),
        ("sphere_tests", c_uint64),
        ("max_memory", c_uint64),
        ("progress", POINTER(Progress)),
    ]


class ServoInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("tick_seconds", c_double),
        ("tool", c_double * 16),
        ("ticks", c_uint64),
        ("held", c_uint64),
        ("faults", c_uint64),
        ("late", c_uint64),
        ("bodies", c_size_t),
    ]


class ServoBodyInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", ctypes.c_char_p),
        ("held", c_int32),
        ("reserved", c_int32),
        ("pose", c_double * 16),
    ]


class WorldOptions(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("query", POINTER(QueryOptions)),
        ("reach", c_double),
        ("most_near", c_uint64),
        ("max_memory", c_uint64),
    ]


class WorldInfo(Sized):
    _fields_ = [("struct_size", c_size_t), ("bytes", c_uint64), ("bodies", c_uint64)]


class WorldQuestion(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("ask", c_int32),
        ("reserved", c_int32),
        ("tolerance", c_double),
        ("leaf_pairs", c_void_p),
        ("leaf_capacity", c_size_t),
        ("triangles", c_void_p),
        ("triangle_capacity", c_size_t),
    ]


class WorldResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("near_pairs", c_uint64),
        ("written", c_uint64),
        ("sphere_tests", c_uint64),
        ("complete", c_int32),
        ("truncated", c_int32),
    ]


class LeastDistanceResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("lower", c_double),
        ("upper", c_double),
        ("sphere_tests", c_uint64),
        ("complete", c_int32),
        ("pose_missing", c_int32),
        ("nearest_known", c_int32),
        ("a", c_uint32),
        ("b", c_uint32),
        ("reserved", c_int32),
    ]


# Members of a struct, read at once. A flag is a c_int32 of 0 or 1, of which one byte is read as a bool.
_FLAG = "?3x" if sys.byteorder == "little" else "3x?"
# leaf_pairs, written, sphere_tests, complete, truncated, level, distance_known, distance_lower, distance_upper, resolution,
# rotation_error
read_leaf_pairs = struct.Struct(f"=8xQ8xQQ{_FLAG}{_FLAG}i{_FLAG}ddd8xd").unpack_from
# leaf_pairs, contacts, written, sphere_tests, complete, rotation_error
read_contacts = struct.Struct(f"=8xQQQQ{_FLAG}44xd").unpack_from
# lower, upper, sphere_tests, complete, narrowest, rotation_error
read_distance = struct.Struct(f"=8xddQ{_FLAG}4xdd").unpack_from
# pairs, written, sphere_tests, truncated, complete, rotation_error
read_triangle_pairs = struct.Struct(f"=8xQQQ{_FLAG}{_FLAG}d").unpack_from
