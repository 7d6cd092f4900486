"""Calls that may last: they hear Ctrl-C, and a caller's function follows them."""

import ctypes
import sys
import threading

from ._c import REPORT, Progress
from ._errors import check, refuse_type

_hooks = threading.Lock()


class Follower:
    """Follows one call of the library: `with Follower(progress) as follower:`, then `follower.finish(status)`.

    The caller's function is called on the caller's thread with the part that is done, 0 to 1, at least every 0.05 s. An
    exception that it raises, and KeyboardInterrupt, end the call; finish() raises them again.
    """

    def __init__(self, progress=None):
        if progress is not None and not callable(progress):
            refuse_type(f"progress has to be a function of the part that is done, and is {type(progress).__name__}")
        self._progress = progress
        self._raised = None
        self._target = self._report
        self.struct = Progress(report=REPORT(self._target))
        self.pointer = ctypes.pointer(self.struct)
        self.address = ctypes.addressof(self.struct)

    def _report(self, _user, part):
        try:
            if self._raised is None and self._progress is not None:
                self._progress(part)
        except BaseException as raised:  # of any kind: nothing can pass through the library
            self._raised = raised
        return 0 if self._raised is None else 1

    # Python handles a signal before the first line of a function, where no `try` of it catches the exception. From a
    # callback the exception then goes to this hook, and the next report ends the call.
    def _hear(self, unraisable):
        raised = unraisable.exc_value
        # From Python 3.13 on the callback is not named.
        ours = unraisable.object is self._target or (unraisable.object is None and isinstance(raised, KeyboardInterrupt))
        if ours and raised is not None:
            self._raised = raised
        else:
            self._hook_before(unraisable)

    def __enter__(self):
        self._hooked = threading.current_thread() is threading.main_thread() and _hooks.acquire(blocking=False)
        if self._hooked:
            self._hook_before, sys.unraisablehook = sys.unraisablehook, self._hear
        return self

    def __exit__(self, *_):
        if self._hooked:
            sys.unraisablehook = self._hook_before
            _hooks.release()

    def finish(self, status):
        """Raises what ended the call, or the error of its status."""
        if self._raised is not None:
            raised, self._raised = self._raised, None
            raise raised
        check(status)
