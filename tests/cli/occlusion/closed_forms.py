#!/usr/bin/env python3
"""Holds `ist occlusion` of spheres and boxes, from STL to JSON, against closed forms, at three densities of their meshes.

    closed_forms.py IST FOLDER

    IST     the ist command
    FOLDER  for what is made on the way; is emptied first

Every figure must lie in an interval that is derived for its density, and its error must fall from density to density.

A mesh of a sphere of radius r whose vertices lie on it lies between the spheres of radius r - δ and r (δ is its
sagitta). So, of any point, the distance from it is that from the sphere, or greater by at most δ. Its facets, seen
from the centre, are parts of the sphere: a point is moved by at most δ, and an area changes by a factor between
(1 - δ/r)² and r / (r - δ). A function whose second derivatives are at most 1/ρ, as the distance from a sphere has,
differs on a triangle with edges up to e by at most η = e²/(6ρ) from its linear interpolation, which is the larger one
where the function is convex: e/√3 is the radius of a circle that holds the triangle.
"""
import sys

from oracles import Command, holds, np, write_stl
from plain_shapes import box, longest_edge, sagitta, sphere

PI = np.pi
# The command splits longer edges, mm.
SPLIT = 0.2
# The command asks for the depth to a 10,000th of the extent, whatever the density.
DEPTH_WIDTH = 1e-3
# Of STL's float32: coordinates are off by up to 1.2e-7, along borders of up to 8.
ROUNDING = 1e-6
# A general one, so that no vertex of a sphere is its lowest point.
TURN, _ = np.linalg.qr([[3, 1, 1], [1, 4, -1], [-1, 2, 5]])


class Densities:
    """Collects the errors of each figure from density to density."""

    def __init__(self, what):
        self.what, self.errors, self.smallest = what, {}, {}

    def add(self, figure, found, truth, least, most, smallest=ROUNDING):
        """The figure lies in [least, most], an interval that holds the truth. Errors below `smallest` count as that."""
        assert least - ROUNDING <= truth <= most + ROUNDING, f"{figure}: {least} {truth} {most}"
        name = f"{self.what}, {figure}"
        print(f"{name}: {found:.8g} for {truth:.8g}, in [{least:.8g}, {most:.8g}]")
        assert least - ROUNDING <= found <= most + ROUNDING, name
        self.errors.setdefault(figure, []).append(abs(found - truth))
        self.smallest[figure] = smallest

    def converge(self):
        for figure, errors in self.errors.items():
            smallest = self.smallest[figure]
            coarse, middle, fine = (max(error, smallest) for error in errors)
            print(f"{self.what}, {figure}: errors " + ", ".join(f"{error:.3g}" for error in errors))
            holds(f"{self.what}, {figure}: the finest error by the coarsest",
                  fine / coarse, max(0.3, smallest / coarse))
            holds(f"{self.what}, {figure}: the largest step", max(middle / coarse, fine / middle), 1)


def asked(command, fixed, moving, *more):
    files = [command.folder / name for name in ("fixed.stl", "moving.stl")]
    for file, corners in zip(files, (fixed, moving)):
        write_stl(file, corners)
    return command.measures(*files, *more)


def area(measures, body, micrometres):
    (found,) = [one["area"] for one in measures[body]["areas"] if one["micrometres"] == micrometres]
    return found


def depth(densities, measures, truth, below, above):
    """The depth is certain to lie in an interval, of which both ends are held against the truth."""
    width = measures["depth_upper"] - measures["depth_lower"]
    holds(f"{densities.what}: width of the depth's interval", width, DEPTH_WIDTH)
    assert measures["depth_upper"] >= truth - below - ROUNDING and measures["depth_lower"] <= truth + above + ROUNDING
    densities.add("depth", measures["depth_lower"], truth, truth - below - width, truth + above, DEPTH_WIDTH)


