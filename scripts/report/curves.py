"""Curves through a few measured points, read between them in logarithms."""

import math


def between(points, x):
    """y at x of points (x, y), ascending in x, all above 0; None beyond them."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1:
            part = math.log(x / x0) / math.log(x1 / x0) if x1 > x0 else 0
            return y0 * (y1 / y0) ** part
    return None


def power(xs, ys):
    """The exponent p and the factor c of y = c x^p, by least squares in logarithms."""
    xs, ys = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
    exponent = sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / sum((x - mean_x) ** 2 for x in xs)
    return exponent, math.exp(mean_y - exponent * mean_x)


def crossings(xs, first, second, noise=1.05):
    """Where two curves over the same x change places, between points at which one is less by more than the noise."""
    found, last = [], None
    for x, a, b in zip(xs, first, second):
        lead = math.log(a / b)
        if abs(lead) < math.log(noise):
            continue
        if last is not None and lead * last[1] < 0:
            found.append(last[0] + (x - last[0]) * last[1] / (last[1] - lead))
        last = (x, lead)
    return found
