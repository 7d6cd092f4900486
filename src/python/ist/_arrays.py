"""Arrays and numbers of the caller, as the library takes them. What makes no sense is an InputError."""

import ctypes
import math
import operator
import struct
import sys

import numpy as np

from ._c import Budget
from ._errors import refuse


_pointer = ctypes.c_void_p.from_address
_HEAD = object.__basicsize__
_FIELDS = struct.Struct("PiPPPPi")  # data, dimensions, lengths, strides, base, dtype, flags
_fields = (ctypes.c_char * _FIELDS.size).from_address


def asked(array):
    """Returns where an array's data begin, as the array says."""
    return array.ctypes.data


# CPython's objects lie at their id, and behind its head an array has fields that programs compiled for NumPy read there too. The
# first one is where its data begin: to read it takes a tenth of the time.
def behind_the_head(array):
    """Returns where an array's data begin, by the place of this number in memory."""
    return _pointer(id(array) + _HEAD).value


def _are_behind_the_head():
    if sys.implementation.name != "cpython":
        return False
    arrays = [np.zeros(3), np.zeros((2, 5), np.uint8)[:, 1:], np.zeros(9, np.int16)]
    arrays[2].setflags(write=False)
    for array in arrays:
        data, dimensions, _, _, base, dtype, flags = _FIELDS.unpack(_fields(id(array) + _HEAD).raw)
        if (data, dimensions, dtype, flags) != (asked(array), array.ndim, id(array.dtype), array.flags.num):
            return False
        if base != (0 if array.base is None else id(array.base)):
            return False
    return True


_CAN_READ = _are_behind_the_head()
address = behind_the_head if _CAN_READ else asked


def floats(values, shape, what, dtype=np.float64):
    """Returns an array of floats, in C order and aligned, of a shape in which None stands for any length; no copy where it is
    one."""
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "fiubO":
            raise TypeError(f"the dtype is {array.dtype}")
        array = np.require(array, dtype, ["C", "A"])
    except (TypeError, ValueError, OverflowError) as error:
        refuse(f"{what}: {error}: pass numbers")
    if array.ndim != len(shape) or any(wanted not in (None, got) for wanted, got in zip(shape, array.shape)):
        wanted = ", ".join("N" if length is None else str(length) for length in shape)
        refuse(f"{what} has the shape {array.shape}: pass ({wanted})")
    return array


def by_columns(poses):
    """Returns poses, (N, 4, 4) or (4, 4), row by row, as the library takes them: column by column."""
    return np.ascontiguousarray(poses.swapaxes(-1, -2))


def pose_of(pose, what="pose"):
    """Returns a pose column by column, and the identity for None."""
    return np.eye(4) if pose is None else by_columns(floats(pose, (4, 4), what))


def indices(values, what):
    """Returns an array of uint32, (N, 3), in C order and aligned. Numbers that no index can be are refused with their place."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        refuse(f"{what}: {error}: pass (N, 3), triangles")
    if array.size == 0:
        array = array.reshape(-1, 3).astype(np.uint32)
    if array.dtype.kind not in "iu":
        refuse(f"{what} has the dtype {array.dtype}: pass whole numbers")
    if array.ndim != 2 or array.shape[1] != 3:
        refuse(f"{what} has the shape {array.shape}: pass (N, 3), triangles")
    if array.dtype != np.uint32:
        wrong = (array < 0) | (array > 0xFFFFFFFF)
        if wrong.any():
            row = int(np.argmax(wrong.any(axis=1)))
            refuse(f"{what}[{row}] is {array[row].tolist()}: pass indices from 0 to 2**32 - 1")
    return np.require(array, np.uint32, ["C", "A"])


def count_of(value, what, most=2**64 - 1, least=0):
    """Returns a whole number from `least` to `most`."""
    try:
        number = operator.index(value)
    except TypeError:
        refuse(f"{what} is {value!r}: pass a whole number")
    if not least <= number <= most:
        refuse(f"{what} is {number}: pass a number from {least} to {most}")
    return number


def number_of(value, what):
    """Returns a float that is not NaN."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        refuse(f"{what} is {value!r}: pass a number")
    if math.isnan(number):
        refuse(f"{what} is NaN: pass a number")
    return number


def place_of(out, dtype, length=None):
    """Returns where an array for answers begins, checked: of the dtype, in C order, one-dimensional, writeable, of a length, and
    aligned as the library's structs are."""
    if not isinstance(out, np.ndarray) or (out.dtype is not dtype and out.dtype != dtype):
        refuse(f"out is {getattr(out, 'dtype', type(out).__name__)}: pass an array of the dtype {dtype}")
    if out.ndim != 1 or not out.flags.carray:
        refuse("out has to be one-dimensional, contiguous and writeable: make it by numpy.empty")
    if length is not None and len(out) != length:
        refuse(f"out has {len(out)} elements: pass {length}")
    place = address(out)
    if place % 8 != 0:
        refuse("out does not begin at a multiple of 8 bytes: make it by numpy.empty")
    return place


class Room:
    """Where the caller's arrays for answers are, in arguments for bare functions."""

    def __init__(self, dtype):
        self.place, self.length = ctypes.c_void_p(), ctypes.c_size_t()
        self._dtype = dtype
        self._id = self._length = 0
        self._seen, self._now = b"", None

    # Whatever changes in an array, or another one at its id, changes its fields or its length. So an array that has those of the
    # last call was checked there. None is kept alive for that.
    def take(self, out):
        """Notes an array that is good for answers; refuses any other."""
        if id(out) == self._id and type(out) is np.ndarray and self._now.raw == self._seen and len(out) == self._length:
            return
        self._id = 0
        self.place.value = place_of(out, self._dtype)
        self._length = self.length.value = len(out)
        if _CAN_READ and out.dtype is self._dtype:
            self._now = _fields(id(out) + _HEAD)
            self._seen = self._now.raw
            self._id = id(out)


def budget_of(tests, seconds):
    """Returns a Budget and a reference to it for the library, or (None, None) without limits."""
    if tests == 0 and seconds == 0:
        return None, None
    limit = number_of(seconds, "seconds")
    if limit < 0:
        refuse(f"seconds is {limit}: pass a number of at least 0")
    nanoseconds = 0 if limit == 0 or limit > 1e9 else max(1, int(limit * 1e9))
    budget = Budget(tests=count_of(tests, "tests"), nanoseconds=nanoseconds)
    return budget, ctypes.byref(budget)
