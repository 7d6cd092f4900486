"""What the tests of engines share: a sweep whose parts take a while, its table by one process, and a kill in the middle of a part."""

import hashlib
import os
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def skip(reason):
    """Ends a test program as skipped; as failed with IST_REQUIRE_ALL=1."""
    print(f"skipped: {reason}", file=sys.stderr)
    sys.exit(1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77)


try:
    import numpy as np  # noqa: F401  which ist needs
except ImportError as missing:
    skip(f"{missing}; scripts/setup.sh --sweep installs it, for /usr/bin/python3")

import ist  # noqa: E402  after numpy, which may be missing

# Rigid motions about the closed bite. A part of 1000 takes half a second.
JOB = """answers = ["intersects", "distance"]
tolerance = 0.002
rows_per_part = {rows_per_part}
[fixed]
tree = "upper.ist"
[moving]
tree = "lower.ist"
[poses.box]
seed = 7
count = {count}
from = {low}
to = {high}
turns_within = [3, 3, 3]
"""


def make_job(test, count, rows_per_part, low=(-1, -1, -3), high=(1, 1, 0)):
    """A sweep: job.toml beside its trees, and the folder `out`; all are removed when the test ends."""
    made = tempfile.TemporaryDirectory()
    test.addCleanup(made.cleanup)
    folder = pathlib.Path(made.name)
    for name, jaw in zip(("upper", "lower"), ist.jaws()):
        ist.build(jaw, voxel_size=0.8).save(folder / f"{name}.ist")
    job = folder / "job.toml"
    job.write_text(JOB.format(count=count, rows_per_part=rows_per_part, low=list(low), high=list(high)))
    return ist.Sweep(job, folder / "out")


def command(*arguments):
    """Runs `ist` and returns what it prints. A failure is an exception with what it said."""
    ran = subprocess.run([os.environ["IST_COMMAND"], *map(str, arguments)], capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        raise AssertionError(f"ist {arguments} ended with {ran.returncode}: {ran.stdout}{ran.stderr}")
    return ran.stdout


def path_with_command():
    """The environment in which a script finds `ist`."""
    return dict(os.environ, PATH=f"{pathlib.Path(os.environ['IST_COMMAND']).parent}:{os.environ['PATH']}")


def sha256(folder):
    return hashlib.sha256((pathlib.Path(folder) / "rows.npy").read_bytes()).hexdigest()


def sha256_by_one_process(sweep):
    """The SHA-256 of the table that this process makes alone, elsewhere."""
    folder = sweep.path.with_name("alone")
    for part in sweep.parts:
        sweep.run(part, folder)
    assert sweep.merge(folder).rows == sweep.rows
    return sha256(folder)


def part_that(process, folder):
    """The part of a folder that a process is making: it holds the part's mark open. None: no part."""
    try:
        links = [os.readlink(f"/proc/{process}/fd/{each}") for each in os.listdir(f"/proc/{process}/fd")]
    except OSError:  # it ended, or belongs to somebody else
        return None
    found = [re.fullmatch(re.escape(str(folder)) + r"/part-(\d+)\.start-\d", link) for link in links]
    return next((int(each[1]) for each in found if each), None)


def has_states(process, states):
    """Whether each thread of a process has one of these states, letters of Linux. T: it stands still. Z: it ended."""
    try:
        threads = list(pathlib.Path(f"/proc/{process}/task").iterdir())
        return all((thread / "stat").read_text().rpartition(")")[2].split()[0] in states for thread in threads)
    except OSError:  # the process or a thread is gone
        return not pathlib.Path(f"/proc/{process}").exists()


STOPS_IN_A_PART = """import os, pickle, signal, sys
sweep, signals = pickle.load(sys.stdin.buffer), [signal.SIGSTOP]
def progress(done):
    if done and signals:
        os.kill(os.getpid(), signals.pop())
print(sweep.run(int(sys.argv[1]), threads=1, progress=progress).outcome)
"""


def stopped_in_part(sweep, part):
    """Starts a process that makes a part, and stops itself in the middle of it. Returns the process; its stdout is a pipe."""
    while True:
        process = subprocess.Popen([sys.executable, "-B", "-c", STOPS_IN_A_PART, str(part)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        process.stdin.write(pickle.dumps(sweep))
        process.stdin.close()
        os.waitpid(process.pid, os.WUNTRACED)
        if part_that(process.pid, sweep.folder) == part and not (sweep.folder / f"part-{part:06}.npy").exists():
            return process
        process.kill()  # it stopped when the part was made
        process.wait()
        process.stdout.close()
        for file in sweep.folder.glob(f"part-{part:06}.*"):
            file.unlink()


def kill_in_the_middle_of_a_part(folder):
    """Waits until a process makes a part of the folder, and kills it. Returns the process and the part, which is not there.

    Raises AssertionError if no process could be killed so within eight minutes, so that a test without such a process ends.
    """
    end = time.monotonic() + 480
    while time.monotonic() < end:
        for process in (int(each) for each in os.listdir("/proc") if each.isdigit() and int(each) != os.getpid()):
            if part_that(process, folder) is None:
                continue
            os.kill(process, signal.SIGSTOP)
            while not has_states(process, "TZX"):
                time.sleep(0.001)
            part = part_that(process, folder)
            if part is None or (folder / f"part-{part:06}.npy").exists():  # it came to an end meanwhile
                os.kill(process, signal.SIGCONT)
                continue
            os.kill(process, signal.SIGKILL)
            while not has_states(process, "ZX"):
                time.sleep(0.005)
            return process, part
        time.sleep(0.01)
    raise AssertionError(f"no process could be killed in the middle of a part of {folder}")
