"""The library's structs about sweeps."""

import ctypes

from ctypes import c_double, c_int32, c_size_t, c_uint64

from ._records import Sized


class SweepInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("rows", c_uint64),
        ("rows_per_part", c_uint64),
        ("parts", c_uint64),
        ("row_bytes", c_uint64),
        ("columns", c_uint64),
        ("hash", ctypes.c_char * 40),
    ]


class ColumnInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", ctypes.c_char * 24),
        ("type", c_int32),
        ("reserved", c_int32),
        ("offset", c_uint64),
    ]


class PartInfo(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("state", c_int32),
        ("starts", c_int32),
        ("rows", c_uint64),
        ("seconds", c_double),
        ("made", c_int32),
        ("reserved", c_int32),
    ]


class MergeResult(Sized):
    _fields_ = [
        ("struct_size", c_size_t),
        ("rows", c_uint64),
        ("missing", c_uint64),
        ("given_up", c_uint64),
        ("reserved", c_uint64),
    ]
