"""The answers of each contestant of peers_bench to a question, and their comparison."""

from report.losses import NOISE, by_reason, is_loss
from report.text import number, table

GUARANTEES = ["exact", "rounded", "sampled"]

QUESTIONS = {
    "meets": "Do any triangles meet?",
    "pairs": "Which triangles meet? (all pairs)",
    "candidates": "Which may meet? (pairs among which are all that do)",
    "distance": "How far apart are the surfaces? (to within a tolerance)",
}

# The use of each contestant; the questions that it cannot answer follow from the missing answers.
USES = {
    "ist": "This library: slabs, with triangles; one worker. Its candidates are its exact pairs, a stricter answer.",
    "fcl": "OBBRSS hierarchies in double. Its distance is exact to rounding, sharper than the tolerance. Debian builds it for any x86-64, "
           "without its own SSE code, and with assertions: a line below a table of times states their cost, where it was measured. "
           "It lists no candidates.",
    "fcl_within": "The same, with a distance to the tolerance: its traversal skips pairs that are nearer by at most the tolerance than "
                  "the nearest pair so far. FCL's own request has an absolute error, which does nothing in this version.",
    "embree": "rtcCollide over boxes in float; IST's exact test decides on the triangles. It takes no pose: the moving "
              "mesh is moved, in vectors, and its hierarchy refitted, and both count. It cannot stop at the first pair, so whether any meet "
              "takes as long as all pairs; it has no distance between meshes.",
    "embree_no_refit": "The same, but moved and refitted before the time begins.",
    "embree_boxes": "rtcCollide alone, refitted before the time begins.",
    "bullet": "GImpact in float, margin 0. It lists all pairs of boxes before it tests a triangle, so it does not stop "
              "early. Its test of triangles clips one at the edges of the other, and may name more pairs than meet. GImpact "
              "has no distance.",
    "bullet_boxes": "GImpact's box search; IST's exact test decides on its candidates. Boxes are rounded to 16 bits "
                    "an axis, so a pair may be missed.",
    "cgal": "AABB trees with EPICK, one traversed with the boxes of the other; CGAL's parts, combined for this. It has no "
            "public least distance between two meshes, only from a point to one.",
    "cgal_rigid": "Rigid_triangle_mesh_collision_detection, CGAL's own function for this question.",
    "openvdb": "A narrow-band level set of the fixed jaw, read at one point for each voxel "
               "of the moving jaw's surface. It counts a contact from inside, and misses contacts between points.",
    "openvdb_vertices": "The same, read at the moving jaw's vertices alone.",
}


class Answers:
    """The runs of one question by contestant and pose, both in the order of the run; as given, or `turned`, …"""

    def __init__(self, results, question, series="peers"):
        self.runs = {}
        self.poses = {}
        for run in results.runs("peers_bench", series, question):
            player, pose = run.parts[2], run.parts[3]
            self.runs[player, pose] = run
            self.poses[pose] = run["label"]
        self.players = list(dict.fromkeys(player for player, _ in self.runs))

    def row(self, player):
        return [self.runs[player, pose] for pose in self.poses]

    def rounds(self, player):
        return int(self.row(player)[0]["n"])

    def name(self, player):
        """The contestant's name with its marks: ~ sampled, + prepared."""
        run = self.row(player)[0]
        return player + (" ~" if GUARANTEES[int(run["promise"])] == "sampled" else "") + (" +" if run["prepared"] else "")

    def unmarked(self, player, pose):
        return self.name(player) == player and self.runs[player, pose]["agree"]

    def best(self, pose, players):
        """The least time at a pose and its contestant; two None without contestants."""
        return min(((self.runs[player, pose]["p50_us"], player) for player in players), default=(None, None))

    def winners(self, pose):
        return [self.best(pose, self.players)[1],
                self.best(pose, [player for player in self.players if self.unmarked(player, pose)])[1]]


