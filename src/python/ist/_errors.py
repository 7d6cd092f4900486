"""The library's errors as Python's."""

import difflib
import re
import sys

from . import _c
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


NOT_PREPARED, POSE_INVALID = _c.IST_NOT_PREPARED, _c.IST_POSE_INVALID
TRIANGLES_MISSING, VOXELS_MISSING = _c.IST_TRIANGLES_MISSING, _c.IST_VOXELS_MISSING
FREED, BUSY = _c.IST_HANDLE_FREED, _c.IST_HANDLE_BUSY
KINDS = {
    _c.IST_NOT_A_HANDLE: FreedError,
    FREED: FreedError,
    BUSY: BusyError,
    _c.IST_TOO_MANY_HANDLES: Error,
    _c.IST_OUT_OF_MEMORY: MemoryLimitError,
    _c.IST_SYSTEM_ERROR: Error,
    _c.IST_INTERNAL_ERROR: Error,
    _c.IST_SERVO_FAULT: Error,
    _c.IST_CANCELLED: Error,
    _c.IST_CHANGE_REFUSED: ChangeRefused,
    _c.IST_FILE_UNREADABLE: FileError,
    _c.IST_FILE_UNWRITABLE: FileError,
    _c.IST_MEMORY_LIMIT: MemoryLimitError,
    _c.IST_PART_BUSY: BusyError,
}


_FUNCTION = re.compile(r"\bist_(query|servo|sweep|tree|world)_(\w+)")
_QUESTION = re.compile(r"\bIST_ASK_([A-Z_]+)")


def _asked():
    """Returns the name of the function or the class of this package that was called, such as World.ask or ist.build."""
    frame = sys._getframe()
    while frame.f_back is not None and frame.f_back.f_globals.get("__package__") == __package__:
        frame = frame.f_back
    function, owner = frame.f_code.co_name, frame.f_locals.get("self")
    if owner is None:
        return f"ist.{function}"
    kind = type(owner).__name__
    return f"ist.{kind}" if function == "__init__" else f"{kind}.{function}"


def in_python(text):
    """Returns a message of the library with Python's names. It begins with the function that was called."""
    _, _, text = text.partition(": ")  # after the name of C's function
    text = text.replace("options->", "").replace("question->", "")  # their members are arguments here
    text = _FUNCTION.sub(lambda found: f"{found[1].title()}.{found[2]}", text)
    return f"{_asked()}: " + _QUESTION.sub(lambda found: f'"{found[1].lower()}"', text)


def error_of(status, text=None):
    """Returns the exception of a status, with the library's last message unless a text is given. It begins with the function
    that was called."""
    if text is None:
        text = in_python(LIBRARY.ist_last_error_message().decode("utf-8", "replace"))
    else:
        text = f"{_asked()}: {text}"
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
    raise error_of(_c.IST_ARGUMENT_INVALID, text)


def refuse_type(text):
    """Raises a TypeError."""
    raise TypeError(f"{_asked()}: {text}")


def need_word(word, known, what):
    """Raises an InputError for a word that is not known. The text has the word that is spelled most like it, and all words."""
    if word in known:
        return
    nearest = difflib.get_close_matches(word, known, 1) if isinstance(word, str) else []
    guess = f"did you mean {nearest[0]!r}? " if nearest else ""
    refuse(f"{what} is {word!r}: {guess}pass one of {', '.join(known)}")
