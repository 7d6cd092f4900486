"""A scene's haptic loop, a tick at a time."""

from ctypes import addressof

import numpy as np

from ._answers import ServoBody, ServoState, ServoTick
from ._arrays import address, by_columns, count_of, floats, number_of, place_of
from ._c import SERVO_CONTACT, ServoBody as ServoBodyInfo, ServoInfo, ServoOptions, ServoState as ServoStateInfo
from ._errors import check, error_of, refuse
from ._follow import Follower
from ._handle import Lone, Out
from ._library import LIBRARY
from ._mesh import path_bytes

UNITS = {"m": 1, "mm": 2}


def pose_by_rows(numbers):
    """A pose, (4, 4), of the library's 16 numbers."""
    return np.array(numbers).reshape(4, 4).T.copy()


def state_of(handle):
    """The last tick of a servo, or None."""
    state = ServoStateInfo()
    check(LIBRARY.ist_servo_get_state(handle, addressof(state)))
    if not state.known:
        return None
    return ServoState(
        state.tick,
        pose_by_rows(state.device),
        pose_by_rows(state.tool),
        np.array(state.force),
        np.array(state.torque),
        np.frombuffer(state, SERVO_CONTACT, state.contact_count, ServoStateInfo.contacts.offset),
        bool(state.device_known),
        bool(state.fault),
        bool(state.held),
        bool(state.halved),
        state.steps,
        state.begin_ns,
        state.execution_ns,
    )


class Servo(Lone):
    """A simulated scene: each tick takes the pose of the device and gives the force and the torque for the hand.

    For tests and figures: Python keeps no hard deadlines. A pose is (4, 4), row by row, and maps the tool's frame to the
    scene: p_scene = pose @ p_tool. Its translation is in `unit`. The tool's frame has the axes of the first held body's mesh
    and its origin in the middle of that body's grid (Tree.origin), and not at the mesh's origin: begin with `tool`, and move
    that. sphere_tests: the limit of each tick's query, for the same forces in every run; 0: the limit is query_time_fraction of
    a tick.
    """

    _free = LIBRARY.ist_servo_free

    _NO_POSE = "the pose is None: the device did not say where it is, which is a fault"

    def __init__(
        self, scene, *, unit="mm", query_time_fraction=0.7, sphere_tests=0, max_memory=4 << 30, progress=None
    ):
        if unit not in UNITS:
            refuse(f"unit is {unit!r}: pass 'm' or 'mm', the unit of the poses")
        options = ServoOptions(
            unit=UNITS[unit],
            query_time_fraction=number_of(query_time_fraction, "query_time_fraction"),
            sphere_tests=count_of(sphere_tests, "sphere_tests"),
            max_memory=count_of(max_memory, "max_memory", least=1),
        )
        path = path_bytes(scene, "scene")
        with Follower(progress) as follower:
            options.progress = follower.pointer
            out = Out()
            status = LIBRARY.ist_servo_open_scene(path, addressof(options), out.address)
            super().__init__(out.handle)  # which is freed with this object whatever finish() raises
            follower.finish(status)

    def tick(self, pose, *, out=None):
        """Computes one tick. p_scene = pose @ p_tool, its translation in `unit`.

        None for the pose: the device did not say where it is, which is a fault. Raises after a fault, and the next forces come
        back gradually. out: an array of float64, (2, 3), that is filled; force and torque are its rows.
        """
        handle = self._enter()
        try:
            at = None if pose is None else by_columns(floats(pose, (4, 4), "pose"))
            if out is None:
                out = np.empty((2, 3))
            elif not isinstance(out, np.ndarray) or out.shape != (2, 3) or not out.flags.carray:
                refuse("out has to be an array of float64, (2, 3), contiguous and writeable: make it by numpy.empty((2, 3))")
            force = place_of(out.reshape(-1), np.float64)
            status = LIBRARY.ist_servo_on_tick(handle, None if at is None else address(at), force, force + out.strides[0])
            if status:
                raise error_of(status, self._NO_POSE if pose is None else None)
            return ServoTick(out[0], out[1])
        finally:
            self._lock.release()

    def last(self):
        """The last tick, as a ServoState: poses, forces, contacts and times.

        Any thread may call it at any time, also while another thread is in tick(): neither waits for the other, and there is no
        BusyError. None before the first tick, and in the rare case that each attempt to read met a tick that was being written:
        ask again later.
        """
        return state_of(self._need())

    @property
    def contacts(self):
        """The contacts that push the tool after the last tick: SERVO_CONTACT, in `unit`. For the thread that makes the ticks."""
        handle = self._enter()
        try:
            state = state_of(handle)
        finally:
            self._lock.release()
        return np.empty(0, SERVO_CONTACT) if state is None else state.contacts

    def attach(self, body):
        """Takes a fixed body, by its name, into the hand, where it is. ChangeRefused while anything touches it or the hand."""
        self._change(LIBRARY.ist_servo_attach, body)

    def release(self, body):
        """Leaves a held body, by its name, where it is, as a fixed one."""
        self._change(LIBRARY.ist_servo_release, body)

    def _change(self, function, body):
        if not isinstance(body, str):
            refuse(f"body is {body!r}: pass the name of a body of the scene")
        handle = self._enter()
        try:
            check(function(handle, body.encode("utf-8", "replace")))
        finally:
            self._lock.release()

    @property
    def bodies(self):
        """The bodies of the scene: each with name, whether the hand holds it, and the pose, (4, 4), of its mesh."""
        count, found, handle = self._info().bodies, [], self._enter()
        try:
            for index in range(count):
                body = ServoBodyInfo()
                check(LIBRARY.ist_servo_get_body(handle, index, addressof(body)))
                found.append(ServoBody(body.name.decode("utf-8", "replace"), bool(body.held), pose_by_rows(body.pose)))
        finally:
            self._lock.release()
        return tuple(found)

    def _info(self):
        handle = self._enter()
        try:
            info = ServoInfo()
            check(LIBRARY.ist_servo_get_info(handle, addressof(info)))
            return info
        finally:
            self._lock.release()

    tick_seconds = property(lambda self: self._info().tick_seconds, doc="The nominal duration of a tick, s.")
    ticks = property(lambda self: self._info().ticks, doc="Ticks so far.")
    held = property(lambda self: self._info().held, doc="Ticks with too little time for all contacts.")
    faults = property(lambda self: self._info().faults, doc="Ticks with an error: the force was zero.")
    late = property(lambda self: self._info().late, doc="Ticks that took longer than tick_seconds.")

    @property
    def tool(self):
        """The pose of the tool, (4, 4): to begin with where the device should be, later what to draw."""
        return pose_by_rows(self._info().tool)

    @property
    def warnings(self):
        """The warnings of the scene's construction."""
        found, handle = [], self._enter()
        try:
            while (text := LIBRARY.ist_servo_warning(handle, len(found))) is not None:
                found.append(text.decode("utf-8", "replace"))
        finally:
            self._lock.release()
        return tuple(found)