def all_players(answers):
    return sorted({player for asked in answers.values() for player in asked.players}, key=list(USES).index)


def medians(question, asked):
    """Rows players, columns poses, µs."""
    rows = []
    for player in asked.players:
        cells = []
        for pose, run in zip(asked.poses, asked.row(player)):
            text = number(run["p50_us"])
            text = f"**{text}**" if player in asked.winners(pose) else text
            cells.append(text if run["agree"] else text + " ≠")
        rows.append([asked.name(player)] + cells + [str(asked.rounds(player))])
    lines = ["Median, µs:", ""] + table(["", *asked.poses, "n"], rows)
    if question in ("pairs", "candidates") and not all(run["agree"] for run in asked.runs.values()):
        lines += ["", f"≠: {other_pairs(asked)}."]
    return lines + [""]


def other_pairs(asked):
    differences = []
    for player in asked.players:
        ratios = [run["pairs"] / asked.runs["ist", pose]["pairs"] for pose, run in zip(asked.poses, asked.row(player))
                  if not run["agree"] and asked.runs["ist", pose]["pairs"]]
        none = [run for pose, run in zip(asked.poses, asked.row(player))
                if not run["agree"] and not asked.runs["ist", pose]["pairs"]]
        if ratios:
            differences.append(f"{player} names {number(min(ratios))} to {number(max(ratios))} times as many pairs at "
                               f"{len(ratios)} poses")
        if none:
            differences.append(f"{player} names pairs at {len(none)} poses where none meet")
    return "; ".join(differences)


def verdict(asked):
    """Where IST wins and where not: among all, then among those without a mark."""
    if asked.players == ["ist"]:
        return ["No other library answers."]
    text = standing(asked, lambda player, pose: True)
    if any(not asked.unmarked(player, pose) for player, pose in asked.runs):
        among = standing(asked, asked.unmarked, " where one answers")
        text += f" Among those without a mark, {among}" if among else " No other without a mark answers."
    return [text]


def standing(asked, counts, where=""):
    """At how many poses IST is the fastest among those that count, and each one that is faster, with the reason. Poses without
    another that counts are left out, and `where` says so; nothing where no pose is left."""
    lost, near, count = {}, 0, 0
    for pose in asked.poses:
        ist = asked.runs["ist", pose]["p50_us"]
        others = [player for player in asked.players if player != "ist" and counts(player, pose)]
        if not others:
            continue
        count += 1
        time, winner = asked.best(pose, others)
        if is_loss(time / ist):
            lost.setdefault(winner, []).append((ist / time, pose))
        else:
            near += time < ist
    if count == 0:
        return ""
    where = where if count < len(asked.poses) else ""
    equal = f", and as fast as the fastest, within {100 * NOISE:.0f} %, at {near}" if near else ""
    if not lost:
        return f"IST is the fastest at {count - near if near else 'all'} {'of ' if near else ''}{count} poses{where}{equal}."
    times, pose, winner = max((*max(wins), winner) for winner, wins in lost.items())
    places = sum(len(wins) for wins in lost.values())
    named = by_reason([(f"{winner} at {len(wins)}", reason(asked, winner, [pose for _, pose in wins])) for winner, wins in sorted(lost.items())])
    return (f"IST is the fastest at {count - places - near} of {count} poses{where}{equal}. **It loses at {places}, by up to {number(times)} times** "
            f"({winner}, {pose}): to {named}.")


def reason(asked, player, poses):
    """Why a contestant is faster at these poses; None where that is not known."""
    runs = [asked.runs[player, pose] for pose in poses]
    if GUARANTEES[int(runs[0]["promise"])] == "sampled":
        return "it reads stored distances at points, so it compares no triangles and may be wrong"
    if runs[0]["prepared"]:
        return "its mesh was moved, and its hierarchy refitted, before the time began"
    if not any(run["agree"] for run in runs):
        return "it gives another answer"
    return None
