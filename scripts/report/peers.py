"""The same questions put to other libraries, in one run."""

import matplotlib.pyplot as plt

from report.text import number, table

PROGRAMS = ["peers_bench"]
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
           "without its own SSE code, and with assertions. Has no answer of candidates.",
    "fcl_within": "The same, its distance only as far as asked: its traversal passes over what is at most 0.05 mm nearer than "
                  "the nearest pair so far. FCL's own request has an absolute error, which does nothing in this version.",
    "embree": "rtcCollide over boxes in float; triangles told apart by IST's exact test. It takes no pose: the moving "
              "mesh is moved and its hierarchy refitted, which counts. Cannot stop at the first pair, so whether any meet "
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
MARKS = ["D", "o", "s", "^", "v", "P", "X", "<", ">", "h", "d", "p"]


class Answers:
    """The runs of one question by contestant and pose, both in the order they were asked in."""

    def __init__(self, results, question):
        self.runs = {}
        self.poses = {}
        for run in results.runs("peers_bench", "peers", question):
            player, pose = run.parts[2], run.parts[3]
            self.runs[player, pose] = run
            self.poses[pose] = run["label"]
        self.players = sorted({player for player, _ in self.runs}, key=list(USES).index)

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


def chapter(results, pictures):
    context = results.context("peers_bench")
    answers = {question: Answers(results, question) for question in QUESTIONS}
    poses = answers["meets"].poses
    known = " and poses whose truth was computed in other ways" if any(
        "true_distance" in run for run in answers["meets"].row("ist")) else ""
    lines = [
        "## Peers", "",
        f"Other libraries, asked in one process and one thread, of the same two meshes (the {context['pair']} jaws) at "
        f"the same poses: the closing (named by dz in mm){known}. Where there are voxels, they are of "
        f"{number(float(context['voxel_size']))} mm. Who has used the least time is asked all poses next, so that all "
        "get as much of it, and who is slow has fewer rounds (n). Before each round one query "
        "that does not count brings the asked one's data back. In each column, which is a pose, the fastest is in "
        "**bold**; where that one is marked, the fastest without a mark is as well. Marks: ~ samples points, so may be "
        "wrong; + has its moving mesh moved before the time begins; ≠ another answer than IST's.", ""]
    lines += missing(context)
    lines += versions(results) + pose_table(answers, poses)
    for question, title in QUESTIONS.items():
        lines += [f"### {title}", ""] + medians(question, answers[question]) + verdict(answers[question]) + [""]
    lines += plot(answers, poses, pictures) + tails(answers)
    lines += sampled(answers) + builds(results) + cannot(answers)
    return lines


def missing(context):
    if not context["missing_peers"]:
        return []
    return [f"Not asked, since they were not installed when this was built: {context['missing_peers']}.", ""]


def all_players(answers):
    return sorted({player for asked in answers.values() for player in asked.players}, key=list(USES).index)


def versions(results):
    built = results.runs("peers_bench", "peers", "build")
    return ["In these versions: " + ", ".join(f"{run.parts[2]} {run['label']}" for run in built) + ".", ""]


def pose_table(answers, poses):
    rows = []
    for pose, label in poses.items():
        pairs, gap = answers["pairs"].runs["ist", pose], answers["distance"].runs["ist", pose]
        distance = gap.get("true_distance")
        rows.append([pose, label, pairs["pairs"], interval(gap), "" if distance is None else number(distance)])
    return table(["pose", "what it is", "pairs that meet", "gap by ist (mm)", "true gap (mm)"], rows) + [""]


def interval(run):
    return f"{number(run['lower'])} to {number(run['upper'])}" if "upper" in run else f"over {number(run['lower'])}"


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


def tails(answers):
    """One row a question and contestant: 17 poses more would not be read."""
    rows = []
    for question, asked in answers.items():
        for player in asked.players:
            runs = dict(zip(asked.poses, asked.row(player)))
            slowest = max(runs, key=lambda pose: runs[pose]["p99.9_us"])
            worst = max(runs, key=lambda pose: runs[pose]["max_us"])
            rows.append([question, asked.name(player), runs[slowest]["p50_us"], runs[slowest]["p99.9_us"], slowest,
                         runs[worst]["max_us"], worst, str(asked.rounds(player))])
    return ["### The slowest answers", "",
            "The p99.9 of the pose where that is largest, and the worst answer at any pose; where n is below 1,000, "
            "the p99.9 is the worst of that pose.", "",
            *table(["question", "", "median there (µs)", "p99.9 (µs)", "pose", "worst (µs)", "pose", "n"], rows), ""]