def sphere_on_plane(command):
    """A sphere of radius r dips by t into the plate z <= 0."""
    r, t = 2.0, 0.2

    def cap(level):  # of the sphere, up to that height
        return 2 * PI * r * max(t + level, 0)

    def cap_integral(level):  # ∫ max(level - z, 0) dA over the sphere
        return PI * r * max(t + level, 0) ** 2

    def disc(level):  # of the plate, as far from the sphere
        return PI * ((r + level) ** 2 - (r - t) ** 2)

    def disc_integral(level):  # ∫ max(level - d, 0) dA over the plate, in polar coordinates
        wide, high = r + level, r - t
        return PI * wide * (wide ** 2 - high ** 2) - 2 * PI / 3 * (wide ** 3 - high ** 3)

    densities = Densities("sphere on plane")
    for divisions, parts in ((3, 20), (4, 40), (5, 80)):
        ball, plate = sphere(r, divisions) @ TURN + (0, 0, r - t), box((-2, -2, -3), (2, 2, 0), (parts, parts, 3))
        found = asked(command, plate, ball)
        d = sagitta(ball, r, (0, 0, r - t))
        eta = min(4 / parts * 2 ** 0.5, SPLIT) ** 2 / (6 * (r - t))
        less, more = (1 - d / r) ** 2, r / (r - d)
        for micrometres in (0, 100):
            level = micrometres / 1000
            densities.add(f"cap within {micrometres} µm", area(found, "moving", micrometres), cap(level),
                          less * cap(level - d), more * cap(level + d))
            densities.add(f"disc within {micrometres} µm", area(found, "fixed", micrometres), disc(level),
                          disc(level - d - eta), disc(level))
        densities.add("depth integral of the cap", found["moving"]["depth_integral"], cap_integral(0),
                      less * cap_integral(-d), more * cap_integral(d))
        densities.add("depth integral of the disc", found["fixed"]["depth_integral"], disc_integral(0),
                      disc_integral(-d - eta), disc_integral(0))
        depth(densities, found, t, d, 0)
    densities.converge()


def two_boxes(command):
    """Cubes of edge 2 share a cube of edge s at their corners. On each of three faces, u and v from the other's
    edges, d is -min(u, v): its integral is s³/3 a face. Within L lie squares of s + L, one corner of each round."""
    # 10, 20 and 40 thirds of the grids' steps, so that the cubes' edges cut the grids alike.
    s, level = 5 / 12, 0.35
    densities = Densities("two boxes")
    for parts in (16, 32, 64):
        first, second = (box((low,) * 3, (low + 2,) * 3, (parts,) * 3) for low in (0, 2 - s))
        found = asked(command, first, second, "--preset", "owens")
        e = longest_edge(first)
        # Not linear: in triangles at the diagonal, by up to half of |u - v|, which is √2 e / 4 there; at the corner;
        # and round it, by η.
        eta = e ** 2 / (6 * (level - e))
        kink, corner, turn = (2 ** 0.5 * s + 2 * e) * 2 * e * 2 ** 0.5 * e / 4, (2 * e) ** 2, PI / 2 * (level + eta) * eta
        round_area = 3 * ((s + level) ** 2 - level ** 2 * (1 - PI / 4))
        for body in ("fixed", "moving"):
            densities.add(f"{body} within {1000 * level:g} µm", area(found, body, 350), round_area,
                          round_area - 3 * turn, round_area + 3 * turn)
            densities.add(f"{body} inside", found[body]["penetrating_area"], 3 * s ** 2,
                          3 * (s ** 2 - corner), 3 * (s ** 2 + corner))
            densities.add(f"depth integral of {body}", found[body]["depth_integral"], s ** 3,
                          s ** 3 - 3 * kink, s ** 3 + 3 * kink)
        depth(densities, found, s, 0, 0)
    densities.converge()


def sphere_in_sphere(command):
    """A sphere of radius r lies in one of radius R, their centres s apart: all of it is inside, and at its deepest
    point R - (r - s) deep. |p| from the other's centre has the mean r + s²/(3 r) over it."""
    outer, r, shift = 2.0, 1.0, np.array([0.3, 0.4, 0])
    s = np.linalg.norm(shift)
    whole = 4 * PI * r ** 2
    integral = whole * (outer - r - s ** 2 / (3 * r))
    densities = Densities("sphere in sphere")
    for divisions in (3, 4, 5):
        fixed, moving = sphere(outer, divisions), sphere(r, divisions, shift)
        found = asked(command, fixed, moving)
        wide, d = sagitta(fixed, outer), sagitta(moving, r, shift)
        eta = min(longest_edge(moving), SPLIT) ** 2 / (6 * (r - s - d))
        less, more = (1 - d / r) ** 2, r / (r - d)
        assert found["inside"] == "moving" and found["fixed"]["penetrating_area"] == 0
        densities.add("area inside", found["moving"]["penetrating_area"], whole, less * whole, more * whole)
        densities.add("depth integral", found["moving"]["depth_integral"], integral,
                      less * (integral - (wide + eta + d) * whole), more * (integral + d * whole))
        deepest = outer - (r - s)
        densities.add("depth at vertices", found["moving"]["depth_at_vertices"], deepest,
                      deepest - wide - longest_edge(moving), deepest)
        depth(densities, found, deepest, wide, d)
    densities.converge()


def main(ist, folder):
    command = Command(ist, folder)
    sphere_on_plane(command)
    two_boxes(command)
    sphere_in_sphere(command)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
