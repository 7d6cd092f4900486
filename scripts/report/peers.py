"""The same questions put to other libraries, in one run."""

import matplotlib.pyplot as plt

from report import peers_builds, peers_elsewhere, peers_otherwise
from report.peer_answers import GUARANTEES, QUESTIONS, USES, Answers, all_players, medians, verdict
from report.text import number, table

PROGRAMS = ["peers_bench"]
MARKS = ["D", "o", "s", "^", "v", "P", "X", "<", ">", "h", "d", "p"]


def chapter(results, pictures):
    context = results.context("peers_bench")
    answers = {question: Answers(results, question) for question in QUESTIONS}
    poses = answers["meets"].poses
    known = " and poses whose true distance was computed by other means" if any(
        "true_distance" in run for run in answers["meets"].row("ist")) else ""
    lines = [
        "## Peers", "",
        f"Other libraries answer in one process and one thread, about the same two meshes (the {context['pair']} jaws) at "
        f"the same poses: the closing (named by dz in mm){known}. Voxels, where used, have "
        f"{number(float(context['voxel_size']))} mm. The contestant with the least time so far answers at all poses next, so that all "
        "get the same time, and a slow one has fewer rounds (n). Before each round one uncounted query "
        "brings the contestant's data back into the caches. In each column, which is a pose, the fastest is in "
        "**bold**; if it has a mark, the fastest without a mark is bold too. Marks: ~ samples points, so may be "
        "wrong; + has its moving mesh moved before the time begins; ≠ another answer than IST's.", ""]
    lines += missing(context) + compiled(context) + peers_elsewhere.absent(answers)
    lines += versions(results) + pose_table(answers, poses)
    for question, title in QUESTIONS.items():
        lines += [f"### {title}", *within(question, context), ""] + medians(question, answers[question]) + verdict(answers[question]) + [""]
        lines += peers_elsewhere.native_fcl(question, answers[question])
    lines += plot(answers, poses, pictures) + tails(answers)
    lines += peers_otherwise.turned(results, answers) + peers_otherwise.cold(results, answers)
    lines += peers_otherwise.avx2(results) + peers_otherwise.points(results)
    lines += sampled(answers) + peers_builds.section(results) + cannot(answers)
    return lines


def within(question, context):
    return ["", f"The tolerance is {context['tolerance']} mm."] if question == "distance" and "tolerance" in context else []


def missing(context):
    if not context["missing_peers"]:
        return []
    return [f"Missing, since they were not installed when this was built: {context['missing_peers']}.", ""]


def compiled(context):
    """Returns a sentence on the peers' flags; older results have none."""
    if "peer_flags" not in context:
        return []
    flags = f"for the processor they run on (`{context['peer_flags']}`), as" if context["peer_flags"] else "for any processor, though"
    return [f"CGAL is made of headers, and OpenVDB's grids are read by headers: they, and the code here that calls the others, are compiled {flags} "
            "IST chooses its vectors by the processor. The own code of FCL, Embree and Bullet is Debian's build.", ""]


def versions(results):
    built = results.runs("peers_bench", "peers", "build")
    return ["Versions: " + ", ".join(f"{run.parts[2]} {run['label']}" for run in built) + ".", ""]


def pose_table(answers, poses):
    rows = []
    for pose, label in poses.items():
        pairs, gap = answers["pairs"].runs["ist", pose], answers["distance"].runs["ist", pose]
        distance = gap.get("true_distance")
        rows.append([pose, label, pairs["pairs"], interval(gap), "" if distance is None else number(distance)])
    return table(["pose", "description", "pairs that meet", "gap by ist (mm)", "true gap (mm)"], rows) + [""]


def interval(run):
    return f"{number(run['lower'])} to {number(run['upper'])}" if "upper" in run else f"over {number(run['lower'])}"


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
            "The p99.9 of the pose with the largest p99.9, and the worst answer at any pose; where n is below 1,000, "
            "the p99.9 is the worst answer at that pose.", "",
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
    """Returns the errors of the contestants that sample points."""
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
            "Contestants marked ~ read values of voxels at points of the moving surface, so they are compared with "
            "the tolerance of a voxel, and this table counts their errors.", "",
            *table(["", "contacts missed", "false contacts", "error of distance (mm)",
                    "poses beyond the band, distance unknown"], rows), ""]


def cannot(answers):
    players = all_players(answers)
    rows = []
    for player in players:
        not_answered = [question for question, asked in answers.items() if player not in asked.players]
        one = next(asked.row(player)[0] for asked in answers.values() if player in asked.players)
        rows.append([player, GUARANTEES[int(one["promise"])], ", ".join(not_answered) or "–", USES[player]])
    return ["### What each cannot do", "",
            "Exact: decided without rounding, and checked: the run fails if two exact answers differ. Rounded: decided in "
            "float or double. Sampled: at points only. Answers are compared by their number of pairs. "
            "Where a library has several contestants, each answers the questions that it is best at.", "",
            *table(["", "answers are", "not asked for", "use and differences"], rows), ""]
