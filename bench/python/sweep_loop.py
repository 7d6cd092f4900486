"""Asks about poses of a sweep one by one, as a script without ist.Sweep does, and prints the seconds that it took: sweep_bench runs it.

    IST_LIBRARY=... PYTHONPATH=src/python bench/python/sweep_loop.py SWEEP.toml FIRST COUNT
"""
import pathlib
import sys
import time

import ist

TOLERANCE = 0.01


def main():
    job, first, count = pathlib.Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    poses = ist.Sweep(job).poses(first, count)
    query = ist.Query(ist.load(job.parent / "upper.ist"), ist.load(job.parent / "lower.ist"))
    begin = time.perf_counter()
    for pose in poses:
        query.forget()
        query.intersects(pose)
        query.forget()
        query.distance(pose, TOLERANCE)
    print(time.perf_counter() - begin)


if __name__ == "__main__":
    main()
