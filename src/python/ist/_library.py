"""The shared library and the prototypes of its functions."""

import ctypes
import os
import pathlib

from ctypes import c_int32, c_uint32

from ._c import IST_ABI_VERSION as ABI_VERSION, PROTOTYPES

SONAME = "libist_loop.so.0"


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
        raise ImportError(f"ist: {name} does not fit this package: {error}: {remedy_for(library)}") from None
    return library


def remedy_for(library):
    """Returns what to do about a library that lacks functions."""
    if hasattr(library, "ist_tree_load") and not hasattr(library, "ist_jaw_create"):  # libist, without libist_loop
        return f"name {SONAME} in IST_LIBRARY, which has all functions"
    return "install the library and the package of one version"


LIBRARY = load()


def bare(name):
    """Returns a function of the library that takes arguments of ctypes alone, and converts none: that takes half the time."""
    function = LIBRARY[name]  # another object than LIBRARY's attribute, which has the prototype
    function.restype = c_int32
    return function
