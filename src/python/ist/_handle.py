"""Objects of the library behind handles: freed once, and never used by two threads at once where they serve one."""

import ctypes
import functools
import threading

from ._errors import BUSY, FREED, error_of


class Handle:
    """Owns a handle. It is freed with the object, or before by free() or at the end of a `with`."""

    # Each object has its own: the library's function with the handle. Python drops an exception that comes up in the code of
    # `__del__`, Ctrl-C too; here no code of Python runs.
    __slots__ = ("__del__", "__dict__", "__weakref__")

    _free = None  # the function of the library that frees it

    def __init__(self, handle):
        self._handle = handle
        if handle is not None:
            self.__del__ = functools.partial(type(self)._free, handle)

    def _need(self):
        if self._handle is None:
            raise error_of(FREED, f"this {type(self).__name__} was freed: make another one")
        return self._handle

    def free(self):
        """Frees the object now. Later uses raise FreedError; a second call does nothing."""
        handle, self._handle = getattr(self, "_handle", None), None
        if handle is not None:
            free_now = self.__del__
            del self.__del__
            free_now()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.free()


class Lone(Handle):
    """A handle that serves one call at a time: another thread gets a BusyError."""

    def __init__(self, handle):
        super().__init__(handle)
        self._lock = threading.Lock()

    def _enter(self):
        """Returns the handle, for one call, which has to end with self._lock.release()."""
        if not self._lock.acquire(False):
            raise error_of(BUSY, f"this {type(self).__name__} is answering another call: make one for each thread")
        if self._handle is None:
            self._lock.release()
            self._need()
        return self._handle

    def __reduce__(self):
        raise TypeError(f"a {type(self).__name__} is neither copied nor pickled: make one for each thread and each process")

    def free(self):
        lock = getattr(self, "_lock", None)
        if lock is None:
            return
        if not lock.acquire(blocking=False):
            raise error_of(BUSY, f"this {type(self).__name__} is answering a call: free it afterwards")
        try:
            super().free()
        finally:
            lock.release()


class Out:
    """The place of a new handle."""

    def __init__(self):
        self.value = ctypes.c_void_p()
        self.address = ctypes.addressof(self.value)

    @property
    def handle(self):
        return self.value.value
