#!/usr/bin/env python3
"""Holds `ist occlusion` of a jaw that is cut open, as a scan is, against the same with the jaw closed.

    open_shells.py IST FOLDER

    IST     the ist command
    FOLDER  for what is made on the way; is emptied first

Each of the built-in jaws is cut at the gum, and through the crowns, where many vertices are nearest to the border.
"""
import json
import sys

from oracles import Command, Surface, holds, np, on_triangle, read_stl, write_stl

REACH = 2
MICROMETRE = 1e-3
# Weights of corners that are as small may be 0 in another rounding.
SMALL_WEIGHT = 1e-9
# Heights, by what the border meets: the upper jaw is kept below, the lower one above.
CUTS = {"upper": {"gum": 53.0, "crowns": 48.5}, "lower": {"gum": 43.0, "crowns": 47.5}}


def cut(corners, jaw, height):
    middle = corners[:, :, 2].astype("f8").mean(1)
    return corners[middle < height if jaw == "upper" else middle > height]


def border_of(triangles):
    """Returns the edges that one triangle has, as low and high vertex."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    found, times = np.unique(edges, axis=0, return_counts=True)
    return found[times == 1]


def nearest_on_border(points, shell, named):
    """Returns whether each point's nearest feature of its named triangle is of the border, and whether rounding decides."""
    border = border_of(shell.triangles)
    code = len(shell.points)
    border_edges = border[:, 0] * code + border[:, 1]
    on_border = np.zeros(code, bool)
    on_border[border] = True
    weights = on_triangle(points, shell.corners[named])
    corners = shell.triangles[named]
    used = weights > 0
    at_corner = used.sum(1) == 1
    out = np.zeros(len(points), bool)
    out[at_corner] = on_border[corners[at_corner, weights[at_corner].argmax(1)]]
    at_edge = used.sum(1) == 2
    ends = np.sort(corners[at_edge][used[at_edge]].reshape(-1, 2), axis=1)
    out[at_edge] = np.isin(ends[:, 0] * code + ends[:, 1], border_edges)
    return out, (used & (weights < SMALL_WEIGHT)).any(1)


def side_of_face(points, shell, named):
    a, b, c = shell.corners[named].transpose(1, 0, 2)
    return ((points - a) * np.cross(b - a, c - a)).sum(1) < 0


def against_shell(name, body, whole, shell, closed):
    """`body` maps its distances from `shell`; `whole` is the same body where the other one, `closed`, is not cut."""
    by_shell, _ = Surface(shell.points, shell.triangles).nearest(body.points, REACH + 1)
    by_closed, _ = Surface(closed.points, closed.triangles).nearest(body.points, REACH + 1)
    near = body.near
    holds(f"{name}: |Signed| and VTK's distance differ by",
          np.abs(np.abs(body.signed[near]) - by_shell[near]).max(), MICROMETRE)
    missed = np.maximum(REACH - by_shell[~near], 0).max(initial=0)
    holds(f"{name}: a vertex without a distance is nearer than the reach by", missed, MICROMETRE)

    known, named = body.sign_known[near] == 1, body.triangle[near]
    border, rounded = nearest_on_border(body.points[near], shell, named)
    print(f"{name}: of {near.sum()} vertices within the reach, {border.sum()} are nearest to the border, "
          f"{rounded.sum()} to an edge by rounding")
    holds(f"{name}: vertices whose SignKnown is not that of the nearest feature", ((known == border) & ~rounded).sum(), 0)
    holds(f"{name}: vertices decided by rounding", rounded.sum(), 0.01 * near.sum())
    holds(f"{name}: negative ones without a sign", (body.signed[near][~known] < 0).sum(), 0)
    inner = known & (on_triangle(body.points[near], shell.corners[named]) > SMALL_WEIGHT).all(1)
    points, signed = body.points[near][inner], body.signed[near][inner]
    behind = side_of_face(points, shell, named[inner])
    holds(f"{name}: signs other than the side of the nearest face, of {inner.sum()}",
          ((signed < 0) != behind)[np.abs(signed) > SMALL_WEIGHT].sum(), 0)

    there = near & (by_shell <= by_closed + 1e-12)  # never nearer: it is a part of the closed one
    assert there.sum() > 1000, name
    holds(f"{name}: |Signed| differs from the closed jaw's, where the nearest point is still there ({there.sum()}), by",
          np.abs(np.abs(body.signed[there]) - np.abs(whole.signed[there])).max(), 0)
    same = there & (body.sign_known == 1)
    holds(f"{name}: signs that differ from the closed jaw's there ({same.sum()} known)",
          ((body.signed[same] < 0) != (whole.signed[same] < 0)).sum(), 0)
    return border.sum()


def of_shell(name, shell, closed):
    """The shell's own vertices are as far from the other jaw as when they were part of the closed one."""
    place = {tuple(point): i for i, point in enumerate(closed.points)}
    before = np.array([place[tuple(point)] for point in shell.points])
    assert shell.near.sum() > 1000, name
    assert (shell.near == closed.near[before]).all() and (shell.sign_known == shell.near).all(), name
    near = shell.near
    holds(f"{name}: Signed of the shell's own {near.sum()} vertices changes by",
          np.abs(shell.signed[near] - closed.signed[before][near]).max(), 0)


def what_is_said(name, command, files, lines, bodies):
    """No certain depth is told; the deepest vertex of both is."""
    measures = command.measures(*files)
    deepest = max(-body.signed[body.near & (body.sign_known == 1)].astype("f8").min() for body in bodies)
    holds(f"{name}: depth_at_vertices and the map's deepest vertex differ by",
          abs(measures["depth_at_vertices"] - deepest), MICROMETRE)
    said = f"at least {round(deepest, 3):.4g} mm deep (open surface, by vertices)"
    assert lines[0].startswith("touch yes, ") and said in lines[0], f"{name}: {said!r} is not in {lines[0]!r}"
    print(f"{name}: {lines[0]}")
    collision = json.loads(command.run("collide", *files, "--voxel-size", 4, "--json").splitlines()[-1])
    for answer in (measures, collision):
        assert answer["touch"] == "yes" and answer["depth_lower"] is None and answer["depth_upper"] is None, name
    holds(f"{name}: collide's depth_at_vertices and occlusion's differ by",
          abs(collision["depth_at_vertices"] - measures["depth_at_vertices"]), MICROMETRE)


def main(ist, folder):
    command = Command(ist, folder)
    files = command.built_in_jaws()
    closed, _ = command.map(*files)
    for which, jaw in enumerate(CUTS):
        for place, height in CUTS[jaw].items():
            name = f"{jaw} jaw cut at {height:g} ({place})"
            opened = list(files)
            opened[which] = command.folder / f"{jaw}_{place}.stl"
            write_stl(opened[which], cut(read_stl(files[which]), jaw, height))
            bodies, lines = command.map(*opened)
            other = 1 - which
            on_border = against_shell(name, bodies[other], closed[other], bodies[which], closed[which])
            assert place == "gum" or on_border > 100, f"{name}: too few vertices are nearest to the border"
            of_shell(name, bodies[which], closed[which])
            what_is_said(name, command, opened, lines, bodies)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
