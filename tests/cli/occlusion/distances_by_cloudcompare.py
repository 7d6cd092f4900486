#!/usr/bin/env python3
"""Holds |Signed| of every vertex that `ist occlusion` maps against CloudCompare's distance of that point from the mesh.

    distances_by_cloudcompare.py built-in|human IST FOLDER

    IST     the ist command
    FOLDER  for what is made on the way; is emptied first

Signs are not compared: CloudCompare takes them from the normal of one nearest triangle, which may be any at an edge. Runs without a display, as
scripts/test.sh --long does. Where CloudCompare, VTK or the human jaws are missing the exit code is 77; with
IST_REQUIRE_ALL=1 it is 1.
"""
import os
import shutil
import subprocess
import sys

from oracles import Command, holds, human_jaws, np, skip

MICROMETRE = 1e-3


def by_cloudcompare(folder, points, mesh):
    """Returns the distance of each point from the mesh of an STL."""
    cloud, out = folder / "cloud.asc", folder / "distances.asc"
    np.savetxt(cloud, points, fmt="%.9g")
    out.unlink(missing_ok=True)
    log = subprocess.run(
        ["CloudCompare", "-SILENT", "-AUTO_SAVE", "OFF", "-C_EXPORT_FMT", "ASC", "-PREC", "9", "-O", cloud, "-O", mesh,
         "-C2M_DIST", "-SAVE_CLOUDS", "FILE", out],
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "HOME": str(folder)}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert log.returncode == 0 and out.is_file(), log.stdout
    table = np.loadtxt(out)
    holds("CloudCompare: points that it changed by more than their float's rounding",
          (np.abs(table[:, :3] - points) > 1e-6 * np.abs(points).max()).any(1).sum(), 0)
    return np.abs(table[:, 3])


def main(pair, ist, folder):
    if not shutil.which("CloudCompare"):
        skip("no CloudCompare; scripts/setup.sh --cloudcompare installs it")
    command = Command(ist, folder)
    files = command.built_in_jaws() if pair == "built-in" else human_jaws()
    bodies, _ = command.map(*files)
    for name, body, other in zip(("fixed", "moving"), bodies, reversed(files)):
        points, own = body.points[body.near], np.abs(body.signed[body.near])
        assert len(points) > 1000, name
        differ = np.abs(own - by_cloudcompare(command.folder, points, other))
        holds(f"{pair} jaws, {name}, {len(points)} vertices: |Signed| and CloudCompare's distance differ by", differ.max(), MICROMETRE)


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("built-in", "human"):
        sys.exit(__doc__)
    main(*sys.argv[1:])
