"""Tables and the plot of the same questions put to other libraries, in one run."""

from report.draw import panel, plot
from report.results import Run
from report.tables import NOISE, Table, is_loss, number, row, runs

GUARANTEES = ["exact", "rounded", "sampled"]
QUESTIONS = ("meets", "pairs", "candidates", "distance")
SERIES = {"peers": "as given", "turned": "in turned frames", "cold": "with cold caches"}
MARKS = ["D", "o", "s", "^", "v", "P", "X", "<", ">", "h", "d", "p"]


def players(results, series, question):
    """A row a contestant, with the counters of each pose as pose:counter; none if the program did not ask so."""
    if not results.has("peers_bench", series, question):
        return []
    rows = runs(series, question, by=3)(results, "peers_bench")
    for one in rows:
        one.asked = rows
    return rows


def player(r):
    return r.parts[2]


def marked(r):
    """The contestant's name with its marks: ~ samples, + is prepared."""
    return player(r) + (" ~" if GUARANTEES[int(r["promise"])] == "sampled" else "") + (" +" if r["prepared"] else "")


def poses_of(rows):
    return [key.removesuffix(":p50_us") for key in rows[0] if key.endswith(":p50_us")]


def unmarked(r, pose):
    return marked(r) == player(r) and r[f"{pose}:agree"]


def fastest(rows, pose):
    return min(rows, key=lambda r: r[f"{pose}:p50_us"], default=None)


def time_at(pose, more=lambda r, pose: "" if r[f"{pose}:agree"] else " ≠"):
    """Returns the median of a contestant at a pose, and more of it. The median is bold if it is the least of all or of those without a mark."""
    def cell(r):
        bold = "**" if r in (fastest(r.asked, pose), fastest([one for one in r.asked if unmarked(one, pose)], pose)) else ""
        return f"{bold}{number(r[f'{pose}:p50_us'])}{bold}{more(r, pose)}"
    return cell


def n(r):
    return str(int(r["n"]))


def multiple(r, before, pose):
    return r[f"{pose}:p50_us"] / before[f"{pose}:p50_us"]


def cold(results, _program):
    """The rows of all questions with cold caches, each with its row as given."""
    found = [r for question in QUESTIONS for r in players(results, "cold", question)]
    for r in found:
        r["given"], = (one for one in players(results, "peers", r.parts[1]) if player(one) == player(r))
    return found


def cold_columns(rows):
    def more(r, pose):
        return f" ({number(multiple(r, r['given'], pose), 2)})"
    return [("question", 1), ("", marked), *((pose, time_at(pose, more)) for pose in poses_of(rows)), ("n", n)]


def span(values, digits=2):
    low, high = number(min(values), digits), number(max(values), digits)
    return low if low == high else f"{low} to {high}"


def turned(results, _program):
    """By contestant, the span over the poses of the time in turned frames as a multiple of the time as given."""
    found = {}
    for question in QUESTIONS:
        given = {player(r): r for r in players(results, "peers", question)}
        for r in players(results, "turned", question):
            times = [multiple(r, given[player(r)], pose) for pose in poses_of([r])]
            found.setdefault(player(r), row(player(r), **dict.fromkeys(QUESTIONS, "")))[question] = span(times)
    return list(found.values())


def avx2(results, _program):
    return [Run(r | {"own": own}) for question in QUESTIONS for rows in [{player(r): r for r in players(results, "avx2", question)}]
            for r, own in [(rows.get("ist_avx2"), rows.get("ist"))] if r]


def standing(rows, counts):
    """At how many poses IST is the fastest of those that count, as fast as the fastest, and slower; None if no other counts."""
    ist, lost, near, count = next(r for r in rows if player(r) == "ist"), [], 0, 0
    for pose in poses_of(rows):
        other = fastest([r for r in rows if not player(r).startswith("ist") and counts(r, pose)], pose)
        if other is None:
            continue
        count += 1
        if is_loss(multiple(other, ist, pose)):
            lost.append((multiple(ist, other, pose), pose, player(other)))
        else:
            near += multiple(other, ist, pose) < 1
    if not count:
        return None
    worst, at, who = max(lost, default=(0, "", ""))
    to = ", ".join(f"{name} at {sum(one == name for _, _, one in lost)}" for name in sorted({name for _, _, name in lost}))
    return {"count": count, "first": count - near - len(lost), "near": near, "lost": len(lost),
            "worst": f"{number(worst)} ({who}, {at})" if lost else "–", "to": to or "–"}


def standings(results, _program):
    return [row(question, series=words, among=among, **found) for series, words in SERIES.items() for question in QUESTIONS
            for rows in [players(results, series, question)] if rows
            for among, counts in (("all", lambda r, pose: True), ("without a mark", unmarked))
            for found in [standing(rows, counts)] if found]


