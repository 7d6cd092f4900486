#!/usr/bin/python3
"""Counts the instructions of ticks with callgrind: a scene with every effect loses one after the other, beside a program without
a scene that builds the remaining ones by hand. An unnamed effect costs nothing, so both must give the same count and the same bits,
and each removed effect must save instructions; otherwise this fails.

    scripts/tick_instructions.py [TICKS]    by default 300"""

import json
import math
import pathlib
import re
import sys
import tempfile

from machine import build, machine, output, refuse

BODIES = """unit = "mm"
[fixed]
shape = "box"
size = [40, 40, 10]
voxel_size = 1
[held]
shape = "sphere"
radius = 5
voxel_size = 0.5
translation = [0, 0, 11]
[device]
kind = "hand"
plan = [
  { time = 0, move = [0, 0, 0] },
  { time = 0.1, move = [0, 0, -3] },
  { time = 2, move = [6, 0, -3] },
]
"""
EFFECTS = {
    "springs": "[effects.springs]\nstiffness = 20000\nfull_area = 0.01\n",
    "damping": "[effects.damping]\ndamping = 10\n",
    "proximity": "[effects.proximity]\ndistance = 2\n",
    "gravity": "[effects.gravity]\nmass = 0.05\n",
    "snap": "[effects.snap]\nmove = [2, 0, -2]\nradius = 4\n",
}


def count(ticks, folder, *what):
    """Returns the instructions of the ticks alone, their result, and the number of effects."""
    out = folder / "callgrind.out"
    ran = output("valgrind", "--tool=callgrind", "--collect-atstart=no", "--toggle-collect=count_tick", f"--callgrind-out-file={out}",
                 "build/bench/bench/tick_instructions", *what, ticks)
    digest, effects = ran.stdout.split()
    found = re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)
    instructions = int(found[1]) if found else 0
    if instructions < 100 * ticks:
        sys.exit(f"tick_instructions: {instructions} instructions: nothing was counted")
    return instructions, digest, int(effects)


def main():
    words = sys.argv[1:]
    if len(words) != 1 or not words[0].isdigit():
        refuse(words, __doc__)
    ticks = int(words[0]) if words else 300
    build("bench", "tick_instructions", needs=["--bench", "--package"])
    lines, failed, before, left = [], False, math.inf, list(EFFECTS)
    with tempfile.TemporaryDirectory() as name:
        scene = pathlib.Path(name, "scene.toml")
        scene.write_text(BODIES + "".join(EFFECTS.values()))
        # The springs are first, and go last: damping acts at contacts.
        for effect in [None, *reversed(EFFECTS)]:
            if effect is not None:
                left.remove(effect)
                scene.write_text(re.sub(rf"\[effects\.{effect}\]\n(?:[^\[\n].*\n)*", "", scene.read_text()))
            removed, by_hand = count(ticks, scene.parent, scene), count(ticks, scene.parent, "--by-hand", ",".join(left) or "none")
            same, fewer = removed == by_hand and removed[2] == len(left), removed[0] < before
            before = removed[0]
            failed |= not (same and fewer)
            lines.append({"effects": left.copy(), "ticks": ticks, "instructions_taken_out": removed[0], "instructions_by_hand": by_hand[0],
                          "instructions_a_tick": round(removed[0] / ticks, 1), "digest": removed[1], "same": same})
            said = "same" if same else f"NOT THE SAME: {removed} {by_hand}"
            print(f"{', '.join(left) or 'no effects':<58} {removed[0]:>12} {by_hand[0]:>12}  {said}{'' if fewer else ', AND NOT FEWER'}", flush=True)
    here = machine()
    here.results.mkdir(parents=True, exist_ok=True)
    context = dict(each.split("=", 1) for each in here.context)
    (here.results / "tick_instructions.json").write_text(json.dumps({"context": context, "scenes": lines}, indent=2) + "\n")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
