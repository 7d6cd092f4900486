#!/usr/bin/env python3
"""Holds every vertex that `ist occlusion` maps against VTK's distance and side, and its nearest triangle against numpy.

    distances_by_vtk.py built-in|human IST FOLDER

    IST     the ist command
    FOLDER  for what is made on the way; is emptied first

Jaws as stored, and once moved and turned. Where a tool or the human jaws are missing, the exit code is 77; with
IST_REQUIRE_ALL=1 it is 1.
"""
import sys

from oracles import Command, Surface, distance_from, holds, human_jaws, np, read_stl, winding_number

REACH = 2
MICROMETRE = 1e-3
# A point whose side VTK tells otherwise lies on the surface, but for rounding.
ON_SURFACE = 1e-9
SHIFT, DEGREES = (0.3, -0.2, -0.4), 0.7


def turn_about_z(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def same_surface(name, body, file):
    """The .vtp holds the facets of the STL, in its order, and turned round or all over at most."""
    wanted = read_stl(file)
    assert len(body.corners) == len(wanted), name
    turns = [wanted[:, order] for order in ([0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2])]
    same = np.any([(body.corners == turn).all((1, 2)) for turn in turns], axis=0)
    holds(f"{name}: facets that the file does not hold", (~same).sum(), 0)


def compare_sides(name, body, other, surface, exact):
    points, signed = body.points[body.near], body.signed[body.near]
    by_normal, by_rays = surface.signed(points) < 0, surface.encloses(points)
    differ = ((by_normal != (signed < 0)) | (by_rays != (signed < 0))) & (exact[body.near] > ON_SURFACE)
    wrong = sum((winding_number(points[i], other.corners) > 0.5) != (signed[i] < 0) for i in np.flatnonzero(differ))
    print(f"{name}: {(signed < 0).sum()} inside, {(signed >= 0).sum()} outside; "
          f"{differ.sum()} on another side by vtkImplicitPolyDataDistance or vtkSelectEnclosedPoints")
    holds(f"{name}: sides that the winding number refutes", wrong, 0)
    assert (signed < 0).any() and (signed > 0).any(), name


def compare(name, body, other, relative):
    surface = Surface(other.points, other.triangles)
    exact, _ = surface.nearest(body.points, REACH + 1)
    near = body.near
    print(f"{name}: {near.sum()} of {len(near)} vertices are within the reach")
    assert near.sum() > 1000, name
    signed = body.signed[near].astype("f8")
    by_vtk, own = exact[near], np.abs(signed)
    holds(f"{name}: |Signed| and VTK's distance differ by", np.abs(own - by_vtk).max(), MICROMETRE)
    if relative:
        holds(f"{name}: parts of the float's rounding between them",
              (np.abs(own - by_vtk) / (1e-6 * by_vtk + ON_SURFACE)).max(), 1)
    named = distance_from(body.points[near], other.corners[body.triangle[near]])
    holds(f"{name}: the named triangle is farther than VTK's distance by", np.abs(named - by_vtk).max(), MICROMETRE)
    holds(f"{name}: the largest |Signed|", own.max(), np.float32(REACH))
    missed = np.maximum(REACH - exact[~near], 0).max(initial=0)
    holds(f"{name}: a vertex without a distance is nearer than the reach by", missed, MICROMETRE)
    assert (body.triangle[~near] == -1).all() and (body.triangle[near] >= 0).all(), name
    assert (body.sign_known[~near] == 0).all() and (body.sign_known[near] == 1).all(), name
    compare_sides(name, body, other, surface, exact)


def main(pair, ist, folder):
    command = Command(ist, folder)
    files = command.built_in_jaws() if pair == "built-in" else human_jaws()
    for place, options in (("as stored", []), ("moved", ["--move", ",".join(map(str, SHIFT)), "--turn", f"z,{DEGREES}"])):
        bodies, _ = command.map(*files, *options)
        fixed, moving = bodies
        if not options:
            for name, body, file in zip(("fixed", "moving"), bodies, files):
                same_surface(f"{pair} {name}", body, file)
            stored = moving.points
        else:
            wrong = np.linalg.norm(moving.points - (stored @ turn_about_z(DEGREES).T + SHIFT), axis=1).max()
            holds(f"{pair} jaws {place}: the moving body's points are off by", wrong, MICROMETRE)
        compare(f"{pair} jaws {place}, fixed", fixed, moving, not options)
        compare(f"{pair} jaws {place}, moving", moving, fixed, not options)


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("built-in", "human"):
        sys.exit(__doc__)
    main(*sys.argv[1:])
