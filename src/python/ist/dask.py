"""Makes the parts of a sweep on the workers of dask.distributed. `import ist` alone needs no dask."""

import threading
import time

from distributed import as_completed

from ._errors import BusyError, refuse
from ._sweep import Sweep

_opening = threading.Lock()
_opened = {}  # of a worker's process: the last sweep that it made a part of, with its trees


def _sweep_of(path, folder, digits):
    with _opening:
        key = path, folder, digits
        if key not in _opened:
            _opened.clear()
            sweep = Sweep(path, folder)
            if sweep.hash != digits:
                refuse(f"{path} describes another sweep by now: {sweep.hash}, and not {digits}")
            _opened[key] = sweep
        return _opened[key]


def _make(path, folder, digits, part, threads):
    while True:
        try:
            return _sweep_of(path, folder, digits).run(part, threads=threads).outcome
        except BusyError:  # a worker that the scheduler took for lost, or a task of a run that was ended, is making it still
            time.sleep(0.5)


def run(sweep, client, threads=1, retries=3, progress=None):
    """Makes each part that is missing as a task of a dask.distributed.Client. Returns sweep.status().

    The workers have to see the sweep file, its trees and its folder by the same absolute names. A task names its part, and
    holds no trees: each process loads them once. There are never more tasks than twice the threads of all workers. threads:
    of each part. A worker that is killed loses its parts, and others make them; a part that was lost three times is given
    up, which the answer says. A part that somebody else is making is waited for. retries: how often a part is tried again
    after an exception, before that is raised here. progress: called after each part with the share that is done; what it
    raises ends the call, but not the parts that workers are making.
    """
    waiting = [(part, retries) for part in reversed(sweep.status().missing)]
    total, flying, landed = len(waiting), {}, as_completed(loop=client.loop)
    try:
        while waiting or flying:
            while waiting and len(flying) < 2 * max(1, sum(client.nthreads().values())):
                part, left = waiting.pop()
                task = client.submit(_make, sweep.path, sweep.folder, sweep.hash, part, threads, pure=False)
                flying[task] = part, left
                landed.add(task)
            task = next(landed)
            part, left = flying.pop(task)
            if task.status != "finished":
                if left < 1:
                    task.result()  # raises what the task raised
                waiting.insert(0, (part, left - 1))
            elif progress is not None:
                progress(1 - (len(waiting) + len(flying)) / total)
    finally:
        client.cancel(list(flying))
    return sweep.status()
