#!/usr/bin/env python3
"""Holds the shares by side of `ist occlusion` on two pairs of jaws, whose patients face opposite ways, against VTK.

    side_shares.py IST FOLDER

    IST     the ist command
    FOLDER  for what is made on the way; is emptied first

The share of a side is that of ∫ max(0.1 mm - d, 0) dA, per cent. The reference splits triangles until no edge is over
0.1 mm (the command: 0.2 mm), takes VTK's signed distances, and asks of each small triangle on which side it lies. A pair
that is mirrored has its shares swapped. Without the jaws the exit code is 77; with IST_REQUIRE_ALL=1 it is 1.
"""
import sys

from oracles import Command, Surface, holds, jaws, np, read_stl, write_stl

FOUNDATION = 0.1
EDGE = 0.1
PER_CENT = 0.5  # triangles that lie across the plane count to one side, in the command
MIRRORED = 0.01  # triangles are split in another order


class Pair:
    """Two jaws, the pose of the lower one as options, the same mirrored in x, and the patient's left and front."""

    def __init__(self, name, files, pose, mirrored_pose, left, front, frame, agrees):
        self.name, self.files, self.pose, self.mirrored_pose = name, files, pose, mirrored_pose
        self.left, self.front, self.frame, self.agrees = left, front, frame, agrees

    def words(self):
        return ["--left", ",".join(map(str, self.left)), "--front", ",".join(map(str, self.front))]


def split(corners):
    """Returns the triangles without edges over EDGE that they consist of."""
    done = []
    while len(corners):
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        long = edges.max(1) > EDGE
        done.append(corners[~long])
        turn = (edges[long].argmax(1)[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(corners[long], turn[:, :, None], axis=1).transpose(1, 0, 2)
        middle = (a + b) / 2
        corners = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
    return np.concatenate(done)


def pressed(body, other):
    """Returns the middles of small triangles of a body, and ∫ p dA of each."""
    longest = np.linalg.norm(body.corners - np.roll(body.corners, -1, axis=1), axis=2).max(1)
    nearest = np.nan_to_num(body.signed[body.triangles], nan=np.inf).min(1)
    small = split(body.corners[nearest < FOUNDATION + longest])
    points, index = np.unique(small.reshape(-1, 3), axis=0, return_inverse=True)
    distances = Surface(other.points, other.triangles).signed(points)[index].reshape(-1, 3)
    a, b, c = small.transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return small.mean(1), np.maximum(FOUNDATION - distances, 0).mean(1) * area


def per_cent(middles, weights, direction, at):
    """Returns the share of the side that the direction points to."""
    return 100 * weights[middles @ np.array(direction) > at].sum() / weights.sum()


def shares(measures, body, key, names):
    """Returns both shares of a body, which sum up to 100 whatever the foundation."""
    for foundation in ("per_cent", "thinner", "thicker"):
        one, other = (measures[body][key][foundation][name] for name in names)
        asymmetry = measures[body][key][foundation]["asymmetry"]
        assert abs(one + other - 100) < 1e-9 and abs(asymmetry - abs(one - other)) < 1e-9, (body, foundation)
    return np.array([measures[body][key]["per_cent"][name] for name in names])


SIDES, ENDS = ("left", "right"), ("anterior", "posterior")


def against_vtk(command, pair):
    measures = command.measures(*pair.files, *pair.pose, *pair.words())
    bodies, _ = command.map(*pair.files, *pair.pose)
    box = read_stl(pair.files[0]).reshape(-1, 3).astype("f8")
    middle = (box.min(0) + box.max(0)) / 2
    for i, role in enumerate(("fixed", "moving")):
        middles, weights = pressed(bodies[i], bodies[1 - i])
        for key, names, direction in (("sides", SIDES, pair.left), ("fore_aft", ENDS, pair.front)):
            found = shares(measures, role, key, names)[0]
            truth = per_cent(middles, weights, direction, middle @ np.array(direction))
            print(f"{pair.name}, {role}: {names[0]} {found:.3f} %, by VTK {truth:.3f} %")
            holds(f"{pair.name}, {role}: the share of {names[0]} differs by", abs(found - truth), PER_CENT)
    return measures


def by_frame(command, pair, measures):
    """A frame names the same left as the direction does, and the same front or the opposite one."""
    framed = command.measures(*pair.files, *pair.pose, "--frame", pair.frame)
    for role in ("fixed", "moving"):
        assert (shares(framed, role, "sides", SIDES) == shares(measures, role, "sides", SIDES)).all(), role
        ends = shares(framed, role, "fore_aft", ENDS)
        assert (ends == shares(measures, role, "fore_aft", ENDS if pair.agrees else ENDS[::-1])).all(), role


def mirrored(command, pair, measures):
    files = []
    for file in pair.files:
        corners = read_stl(file).copy()
        corners[:, :, 0] *= -1
        files.append(command.folder / f"mirrored_{file.name}")
        write_stl(files[-1], corners[:, ::-1])
    swapped = command.measures(*files, *pair.mirrored_pose, *pair.words())
    for role in ("fixed", "moving"):
        here, there = (shares(of, role, "sides", SIDES) for of in (measures, swapped))
        holds(f"{pair.name} mirrored, {role}: left and what was right differ by", abs(here - there[::-1]).max(), MIRRORED)
        ends = (shares(of, role, "fore_aft", ENDS) for of in (measures, swapped))
        holds(f"{pair.name} mirrored, {role}: front differs by", abs(np.subtract(*ends)).max(), MIRRORED)


def main(ist, folder):
    command = Command(ist, folder)
    # Turned about y, which points behind, the side of lower x comes up: the patient's left.
    human = Pair("human", jaws("human_maxilla", "human_mandible"),
                 ("--turn", "y,0.3@0,-20,45", "--move", "0,0,-0.6"), ("--turn", "y,-0.3@0,-20,45", "--move", "0,0,-0.6"),
                 (-1, 0, 0), (0, -1, 0), "ras", False)
    # The joint at x = -42 alone meets: the patient's right one.
    spl = Pair("spl", jaws("spl_cranium_face", "spl_mandible"), ("--move", "0,0,2"), ("--move", "0,0,2"),
               (1, 0, 0), (0, -1, 0), "lps", True)
    for pair, heavier, least in ((human, 0, 60), (spl, 1, 100)):
        measures = against_vtk(command, pair)
        for role in ("fixed", "moving"):
            assert shares(measures, role, "sides", SIDES)[heavier] >= least, f"{pair.name}: {SIDES[heavier]} is lighter"
        by_frame(command, pair, measures)
        mirrored(command, pair, measures)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
