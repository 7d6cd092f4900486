"""The shared library and the prototypes of its functions."""

import ctypes
import os
import pathlib

from ctypes import c_char_p, c_double, c_int32, c_size_t, c_uint32, c_uint64, c_void_p

ABI_VERSION = 1
SONAME = "libist.so.0"

# Addresses are passed as numbers: ctypes converts these fastest.
PROTOTYPES = {
    "ist_abi_version": (c_uint32, []),
    "ist_version_string": (c_char_p, []),
    "ist_status_name": (c_char_p, [c_int32]),
    "ist_last_error_message": (c_char_p, []),
    "ist_mesh_create": (c_int32, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p]),
    "ist_mesh_create_float": (c_int32, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p]),
    "ist_mesh_read": (c_int32, [c_char_p, c_void_p, c_void_p]),
    "ist_mesh_get_size": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "ist_mesh_copy": (c_int32, [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t]),
    "ist_mesh_free": (c_int32, [c_void_p]),
    "ist_jaw_create": (c_int32, [c_int32, c_uint64, c_void_p]),
    "ist_tree_build": (c_int32, [c_void_p, c_void_p, c_void_p]),
    "ist_tree_load": (c_int32, [c_char_p, c_void_p, c_void_p]),
    "ist_tree_save": (c_int32, [c_void_p, c_char_p, c_void_p]),
    "ist_tree_to_memory": (c_int32, [c_void_p, c_void_p, c_size_t, c_void_p, c_void_p]),
    "ist_tree_from_memory": (c_int32, [c_void_p, c_size_t, c_void_p, c_void_p]),
    "ist_tree_get_mesh": (c_int32, [c_void_p, c_void_p]),
    "ist_tree_get_info": (c_int32, [c_void_p, c_void_p]),
    "ist_tree_self_intersections": (c_int32, [c_void_p, c_void_p]),
    "ist_tree_copy_leaf_centres": (c_int32, [c_void_p, c_void_p, c_size_t]),
    "ist_tree_free": (c_int32, [c_void_p]),
    "ist_query_create": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p]),
    "ist_query_get_info": (c_int32, [c_void_p, c_void_p]),
    "ist_rotation_error": (c_int32, [c_void_p, c_void_p]),
    "ist_query_intersects": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p]),
    "ist_query_leaf_pairs": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p]),
    "ist_query_contacts": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p, c_void_p]),
    "ist_query_distance": (c_int32, [c_void_p, c_void_p, c_double, c_void_p, c_void_p]),
    "ist_query_triangle_pairs": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p]),
    "ist_query_penetration": (c_int32, [c_void_p, c_void_p, c_double, c_void_p, c_void_p, c_void_p, c_void_p]),
    "ist_query_first_contact": (c_int32, [c_void_p, c_void_p, c_double, c_void_p, c_void_p, c_void_p]),
    "ist_query_occlusion": (
        c_int32,
        [c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p],
    ),
    "ist_query_rows": (c_int32, [c_void_p, c_void_p, c_size_t, c_void_p, c_void_p]),
    "ist_query_forget": (c_int32, [c_void_p]),
    "ist_query_free": (c_int32, [c_void_p]),
    "ist_tree_signed_distance": (c_int32, [c_void_p, c_void_p, c_size_t, c_double, c_void_p, c_void_p]),
    "ist_tree_distance_map": (
        c_int32,
        [c_void_p, c_void_p, c_void_p, c_double, c_void_p, c_void_p, c_size_t, c_void_p],
    ),
    "ist_servo_open_scene": (c_int32, [c_char_p, c_void_p, c_void_p]),
    "ist_servo_warning": (c_char_p, [c_void_p, c_size_t]),
    "ist_servo_get_info": (c_int32, [c_void_p, c_void_p]),
    "ist_servo_on_tick": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p]),
    "ist_servo_get_body": (c_int32, [c_void_p, c_size_t, c_void_p]),
    "ist_servo_attach": (c_int32, [c_void_p, c_char_p]),
    "ist_servo_release": (c_int32, [c_void_p, c_char_p]),
    "ist_servo_free": (c_int32, [c_void_p]),
    "ist_sweep_open": (c_int32, [c_char_p, c_void_p, c_void_p]),
    "ist_sweep_get_info": (c_int32, [c_void_p, c_void_p]),
    "ist_sweep_get_column": (c_int32, [c_void_p, c_uint64, c_void_p]),
    "ist_sweep_get_poses": (c_int32, [c_void_p, c_uint64, c_size_t, c_void_p]),
    "ist_sweep_run_part": (c_int32, [c_void_p, c_char_p, c_uint64, c_int32, c_void_p, c_void_p]),
    "ist_sweep_get_part": (c_int32, [c_void_p, c_char_p, c_uint64, c_int32, c_void_p]),
    "ist_sweep_merge": (c_int32, [c_void_p, c_char_p, c_void_p, c_void_p]),
    "ist_sweep_free": (c_int32, [c_void_p]),
    "ist_world_create": (c_int32, [c_void_p, c_void_p]),
    "ist_world_add": (c_int32, [c_void_p, c_void_p, c_void_p, c_char_p, c_void_p]),
    "ist_world_ignore": (c_int32, [c_void_p, c_uint32, c_uint32]),
    "ist_world_bytes_needed": (c_int32, [c_void_p, c_void_p, c_size_t, c_void_p]),
    "ist_world_prepare": (c_int32, [c_void_p, c_void_p, c_size_t, c_void_p]),
    "ist_world_get_info": (c_int32, [c_void_p, c_void_p]),
    "ist_world_set_pose": (c_int32, [c_void_p, c_uint32, c_void_p]),
    "ist_world_get_pose": (c_int32, [c_void_p, c_uint32, c_uint32, c_void_p]),
    "ist_world_ask": (c_int32, [c_void_p, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p]),
    "ist_world_get_contacts": (c_int32, [c_void_p, c_uint32, c_uint32, c_void_p, c_size_t, c_void_p, c_void_p]),
    "ist_world_distance": (c_int32, [c_void_p, c_double, c_void_p, c_void_p]),
    "ist_world_forget": (c_int32, [c_void_p]),
    "ist_world_free": (c_int32, [c_void_p]),
}


def candidates():
    """Where the library may be: the file that IST_LIBRARY names, beside the modules, where the loader looks."""
    named = os.environ.get("IST_LIBRARY")
    if named:
        return [named]
    beside = pathlib.Path(__file__).parent / SONAME
    return [str(beside)] if beside.exists() else [SONAME]


def load():
    """Returns the library with its prototypes. Raises ImportError, which names the remedy."""
    (name,) = candidates()
    try:
        library = ctypes.CDLL(name)
    except OSError as error:
        raise ImportError(
            f"ist: {error}: install the package libist0, use the wheel, which has the library inside, "
            "or name the library's file in IST_LIBRARY"
        ) from None
    try:
        library.ist_abi_version.restype = c_uint32
        version = library.ist_abi_version()
        if version < ABI_VERSION:
            raise AttributeError(f"its interface is of version {version}, and this package needs {ABI_VERSION}")
        for function, (result, arguments) in PROTOTYPES.items():
            prototype = getattr(library, function)
            prototype.restype, prototype.argtypes = result, arguments
    except AttributeError as error:
        raise ImportError(
            f"ist: {name} does not fit this package: {error}: install the library and the package of one version"
        ) from None
    return library


LIBRARY = load()


def bare(name):
    """Returns a function of the library that takes arguments of ctypes alone, and converts none: that takes half the time."""
    function = LIBRARY[name]  # another object than LIBRARY's attribute, which has the prototype
    function.restype = c_int32
    return function
