"""The same peers under other conditions: bodies in turned frames, cold caches, IST without AVX-512."""

from report.peer_answers import QUESTIONS, Answers, medians, verdict
from report.losses import by_reason, is_loss
from report.text import number, table


def asked_in(results, series):
    """By question; nothing where the program did not ask so."""
    if not results.has("peers_bench", series):
        return {}
    return {question: Answers(results, question, series) for question in QUESTIONS}


def ratios(asked, beside, player, beside_player=None):
    """How many times as long a contestant takes as another did at the same poses."""
    return [asked.runs[player, pose]["p50_us"] / beside.runs[beside_player or player, pose]["p50_us"] for pose in asked.poses]


def span(values):
    low, high = number(min(values), 2), number(max(values), 2)
    return low if low == high else f"{low} to {high}"


def _turns(context):
    if "turned_degrees" not in context:
        return "both meshes turned"
    fixed, moving = context["turned_degrees"].split()
    return f"the fixed mesh turned by {fixed} degrees and the moving one by {moving}"


def turned(results, answers):
    asked = asked_in(results, "turned")
    if not asked:
        return []
    lines = ["### In turned frames", "",
             f"The same poses, the same bodies given in other frames: {_turns(results.context('peers_bench'))}, "
             "each about an oblique axis of its own, vertices rounded to double, poses composed to match. A scan lies along its scanner's "
             "axes, which favours boxes and voxels along the same axes; turned bodies do not. Exact contestants agree here too, or the run "
             "fails.", ""]
    for question, title in QUESTIONS.items():
        first, *rest = medians(question, asked[question])
        lines += [f"{title} {first}", *rest, *verdict(asked[question]), ""]
    rows = []
    for player in dict.fromkeys(player for one in asked.values() for player in one.players):
        rows.append([player] + [span(ratios(asked[question], answers[question], player)) if player in asked[question].players else ""
                                for question in QUESTIONS])
    return lines + ["Time as a multiple of the time with the meshes as given, over these poses:", "",
                    *table(["", *QUESTIONS], rows), ""]


def cold(results, answers):
    asked = asked_in(results, "cold")
    if not asked:
        return []
    swept = results.context("peers_bench")["swept_mb"]
    rows = []
    for question, one in asked.items():
        for player in one.players:
            times = ratios(one, answers[question], player)
            cells = []
            for pose, run, ratio in zip(one.poses, one.row(player), times):
                text = number(run["p50_us"])
                text = f"**{text}**" if player in one.winners(pose) else text
                cells.append(f"{text} ({number(ratio, 2)})")
            rows.append([question, one.name(player), *cells, str(one.rounds(player))])
    poses = next(iter(asked.values())).poses
    return ["### With cold caches", "",
            f"The quickest again at the same poses, but before each question {number(float(swept))} MB are read, twice the size of the last "
            "cache: a program that asks seldom finds its caches so. Median, µs, and in brackets the multiple of the time in the tables above, "
            "where one question follows the other; the fastest is in bold, as there.", "",
            *table(["question", "", *poses, "n"], rows), "",
            *(text for question, one in asked.items() for text in (f"{QUESTIONS[question]} {verdict(one)[0]}", ""))]


def points(results):
    if not results.has("peers_bench", "points"):
        return []
    runs = results.runs("peers_bench", "points", "distances")
    poses = list(dict.fromkeys(run.parts[3] for run in runs))
    by = {(run.parts[2], run.parts[3]): run for run in runs}
    players = list(dict.fromkeys(run.parts[2] for run in runs))
    rows = [["vertices", *(f"{by[players[0], pose]['points']:,.0f}" for pose in poses), ""]]
    for player in players:
        cells = [number(by[player, pose]["p50_us"] / 1e3)
                 + (f" ({by[player, pose]['p50_us'] / by['ist', pose]['p50_us']:.1f})" if player != "ist" else "")
                 for pose in poses]
        rows.append([player, *cells, str(int(by[player, poses[0]]["n"]))])
    return ["### How far is each vertex?", "",
            f"The vertices of both jaws {_near(runs[0])} the other one, at the closing. IST also gives the sign, the triangle and its point; "
            "CGAL's `AABB_tree`, with its tree of points, gives the distance alone. Both are right to within rounding, or the run fails. "
            "Median, ms, and in brackets the multiple of IST's time:", "",
            *table(["", *poses, "n"], rows), "", points_verdict(by, players, poses), ""]


def _near(run):
    return f"within {run['reach_mm']:g} mm of" if "reach_mm" in run else "near"


def points_verdict(by, players, poses):
    """Who measures the vertices faster than IST; runs by contestant and pose."""
    lost = [(f"{player} at {pose}, {number(by['ist', pose]['p50_us'] / by[player, pose]['p50_us'])} times as fast", None)
            for player in players if player != "ist" for pose in poses if by[player, pose]["p50_us"] < by["ist", pose]["p50_us"]]
    return f"IST loses to {by_reason(lost)}." if lost else f"IST is the fastest at all {len(poses)} poses."


def avx2(results):
    title = ["### IST without AVX-512", ""]
    asked = asked_in(results, "avx2")
    if not asked:
        return title + ["Not measured: the kernels that IST chooses on this processor are not those for AVX-512, "
                        "or it has none for AVX2 beside them.", ""]
    rows = []
    for question, one in asked.items():
        times = ratios(one, one, "ist_avx2", "ist")
        rows.append([question, *(f"{number(run['p50_us'])} ({number(ratio, 3)})" for run, ratio in zip(one.row("ist_avx2"), times)),
                     str(one.rounds("ist_avx2"))])
    poses = next(iter(asked.values())).poses
    return title + ["IST with its kernels for AVX2, in turn with the kernels that it chooses. Median, µs, and in brackets the multiple of "
                    "their time:", "", *table(["question", *poses, "n"], rows), "", avx2_verdict(asked), ""]


def avx2_verdict(asked):
    """Where the kernels for AVX2 are faster than those that IST chooses."""
    times = [(question, pose, ratio) for question, one in asked.items() for pose, ratio in zip(one.poses, ratios(one, one, "ist_avx2", "ist"))]
    lost = [(f"{question} at {pose}, {number(1 / ratio, 3)} times", None) for question, pose, ratio in times if is_loss(ratio)]
    if not lost:
        return "The kernels that IST chooses are slower at no pose by 3 % or more."
    return f"The kernels for AVX2 are faster than those that IST chooses at {len(lost)} of {len(times)}: {by_reason(lost)}."
