"""Do two jaws touch, and how far apart are they? hello.cpp and hello.c print the same lines."""

import sys

import ist
import numpy as np

try:
    # ist.jaws() makes two built-in jaws. ist.build("scan.stl") reads a mesh of your own.
    upper_mesh, lower_mesh = ist.jaws(seed=1)

    # A tree is a mesh made ready for queries. Lengths are in the unit of the mesh, here mm.
    upper = ist.build(upper_mesh)
    lower = ist.build(lower_mesh)

    # A query belongs to one thread. Several queries may share a tree.
    query = ist.Query(upper, lower)

    for down in (1.0, 1.5):
        # The pose maps points of the lower jaw to the coordinates of the upper jaw.
        pose = np.eye(4)
        pose[2, 3] = -down

        # Touch is exact. The distance lies between two ends, which are at most 0.001 mm apart.
        touch = {True: "yes", False: "no", None: "unknown"}[query.intersects(pose)]
        gap = query.distance(pose, 0.001)
        print(f"lower jaw down by {down:.1f} mm: touch {touch}, {gap.lower:.3f} to {gap.upper:.3f} mm apart")
except ist.Error as error:
    # The text names the place, the cause and the remedy.
    sys.exit(str(error))