def poses(results, _program):
    pairs, gap = ({"ist": r for r in players(results, "peers", question) if player(r) == "ist"}["ist"] for question in ("pairs", "distance"))

    def interval(pose):
        low = number(gap[f"{pose}:lower"])
        return f"{low} to {number(gap[f'{pose}:upper'])}" if f"{pose}:upper" in gap else f"over {low}"
    return [row(pose, words=gap[f"{pose}:label"], pairs=pairs[f"{pose}:pairs"], gap=interval(pose), true=gap.get(f"{pose}:true_distance", ""))
            for pose in poses_of([gap])]


def tails(results, _program):
    found = []
    for question in QUESTIONS:
        for r in players(results, "peers", question):
            slow, worst = (max(poses_of([r]), key=lambda pose: r[f"{pose}:{key}"]) for key in ("p99.9_us", "max_us"))
            found.append(row(r["name"], question=question, who=marked(r), median=r[f"{slow}:p50_us"], tail=r[f"{slow}:p99.9_us"], slow=slow,
                             max=r[f"{worst}:max_us"], worst=worst, n=n(r)))
    return found


def point_distances(results, _program):
    if not results.has("peers_bench", "points"):
        return []
    rows = runs("points", "distances", by=3)(results, "peers_bench")
    ist, all_poses = next(r for r in rows if player(r) == "ist"), poses_of(rows)

    def times(r):
        return {pose: number(r[f"{pose}:p50_us"] / 1e3) + (f" ({multiple(r, ist, pose):.1f})" if r is not ist else "") for pose in all_poses}
    return [row("points/distances/vertices", **{pose: number(ist[f"{pose}:points"]) for pose in all_poses}, n="", lost=()),
            *(row(r["name"], **times(r), n=n(r), lost=[pose for pose in all_poses if multiple(r, ist, pose) < 1]) for r in rows)]


def sampled(results, _program):
    distance = {player(r): r for r in players(results, "peers", "distance")}
    meets = players(results, "peers", "meets")
    ist, all_poses = next(r for r in meets if player(r) == "ist"), poses_of(meets)
    touching = sum(ist[f"{pose}:meets"] for pose in all_poses)
    for r in meets:
        if GUARANTEES[int(r["promise"])] != "sampled":
            continue
        of = distance[player(r)]
        errors = [of[f"{pose}:upper"] - of[f"{pose}:true_distance"] for pose in all_poses if {f"{pose}:upper", f"{pose}:true_distance"} <= {*of}]
        yield row(player(r), missed=f"{sum(r[f'{pose}:missed'] for pose in all_poses):.0f} of {touching:.0f}",
                  false=f"{sum(r[f'{pose}:false_touch'] for pose in all_poses):.0f} of {len(all_poses) - touching:.0f}",
                  error=f"{min(errors):+.4f} to {max(errors):+.4f}" if errors else "none known",
                  beyond=sum(f"{pose}:upper" not in of for pose in all_poses))


ARRANGEMENTS = {"all_touch": "all neighbours touch", "half_touch": "half of the neighbours touch", "close": "0.01 radii apart",
                "far": "a radius apart"}


def worlds(results, _program):
    """A row an arrangement of balls and a library, with the rows of the other libraries than IST."""
    if not results.has("peers_bench", "worlds"):
        return []
    found = results.runs("peers_bench", "worlds")
    for r in found:
        r["ready_us"] = r["set_up_us"] + r["first_us"]
        r["others"] = [one for one in found if one.parts[1] == r.parts[1] and one.parts[2] != "ist"]
    return found


def milliseconds(key):
    return lambda r: number(r[key] / 1e3)


def ist_is_worse(key):
    """Whether the row is IST's, and another library has a smaller value at the same balls."""
    return lambda r: r.parts[2] == "ist" and any(is_loss(one[key] / r[key]) for one in r["others"])


def world_times(head, key):
    return head, milliseconds(key), ist_is_worse(key)


def least(key):
    return lambda r: r[key] == min(one[key] for one in r.rows)


def all_players(results):
    """The contestants by name, each with a row and the questions that it answers."""
    found = {}
    for question in QUESTIONS:
        for r in players(results, "peers", question):
            found.setdefault(player(r), (r, []))[1].append(question)
    return dict(sorted(found.items(), key=lambda item: (item[0] != "ist", item[0])))