def plot(answers, poses, pictures):
    """A panel a question, and one for the legend that they share."""
    figure, axes = pictures.figure(len(answers) + 1, width=15, height=4.6)
    players = all_players(answers)
    colours = plt.get_cmap("tab20").colors
    places = range(len(poses))
    times = [run["p50_us"] for asked in answers.values() for run in asked.runs.values()]
    for axis, (question, asked) in zip(axes, answers.items()):
        for player in asked.players:
            index, first = players.index(player), player == "ist"
            axis.plot(places, [run["p50_us"] for run in asked.row(player)], color=colours[index % len(colours)],
                      marker=MARKS[index % len(MARKS)], linewidth=2.4 if first else 1, zorder=3 if first else 2,
                      label=asked.name(player))
        axis.set(title=question, yscale="log", ylim=(0.7 * min(times), 1.4 * max(times)), xlabel="pose")
        axis.set_xticks(list(places))
        axis.set_xticklabels(list(poses), rotation=90, fontsize=7)
    axes[0].set_ylabel("median time of an answer (µs)")
    shared = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels())}
    axes[-1].axis("off")
    axes[-1].legend(shared.values(), shared.keys(), loc="center left")
    rounds = [run["n"] for asked in answers.values() for run in asked.runs.values()]
    name = pictures.save(figure, "peers", "Time by pose for each question and contestant",
                         f"Medians of n = {number(min(rounds))} to {number(max(rounds))} rounds, one thread")
    return [name, ""]


def sampled(answers):
    """How far those who sample points are from the truth."""
    meets, distance = answers["meets"], answers["distance"]
    rows = []
    for player in meets.players:
        if GUARANTEES[int(meets.row(player)[0]["promise"])] != "sampled":
            continue
        touching = sum(run["meets"] for run in meets.row("ist"))
        missed = sum(run["missed"] for run in meets.row(player))
        false = sum(run["false_touch"] for run in meets.row(player))
        known = [run for run in distance.row(player) if "true_distance" in run and "upper" in run]
        errors = [run["upper"] - run["true_distance"] for run in known]
        beyond = sum("upper" not in run for run in distance.row(player))
        rows.append([player, f"{missed:.0f} of {touching:.0f}", f"{false:.0f} of {len(meets.poses) - touching:.0f}",
                     f"{min(errors):+.4f} to {max(errors):+.4f}" if errors else "none known", str(beyond)])
    if not rows:
        return []
    return ["### What sampling costs", "",
            "Contestants marked ~ look at points of the moving surface and values of voxels, so they are compared with "
            "the tolerance of a voxel, and what they miss is counted here.", "",
            *table(["", "contacts missed", "false contacts", "error of distance (mm)",
                    "poses beyond the band, distance unknown"], rows), ""]


def builds(results):
    runs = results.runs("peers_bench", "peers", "build")
    least = {key: min(run[key] for run in runs) for key in ("p50_us", "held_mb", "peak_mb")}

    def cell(run, key, scale=1):
        text = number(run[key] * scale)
        return f"**{text}**" if run[key] == least[key] else text

    rows = [[run.parts[2], cell(run, "p50_us", 1e-3), number(run["max_us"] / 1000), number(run["n"]),
             cell(run, "held_mb"), number(run["grown_mb"]), cell(run, "peak_mb")] for run in runs]
    return ["### Build and memory", "",
            "From both meshes in memory to structures that can be asked, in one thread. Held: what malloc has in use "
            "after it and had not before (mallinfo2); grown: by how much more of the process is in memory, free pages "
            "given back; peak: by how much at most while building.", "",
            *table(["", "median (ms)", "worst (ms)", "n", "held (MB)", "grown (MB)", "peak (MB)"], rows), ""]


def cannot(answers):
    players = all_players(answers)
    rows = []
    for player in players:
        not_answered = [question for question, asked in answers.items() if player not in asked.players]
        one = next(asked.row(player)[0] for asked in answers.values() if player in asked.players)
        rows.append([player, GUARANTEES[int(one["promise"])], ", ".join(not_answered) or "–", USES[player]])
    return ["### What each cannot do", "",
            "Exact: decided without rounding, and checked: the run fails where two such differ. Rounded: decided in "
            "float or double. Sampled: of points only. Answers are compared by how many pairs they "
            "name. Where several contestants are of one library, each is asked what it is best at.", "",
            *table(["", "answers are", "not asked for", "how it is used, and what differs"], rows), ""]
