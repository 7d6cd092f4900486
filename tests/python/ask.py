"""Builds the two built-in jaws and asks every question of them, by whichever package `import ist` finds. Prints the file of the
library that is loaded, then each answer with all its bits, so that two packages can be compared. The argument is the file that
must be loaded: another one would make the comparison of a package with itself."""

import hashlib
import pathlib
import sys

import numpy as np

import ist


def bits(value):
    """All of a value: floats by their digits in hexadecimal, arrays by a hash of their bytes."""
    if isinstance(value, np.ndarray):
        return f"{value.shape} {hashlib.sha256(value.tobytes()).hexdigest()[:16]}"
    if isinstance(value, (float, np.floating)):
        return float(value).hex()
    if isinstance(value, tuple):
        return f"({', '.join(bits(part) for part in value)})"
    return repr(value)


def pose_of(z):
    """A turn by 0.02 about x, and a way along all axes."""
    pose = np.eye(4)
    c, s = np.cos(0.02), np.sin(0.02)
    pose[1:3, 1:3] = [[c, -s], [s, c]]
    pose[:3, 3] = [0.3, 0.2, z]
    return pose


def main(expected):
    expected = pathlib.Path(expected).resolve()
    loaded = {line.split()[-1] for line in open("/proc/self/maps", encoding="utf-8") if "libist_loop.so" in line}
    if loaded != {str(expected)}:
        sys.exit(f"ask: {ist.__file__} has loaded {loaded}, and not {expected}")
    fixed, moving = (ist.build(jaw, voxel_size=0.8) for jaw in ist.jaws())
    print("tree", bits(np.frombuffer(fixed.to_bytes(), np.uint8)), bits(fixed.leaf_centres))
    query = ist.Query(fixed, moving)
    for z in (-3.0, -1.0, 0.5):
        pose = pose_of(z)
        print(z, "intersects", query.intersects(pose))
        for verb in ("leaf_pairs", "contacts", "triangle_pairs"):
            print(z, verb, bits(tuple(getattr(query, verb)(pose))))
        print(z, "distance", bits(tuple(query.distance(pose, 0.001))))
        print(z, "near pairs", bits(tuple(query.near_pairs(pose, 0.1))))
        print(z, "penetration", bits(tuple(query.penetration(pose, 0.01))))
    print("first contact", bits(tuple(query.first_contact(pose_of(-3.0), pose_of(0.5), 0.01))))
    print("rows", bits(query.rows(np.stack([pose_of(z) for z in np.linspace(-3, 0.5, 12)]))))
    print("map", bits(ist.distance_map(moving, fixed, pose_of(-1.0), reach=2.0)))
    bite = query.occlusion(pose_of(0.0))
    print("occlusion", bits(bite.limits), bits(tuple(bite.fixed)), bits(tuple(bite.moving)))


main(*sys.argv[1:])
