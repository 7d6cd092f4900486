"""The library's errors as Python's."""

from ._library import LIBRARY


class Error(Exception):
    """An error of the library: the text names cause and remedy, `code` and `name` are those of ist_status.h."""

    code = 0
    name = ""


class InputError(Error, ValueError):
    """An argument, a mesh, a tree or a scene that makes no sense."""


class FileError(Error, OSError):
    """A file that cannot be read or written."""


class MemoryLimitError(Error, MemoryError):
    """More memory than is allowed, or than there is."""


class BusyError(Error, RuntimeError):
    """Another thread is using the query, the servo or the world, or another process is making the part of the sweep."""


class ChangeRefused(Error, RuntimeError):
    """The hand may not take or release the body now."""


class FreedError(Error, RuntimeError):
    """The object was freed."""


NOT_PREPARED, TRIANGLES_MISSING, POSE_INVALID = 12, 118, 120
FREED, BUSY, OUT_OF_MEMORY, CANCELLED, FILE_UNREADABLE, FILE_UNWRITABLE, MEMORY_LIMIT = 6, 7, 9, 14, 101, 102, 112
KINDS = {
    4: FreedError,
    FREED: FreedError,
    BUSY: BusyError,
    8: Error,
    OUT_OF_MEMORY: MemoryLimitError,
    10: Error,
    11: Error,
    13: Error,
    CANCELLED: Error,
    15: ChangeRefused,
    FILE_UNREADABLE: FileError,
    FILE_UNWRITABLE: FileError,
    MEMORY_LIMIT: MemoryLimitError,
    124: BusyError,
}


def error_of(status, text=None):
    """Returns the exception of a status, with the library's last message unless a text is given."""
    if text is None:
        # A member of C's options is an argument here.
        text = LIBRARY.ist_last_error_message().decode("utf-8", "replace").replace("options->", "")
    error = KINDS.get(status, InputError)(text)
    error.code = status
    error.name = LIBRARY.ist_status_name(status).decode()
    return error


def check(status):
    """Raises the exception of a status other than 0."""
    if status:
        raise error_of(status)


def refuse(text):
    """Raises an InputError of this package's own: the argument never reached the library."""
    raise error_of(3, text)
