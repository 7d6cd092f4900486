"""What each contestant of peers_bench answered to a question, and how it stands beside the others."""

from report.text import number, table

GUARANTEES = ["exact", "rounded", "sampled"]

QUESTIONS = {
    "meets": "Do any triangles meet?",
    "pairs": "Which triangles meet? (all pairs)",
    "candidates": "Which may meet? (pairs among which are all that do)",
    "distance": "How far apart are the surfaces? (to within 0.05 mm)",
}

# How each is used; what it does not do is read from what it did not answer.
USES = {
    "ist": "This library: slabs, with triangles; one worker. Candidates are its exact pairs, which is more than asked.",
    "fcl": "OBBRSS hierarchies in double. Its distance is to rounding, more than is asked. Debian builds it for any x86-64, "
           "without its own SSE code, and with assertions: below each table stands what that costs it. Has no answer of candidates.",
    "fcl_within": "The same, its distance only as far as asked: its traversal passes over what is at most 0.05 mm nearer than "
                  "the nearest pair so far. FCL's own request has an absolute error, which does nothing in this version.",
    "embree": "rtcCollide over boxes in float; triangles told apart by IST's exact test. It takes no pose: the moving "
              "mesh is moved, in vectors, and its hierarchy refitted, which counts. Cannot stop at the first pair, so whether any meet "
              "takes as long as all pairs; knows no distance between meshes.",
    "embree_no_refit": "The same, but moved and refitted before the time begins.",
    "embree_boxes": "rtcCollide alone, refitted before the time begins.",
    "bullet": "GImpact in float, margin 0. Lists all pairs of boxes before it looks at a triangle, so does not stop "
              "early. Its test of triangles clips one at the edges of the other, and may name more pairs than meet. GImpact "
              "knows no distance.",
    "bullet_boxes": "GImpact's box search, its candidates told apart by IST's exact test. Boxes are rounded to 16 bits "
                    "an axis, so a pair may be missed.",
    "cgal": "AABB trees with EPICK, one gone through by the other's boxes; CGAL's parts, put together for this. It has no "
            "public least distance between two meshes, only from a point to one.",
    "cgal_rigid": "Rigid_triangle_mesh_collision_detection, which CGAL has for this question.",
    "openvdb": "A narrow-band level set of the fixed jaw (3 voxels to either side), read at one point for each voxel "
               "of the moving jaw's surface. Touches from inside, and misses what is between points.",
    "openvdb_vertices": "The same, read at the moving jaw's vertices alone.",
}


class Answers:
    """The runs of one question by contestant and pose, both in the order they were asked in; as given, or `turned`, …"""

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
        """With a mark where it does not do all that the others do."""
        run = self.row(player)[0]
        return player + (" ~" if GUARANTEES[int(run["promise"])] == "sampled" else "") + (" +" if run["prepared"] else "")

    def unmarked(self, player, pose):
        return self.name(player) == player and self.runs[player, pose]["agree"]

    def best(self, pose, players):
        """Who of these is the fastest there, and how fast; nobody where there are none."""
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
    told = []
    for player in asked.players:
        ratios = [run["pairs"] / asked.runs["ist", pose]["pairs"] for pose, run in zip(asked.poses, asked.row(player))
                  if not run["agree"] and asked.runs["ist", pose]["pairs"]]
        none = [run for pose, run in zip(asked.poses, asked.row(player))
                if not run["agree"] and not asked.runs["ist", pose]["pairs"]]
        if ratios:
            told.append(f"{player} names {number(min(ratios))} to {number(max(ratios))} times as many pairs at "
                        f"{len(ratios)} poses")
        if none:
            told.append(f"{player} names pairs at {len(none)} poses where none meet")
    return "; ".join(told)


def verdict(asked):
    """Where IST wins and where not: among all, then among those without a mark."""
    if asked.players == ["ist"]:
        return ["Nobody else was asked."]
    text = standing(asked, lambda player, pose: True)
    if any(not asked.unmarked(player, pose) for player, pose in asked.runs):
        text += " Among those without a mark, " + standing(asked, asked.unmarked)
    return [text]


def standing(asked, counts):
    lost = []
    for pose in asked.poses:
        ist = asked.runs["ist", pose]["p50_us"]
        others = [player for player in asked.players if player != "ist" and counts(player, pose)]
        time, winner = asked.best(pose, others)
        if winner and time < ist:
            lost.append((ist / time, winner, pose))
    count = len(asked.poses)
    if not lost:
        return f"IST is the fastest at all {count} poses."
    times, winner, pose = max(lost)
    names = sorted({winner for _, winner, _ in lost})
    return (f"IST is the fastest at {count - len(lost)} of {count} poses. At {len(lost)} **{', '.join(names)}** "
            f"{'is' if len(names) == 1 else 'are'}, by up to {number(times)} times (**{winner}**, {pose}).")