TABLES = {
    "versions": Table("peers_bench", runs("peers", "build"), [("library", 2), ("version", "label")]),
    "poses": Table("peers_bench", poses, [
        ("pose", 0), ("description", "words"), ("pairs that meet", "pairs"), ("gap by ist (mm)", "gap"), ("true gap (mm)", "true")]),
    **{f"{question} {words}": Table("peers_bench", lambda results, _, s=series, q=question: players(results, s, q), lambda rows: [
        ("", marked), *((pose, time_at(pose)) for pose in poses_of(rows)), ("n", n)])
       for series, words in SERIES.items() if series != "cold" for question in QUESTIONS},
    "standings": Table("peers_bench", standings, [
        ("question", 0), ("bodies", "series"), ("among", "among"), ("poses", "count"), ("IST is the fastest at", "first"),
        (f"as fast, within {100 * NOISE:.0f} %, at", "near"), ("slower at", "lost", lambda r: r["lost"] > 0), ("by up to, times", "worst"),
        ("than", "to")]),
    "slowest answers": Table("peers_bench", tails, [
        ("question", "question"), ("", "who"), ("median there (µs)", "median"), ("p99.9 (µs)", "tail"), ("pose", "slow"), ("worst (µs)", "max"),
        ("pose", "worst"), ("n", "n")]),
    "turned frames": Table("peers_bench", turned, [("", 0), *((question, question) for question in QUESTIONS)]),
    "cold caches": Table("peers_bench", cold, cold_columns),
    "kernels for AVX2": Table("peers_bench", avx2, lambda rows: [
        ("question", 1), *((pose, lambda r, pose=pose: f"{number(r[f'{pose}:p50_us'])} ({number(multiple(r, r['own'], pose))})",
                            lambda r, pose=pose: is_loss(multiple(r, r["own"], pose))) for pose in poses_of(rows)), ("n", n)]),
    "vertices": Table("peers_bench", point_distances, lambda rows: [
        ("", 2), *((pose, pose, lambda r, pose=pose: pose in r["lost"]) for pose in rows[0] if pose not in ("name", "n", "lost")), ("n", "n")]),
    "a thousand balls": Table("peers_bench", worlds, [
        ("balls", lambda r: ARRANGEMENTS[r.parts[1]]), ("", 2), ("pairs that intersect", "touching"), world_times("set up, ms", "set_up_us"),
        world_times("first answer, ms", "first_us"), world_times("both, ms", "ready_us"), world_times("all move, and an answer, ms", "moved_us"),
        ("held, MB", "held_mb", ist_is_worse("held_mb")), ("n", n)]),
    "sampling": Table("peers_bench", lambda *given: list(sampled(*given)), [
        ("", 0), ("contacts missed", "missed"), ("false contacts", "false"), ("error of distance (mm)", "error"),
        ("poses beyond the band, distance unknown", "beyond")]),
    "build and memory": Table("peers_bench", runs("peers", "build"), [
        ("", 2), ("median (ms)", lambda r: r["p50_us"] / 1e3, least("p50_us")), ("worst (ms)", lambda r: r["max_us"] / 1e3), ("n", "n"),
        ("held (MB)", "held_mb", least("held_mb")), ("grown (MB)", "grown_mb"), ("peak (MB)", "peak_mb", least("peak_mb"))]),
    "answers": Table("peers_bench", lambda results, _: [
        row(name, promise=GUARANTEES[int(r["promise"])], lacks=", ".join(q for q in QUESTIONS if q not in asked) or "–")
        for name, (r, asked) in all_players(results).items()], [("", 0), ("answers are", "promise"), ("not asked for", "lacks")]),
}


@plot("peers_bench")
def peers(results):
    """A panel a question, and one for the legend that they share."""
    asked, names = {question: players(results, "peers", question) for question in QUESTIONS}, list(all_players(results))
    shown = poses_of(asked["meets"])
    counts, times = zip(*((r["n"], r[f"{pose}:p50_us"]) for rows in asked.values() for r in rows for pose in shown))

    def look(r):
        index, is_ist = names.index(player(r)), player(r) == "ist"
        return {"color": f"C{index % 10}", "marker": MARKS[index % len(MARKS)], "linewidth": 2.4 if is_ist else 1, "zorder": 3 if is_ist else 2,
                "label": marked(r)}

    def share(_, all_axes):
        *axes, last = all_axes
        for one in axes:
            one.set_xticklabels(shown, rotation=90, fontsize=7)
        handles = {label: handle for one in axes for handle, label in zip(*one.get_legend_handles_labels())}
        last.axis("off")
        last.legend(handles.values(), handles.keys(), loc="center left")
    n = f"Medians of n = {number(min(counts))} to {number(max(counts))} rounds, one thread"
    return {"width": 15, "height": 4.6, "n": n, "then": share, "panels": [
        *(panel([(range(len(shown)), [r[f"{pose}:p50_us"] for pose in shown], look(r)) for r in rows], title=question, yscale="log",
                ylim=(0.7 * min(times), 1.4 * max(times)), xlabel="pose", xticks=range(len(shown)),
                ylabel="" if place else "median time of an answer (µs)") for place, (question, rows) in enumerate(asked.items())), panel([])]}
