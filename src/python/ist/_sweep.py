"""Sweeps: the same questions about two bodies at up to 10^12 poses, in parts that any process may make."""

import math
import os
import pathlib

from ctypes import addressof

import numpy as np

from ._answers import SweepPart, SweepStatus, SweepTable
from ._arrays import address, by_columns, count_of
from ._c import IST_PART_DAMAGED as DAMAGED, IST_PART_DONE as DONE, IST_PART_GIVEN_UP as GIVEN_UP, IST_PART_MISSING as MISSING
from ._c import SweepColumn, SweepInfo, SweepMergeResult, SweepPart as PartInfo
from ._errors import check
from ._follow import Follower
from ._handle import Handle, Out
from ._library import LIBRARY
from ._mesh import path_bytes

COLUMN_TYPES = (None, "<u8", "<i4", "<f8")  # by the library's numbers


def absolute(path):
    return pathlib.Path(os.path.abspath(os.fsdecode(path)))


def begun(folder):
    """Whether a sweep, of whatever trees and poses, has begun in a folder."""
    return os.path.lexists(os.path.join(folder, b"sweep.json"))


class Sweep(Handle):
    """A sweep, by its file: two bodies, poses, and the questions at each (docs/sweeps.md). Any number of threads may share it.

    The parts may be made by any process on any machine, in any order; their rows are the same bytes. folder: where they are;
    by default the file's name with the ending .sweep. A pickled sweep is the absolute names of its file and its folder, and
    whoever unpickles it reads the file anew. progress: called while the bodies' files are read for their hashes. Raises
    InputError, which names the line, and FileError.

    >>> import ist, numpy, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as place:
    ...     for name, jaw in zip(["upper", "lower"], ist.jaws()):
    ...         ist.build(jaw).save(f"{place}/{name}.ist")  # a mesh file will do as well
    ...     job = pathlib.Path(place, "job.toml")
    ...     _ = job.write_text('''
    ... answers = ["intersects"]
    ... rows_per_part = 3
    ... fixed = "upper.ist"
    ... moving = "lower.ist"
    ... [[poses.axes]]
    ... name = "height"
    ... move = [0, 0, 1]
    ... from = -4
    ... to = 0
    ... count = 5
    ... ''')
    ...     sweep = ist.Sweep(job)
    ...     for part in sweep.parts:
    ...         print(part, sweep.run(part).outcome)
    ...     print(sweep.merge().rows, "rows")
    ...     table = numpy.load(sweep.folder / "rows.npy")
    0 made
    1 made
    5 rows
    >>> table["height"][table["intersects"] == ist.YES].tolist(), table["z"].tolist()
    ([-1.0, 0.0], [-4.0, -3.0, -2.0, -1.0, 0.0])
    """

    _free = LIBRARY.ist_sweep_free

    def __init__(self, path, folder=None, *, progress=None):
        self._path = absolute(path)
        self._folder = self._path.with_suffix(".sweep") if folder is None else absolute(folder)
        name = path_bytes(self._path, "path")
        path_bytes(self._folder, "folder")
        with Follower(progress) as follower:
            out = Out()
            status = LIBRARY.ist_sweep_open(name, follower.address, out.address)
            super().__init__(out.handle)  # which is freed with this object whatever finish() raises
            follower.finish(status)
        self._info = SweepInfo()
        check(LIBRARY.ist_sweep_get_info(self._need(), addressof(self._info)))
        self._columns = self._read_columns()

    path = property(lambda self: self._path, doc="The sweep file, absolute.")
    folder = property(lambda self: self._folder, doc="The folder of the parts and of the table, absolute.")
    rows = property(lambda self: self._info.rows, doc="The number of poses, which is that of the rows.")
    rows_per_part = property(lambda self: self._info.rows_per_part, doc="Rows of each part; the last one may have fewer.")
    parts = property(lambda self: range(self._info.parts), doc="The numbers of the parts, a range.")
    hash = property(lambda self: self._info.hash.decode(), doc="32 hexadecimal digits, which name the rows of the sweep.")
    columns = property(lambda self: self._columns, doc="The dtype of a row, packed; numpy.load gives it for each file of rows.")

    def poses(self, first, count):
        """Computes `count` poses from number `first` on: (count, 4, 4), p_fixed = pose @ p_moving. Cost: below 1 us a pose."""
        first = count_of(first, "first", self.rows)
        found = np.empty((count_of(count, "count", self.rows - first), 4, 4))
        check(LIBRARY.ist_sweep_get_poses(self._need(), first, len(found), address(found)))
        return by_columns(found)

    def run(self, part, folder=None, *, threads=0, progress=None):
        """Makes a part, from 0, unless it is there or was given up.

        threads: the most of the whole process meanwhile; 0: one for each core. progress: called with the share of the part that
        is done; what it raises ends the call, and nothing half-made is left. Raises BusyError for a part
        that somebody is making now, and InputError for the folder of another sweep, a damaged part, and a body that changed since.
        """
        number, most = count_of(part, "part"), count_of(threads, "threads", 1024)
        place, result = self._place(folder), PartInfo()
        with Follower(progress) as follower:
            status = LIBRARY.ist_sweep_run_part(
                self._need(), place, number, most, follower.address, addressof(result)
            )
            follower.finish(status)
        outcome = "made" if result.made else "given up" if result.state == GIVEN_UP else "there"
        return SweepPart(number, outcome, result.rows, result.seconds)

    def merge(self, folder=None, *, progress=None):
        """Merges the parts into rows.npy of the folder, the table of all rows, and writes all checksums to manifest.json.

        If a part is missing or given up, nothing is written, and the answer names such parts. progress: called with the
        share that is done; if it raises an exception, the call ends with it. If the table is there and has its checksum, the
        call only says so. Raises InputError if a part is damaged, and BusyError if another process is merging. Cost: the time
        to read and write all rows.
        """
        place, result = self._place(folder), SweepMergeResult()
        while True:
            with Follower(progress) as follower:
                if self.parts and not begun(place):
                    return SweepTable(0, self.status(folder).missing, [])
                follower.finish(LIBRARY.ist_sweep_merge(self._need(), place, follower.address, addressof(result)))
            if result.missing == 0 and result.given_up == 0:
                return SweepTable(result.rows, [], [])
            found = self._by_state(place, False, None)
            if found[MISSING] or found[GIVEN_UP]:  # else somebody has made the last ones meanwhile
                return SweepTable(0, *([part for part, _ in found[state]] for state in (MISSING, GIVEN_UP)))

    def status(self, folder=None, *, verify=False, progress=None):
        """Looks which parts are done, missing, given up and damaged.

        verify: reads each part's file and compares its checksum. progress: called before each part. A folder in which nobody
        has begun yet lacks all parts. Raises InputError for the folder of another sweep. Cost: 50 us a part, without `verify`.
        """
        found = self._by_state(self._place(folder), verify, progress)
        seconds = math.fsum(took for _, took in found[DONE] if not math.isnan(took))
        return SweepStatus(*([part for part, _ in found[state]] for state in (DONE, MISSING, GIVEN_UP, DAMAGED)), seconds)

    def _place(self, folder):
        return path_bytes(self._folder if folder is None else absolute(folder), "folder")

    def _look(self, place, part, verify):
        found = PartInfo()
        check(LIBRARY.ist_sweep_get_part(self._need(), place, part, int(bool(verify)), addressof(found)))
        return found

    def _by_state(self, place, verify, progress):
        """Returns for each state the parts in it, with the seconds that each took."""
        found = {MISSING: [], DONE: [], GIVEN_UP: [], DAMAGED: []}
        self._need()
        if not begun(place):
            found[MISSING] = [(part, math.nan) for part in self.parts]
            return found
        for part in self.parts:
            if progress is not None:
                progress(part / len(self.parts))
            how = self._look(place, part, verify)
            found[how.state].append((part, how.seconds))
        return found

    def _read_columns(self):
        names, formats, offsets = [], [], []
        for column in range(self._info.columns):
            info = SweepColumn()
            check(LIBRARY.ist_sweep_get_column(self._need(), column, addressof(info)))
            names.append(info.name.decode())
            formats.append(COLUMN_TYPES[info.type])
            offsets.append(info.offset)
        return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": self._info.row_bytes})

    def __reduce__(self):
        return Sweep, (self._path, self._folder)

    def __repr__(self):
        if self._handle is None:
            return "<ist.Sweep, freed>"
        return f"<ist.Sweep of {self.rows} rows in {len(self.parts)} parts, {self._path.name}>"
