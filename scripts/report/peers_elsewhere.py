"""Times of peers from other runs than this one, as perf/elsewhere.json keeps them with their sources. They stand beside this run's
measurements, never among them."""

import json
import pathlib

from report.text import number

ELSEWHERE = json.loads((pathlib.Path(__file__).parents[2] / "perf/elsewhere.json").read_text())


def native_fcl(question, asked):
    """Returns a sentence for below the table of a question, with the poses where FCL would win by its factors."""
    factors = ELSEWHERE["native_fcl"]["times_as_fast"].get(question)
    if factors is None or "fcl" not in asked.players:
        return []
    least, most = (number(factor) for factor in factors)
    factor = least if least == most else f"{least} to {most}"
    by_greater, by_less = ([pose for pose in asked.poses if would_win(asked, pose, of(factors))] for of in (max, min))
    which = ("this factor" if least == most else "either factor") if by_less == by_greater else "the greater factor"
    ahead = f"By {which} it would win at no pose."
    if by_greater:
        ahead = (f"By {which} it would be the fastest of those without a mark at {len(by_greater)} of {len(asked.poses)} poses "
                 f"({', '.join(by_greater)}){_less(by_less) if by_less != by_greater else ''}.")
    return [f"FCL compiled for its processor, with its own SSE code and without assertions, is some {factor} times faster than "
            f"Debian's, which this run measures ([{measured()}](elsewhere.json), in no number above). {ahead}", ""]


def _less(poses):
    return f", by the lesser one at {len(poses)}" + (f" ({', '.join(poses)})" if poses else "")


def measured():
    """Where FCL's factors were measured, and how often on each machine."""
    machines, runs = ELSEWHERE["native_fcl"]["machines"], ELSEWHERE["native_fcl"]["runs_a_machine"]
    where = "another machine" if len(machines) == 1 else f"{len(machines)} other machines"
    how_often = "one measurement" if runs == 1 else f"{runs} measurements"
    return f"{how_often} on {where}" if len(machines) == 1 else f"{how_often} on each of {where}"


def would_win(asked, pose, factor):
    players = [player for player in asked.players if asked.unmarked(player, pose)]
    fcl, _ = asked.best(pose, [player for player in players if player.startswith("fcl")])
    other, _ = asked.best(pose, [player for player in players if not player.startswith("fcl")])
    return fcl is not None and other is not None and fcl / factor < other


def absent(answers):
    """Returns sentences on PQP and Coal, which Debian lacks, with PQP's times of one day."""
    day = ELSEWHERE["pqp"]
    took = day["p50_us"]
    text = ("PQP and Coal are missing, since Debian 12 has no package of them: the fastest below is the fastest among the libraries measured. "
            f"PQP was measured once, [on an older machine](elsewhere.json): for all pairs at {day['pose']} it took {took['pqp']:,} µs, Embree "
            f"{took['embree']:,} and FCL {took['fcl']:,}.")
    runs = answers["pairs"].runs
    if ("fcl", day["pose"]) in runs:
        here = runs["fcl", day["pose"]]["p50_us"] * took["pqp"] / took["fcl"]
        text += (f" At the same ratio to FCL it would take some {number(here)} µs here; IST takes "
                 f"{number(runs['ist', day['pose']]['p50_us'])}.")
    return [text + " No time of Coal, a fork of FCL, is known here.", ""]
