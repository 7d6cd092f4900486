"""The lookup table: its different balls, each with a node that has it."""
import json

import numpy as np

from pictures.how.style import INK, POLICY, plt, save
from pictures.how.view import View

CUBE = (0.80, 0.87, 0.94)
ACROSS = 12
ROOT = {27: "√3/2", 54: "√6/2", 81: "3/2", 96: "√24/3", 108: "√3"}  # the radius in half edges


def distinct(entries):
    """Returns the masks of each ball, by the square of its radius and its centre."""
    balls = {}
    for entry in entries:
        balls.setdefault((entry["radius_squared"], tuple(entry["centre"])), []).append(entry["mask"])
    return {ball: balls[ball] for ball in sorted(balls, key=lambda ball: (ball[0], min(balls[ball])))}


def draw_ball(place, square, centre, masks):
    view = View(place)
    mask = max(masks, key=lambda each: (bin(each).count("1"), -each))  # the fullest node of this ball
    view.cube((-6, -6, -6), 12, INK, width=0.5, zorder=1)
    octants = [np.array([k & 1, k >> 1 & 1, k >> 2]) for k in range(8) if mask >> k & 1]
    for octant in sorted(octants, key=lambda each: each @ view.axes[2]):
        view.cube(6 * octant - 6, 6, INK, CUBE, zorder=2, width=0.5)
    view.ball(centre, square**0.5, POLICY["table"])
    view.show(13.4)
    count = f"{len(masks)} masks" if len(masks) > 1 else "1 mask"
    place.set_title(f"{mask:08b}\n{count}", fontsize=7.5, pad=3)


def draw(command, file):
    balls = distinct(json.loads("\n".join(command.lines("table", "--format", "json"))))
    squares = sorted({square for square, _ in balls})
    rows, at = [], []
    for square in squares:  # the last one, the circumsphere, stands in the shortest row
        group = [ball for ball in balls if ball[0] == square]
        rows.append(group)
    last = rows.pop()
    at = min(range(len(rows)), key=lambda row: len(rows[row]))
    figure, places = plt.subplots(len(rows), ACROSS, figsize=(12.4, 1.32 * len(rows) + 0.1))
    figure.subplots_adjust(left=0.085, right=0.995, top=0.925, bottom=0.01, wspace=0.02, hspace=0.34)
    for place in places.flat:
        place.axis("off")
    for row, group in enumerate(rows):
        for place, (square, centre) in zip(places[row], group):
            draw_ball(place, square, centre, balls[square, centre])
        box = places[row][0].get_position()
        figure.text(0.004, (box.y0 + box.y1) / 2, f"{len(group)} balls,\nradius {ROOT[group[0][0]]}\nhalf edges", fontsize=8.5, va="center")
    for place, (square, centre) in zip(places[at][ACROSS - len(last):], last):
        draw_ball(place, square, centre, balls[square, centre])
        box = place.get_position()
        figure.text(box.x0 - 0.01, (box.y0 + box.y1) / 2, f"{len(last)} ball,\nradius {ROOT[square]} half edges,\nthe circumsphere", fontsize=8.5,
                    va="center", ha="right")
    save(figure, file)
    smaller = sum(len(masks) for (square, _), masks in balls.items() if square < max(squares))
    return (f"The {len(balls)} balls of the table, by their {len(squares)} radii. Under each mask, octant 7 first, stands how many masks have "
            f"the ball; drawn is the fullest of these nodes. {smaller} of {sum(map(len, balls.values()))} "
            "masks have a ball smaller than the circumsphere.")
