"""Curves through a few measured points, read between them in logarithms."""

import math


def between(points, x):
    """y at x of points (x, y), ascending in x, all above 0; None beyond them."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1:
            part = math.log(x / x0) / math.log(x1 / x0) if x1 > x0 else 0
            return y0 * (y1 / y0) ** part
    return None


def exponent(points):
    """The power by which y grows with x, by least squares in logarithms."""
    xs = [math.log(x) for x, _ in points]
    ys = [math.log(y) for _, y in points]
    mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / sum((x - mean_x) ** 2 for x in xs)


def crossings(xs, first, second):
    """Where two curves over the same x change places, between the points."""
    found = []
    for i in range(len(xs) - 1):
        a, b = math.log(first[i] / second[i]), math.log(first[i + 1] / second[i + 1])
        if a * b < 0:
            found.append(xs[i] + (xs[i + 1] - xs[i]) * a / (a - b))
    return found
