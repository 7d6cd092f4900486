"""Times of peers from other runs than this one. They stand beside this run's measurements, never among them."""

from report.text import number

# How many times faster FCL 0.7.0 is than Debian's 0.7.0-3, when built by g++ 12 with -O3 -march=native -DNDEBUG and its SSE code
# (FCL_USE_SSE): medians over the poses of this chapter, the least and the greatest of two machines, an older one and an EPYC with
# AVX-512. Each measured once.
NATIVE_FCL = {"meets": (1.7, 2.1), "pairs": (1.8, 2.1), "distance": (1.1, 1.1)}

# All pairs at one pose, in µs, one day on one older machine.
PQP_DAY = {"pose": "truth7", "pqp": 4609, "embree": 4564, "fcl": 12610}


def native_fcl(question, asked):
    """Returns a sentence for below the table of a question, with the poses where FCL would win by the greater factor."""
    if question not in NATIVE_FCL or "fcl" not in asked.players:
        return []
    least, most = (number(factor) for factor in NATIVE_FCL[question])
    factor = least if least == most else f"{least} to {most}"
    won = [pose for pose in asked.poses if would_win(asked, pose, NATIVE_FCL[question][1])]
    ahead = (f"By the greater factor it would be the fastest of those without a mark at {len(won)} of {len(asked.poses)} poses "
             f"({', '.join(won)})." if won else "By this factor it would win at no pose.")
    return [f"FCL compiled for its processor, with its own SSE code and without assertions, is some {factor} times faster than "
            f"Debian's, which this run measures (one measurement on another machine, in no number above). {ahead}", ""]


def would_win(asked, pose, factor):
    players = [player for player in asked.players if asked.unmarked(player, pose)]
    fcl, _ = asked.best(pose, [player for player in players if player.startswith("fcl")])
    other, _ = asked.best(pose, [player for player in players if not player.startswith("fcl")])
    return fcl is not None and other is not None and fcl / factor < other


def absent(answers):
    """Returns sentences on PQP and Coal, which Debian lacks, with PQP's times of one day."""
    day = PQP_DAY
    text = ("PQP and Coal are missing, since Debian 12 has no package of them: the fastest below is the fastest among the libraries measured. "
            f"PQP was measured once, on an older machine: for all pairs at {day['pose']} it took {day['pqp']:,} µs, Embree "
            f"{day['embree']:,} and FCL {day['fcl']:,}.")
    runs = answers["pairs"].runs
    if ("fcl", day["pose"]) in runs:
        here = runs["fcl", day["pose"]]["p50_us"] * day["pqp"] / day["fcl"]
        text += (f" At the same ratio to FCL it would take some {number(here)} µs here; IST takes "
                 f"{number(runs['ist', day['pose']]['p50_us'])}.")
    return [text + " No time of Coal, a fork of FCL, is known here.", ""]
