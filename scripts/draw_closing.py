#!/usr/bin/env python3
"""Draws the force on a hand that closes two jaws, over time, and how far the hand goes beyond the tool.

    scripts/draw_closing.py PATH/TO/ist OUTPUT.svg [SCENE.toml]

The command records the motion unpaced, so the picture is the same on every machine. The default scene is in docs/haptics.md. The script needs
Debian's python3-matplotlib, so run it with the system's python3.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

from pictures.drawing import plt

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs/haptics.md"
METRES = {"m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "inch": 0.0254}  # as base/units has them
EVERY = 5  # ticks a point of the picture
FORCE, STRETCH = "#b03a2e", "#1f618d"


def record(ist, scene, folder):
    """Returns the ticks of an unpaced run, the seconds of a tick, and the scene's unit."""
    ticks = folder / "ticks.jsonl"
    run = subprocess.run([ist, "run", scene, "--unpaced", "--record", ticks, "--json"], check=True, stdout=subprocess.PIPE)
    period = 1 / json.loads(run.stdout.splitlines()[-1])["rate"]
    unit = re.search(r'^unit\s*=\s*"(\w+)"', scene.read_text(), re.MULTILINE)[1]
    return [line for line in map(json.loads, ticks.open()) if "device" in line], period, unit


def touches(tick):
    return tick["leaf_pairs"] > 0 or len(tick["points"]) > 0


def draw(ticks, period, unit, output):
    times = [period * tick["tick"] for tick in ticks]
    touching = [touches(tick) for tick in ticks]
    plt.rcParams.update({"svg.hashsalt": "ist", "svg.fonttype": "none", "font.size": 9})
    figure, (felt, beyond) = plt.subplots(2, 1, sharex=True, figsize=(8, 4.6))

    felt.plot(times, [math.hypot(*tick["wrench"][:3]) for tick in ticks], color=FORCE, linewidth=1.4)
    felt.set_ylabel("force felt, N")
    ahead = [math.dist(tick["device"][:3], tick["tool"][:3]) / METRES[unit] for tick in ticks]
    beyond.plot(times, ahead, color=STRETCH, linewidth=1.4)
    beyond.set_ylabel(f"hand beyond the tool, {unit}")
    beyond.set_xlabel("s")
    for axes in (felt, beyond):
        axes.set_ylim(bottom=0)
        axes.margins(x=0)
        axes.spines[["top", "right"]].set_visible(False)
        axes.fill_between(times, 0, 1, where=touching, transform=axes.get_xaxis_transform(), color="0.94", linewidth=0, zorder=0)
    felt.text(times[touching.index(True)], 0.97, " bodies touch", transform=felt.get_xaxis_transform(), va="top", color="0.4")
    figure.tight_layout()
    output.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(output, metadata={"Date": None})


def main(ist, output, scene=None):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if scene is None:
            scene = folder / "closing.toml"
            scene.write_text(re.search(r"^```toml\n(.*?)^```$", PAGE.read_text(), re.DOTALL | re.MULTILINE)[1])
        ticks, period, unit = record(pathlib.Path(ist).resolve(), pathlib.Path(scene), folder)
    if not any(map(touches, ticks)):
        sys.exit("draw_closing: nothing touches in this scene: let the plan go farther")
    draw(ticks[::EVERY], period, unit, pathlib.Path(output))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
