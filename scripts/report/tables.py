"""Tables of runs. A table names its program, its rows and its columns; a column has a head, a counter and a rule for bold."""

import math
import re
import statistics

from report.results import Run

# A part of a page that a script writes.
BLOCK = re.compile(r"(<!-- (?!end of )([^>\n]*) -->\n).*?(<!-- end of \2 -->)", re.S)
NOISE = 0.03  # a factor nearer to 1 is neither gain nor loss
POLICIES = ("simple", "table", "tight", "slab")


def is_loss(factor):
    return factor < 1 - NOISE


def number(value, digits=3):
    """Returns a number with as many digits as count: 12,345 or 1.23 or 0.0123."""
    if value == 0:
        return "0"
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:,.0f}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.9f}".rstrip("0").rstrip(".") if "e" in text else text


def factor(value):
    """Returns a factor, in bold if it is a loss."""
    text = number(value) if value >= 10 else f"{value:.2f}"
    return f"**{text}**" if is_loss(value) else text


def markdown(head, rows, right=()):
    """Returns the lines of a table. Its cells are texts or numbers, and the columns `right` are aligned to the right."""
    def line(cells):
        return "| " + " | ".join(cell if isinstance(cell, str) else number(cell) for cell in cells) + " |"
    return [line(head), "|" + "".join("--:|" if column in right else "---|" for column in range(len(head))), *map(line, rows)]


def value_of(row, value):
    """Returns a counter by its name, a part of the run's name by its place, or the result of a function of the row."""
    return value(row) if callable(value) else row.parts[value] if isinstance(value, int) else row[value]


def fill(page, name, text):
    """Writes a text between `<!-- NAME -->` and `<!-- end of NAME -->` of a page."""
    before = page.read_text()
    if name not in {block[2] for block in BLOCK.finditer(before)}:
        raise SystemExit(f"{page} has no place for it: write <!-- {name} --> and <!-- end of {name} --> there")
    page.write_text(BLOCK.sub(lambda block: f"{block[1]}{text}\n{block[3]}" if block[2] == name else block[0], before))


class Table:
    """A table of a page. `rows(results, program)` gives its rows. `columns` is a list of (head, value) or (head, value, rule for bold), or a
    function that makes the list of the rows."""

    def __init__(self, program, rows, columns):
        self.program, self.rows, self.columns = program, rows, columns

    def lines(self, results):
        rows = self.rows(results, self.program)
        if not rows:
            return ["Not measured on this machine."]
        for before, row in zip([None, *rows], rows):
            row.before, row.rows = before, rows
        columns = self.columns(rows) if callable(self.columns) else self.columns
        return markdown([column[0] for column in columns], [[_cell(row, *column[1:]) for column in columns] for row in rows])


def _cell(row, value, is_bold=None):
    found = value_of(row, value)
    text = found if isinstance(found, str) else number(found)
    return f"**{text}**" if is_bold and is_bold(row) else text


def runs(*first, by=None, keep=None, sort=None):
    """Rows that are the runs whose names begin with these parts. Runs that differ in part `by` alone are one row, which has the counter
    p50_us of part x as x:p50_us."""
    def rows(results, program):
        found, made = [run for run in results.runs(program, *first) if keep is None or keep(run)], {}
        for run in found if by is not None else ():
            row = made.setdefault((*run.parts[:by], *run.parts[by + 1:]), Run(run))
            row.update({f"{run.parts[by]}:{name}": value for name, value in run.items()})
        found = list(made.values()) if made else found
        return sorted(found, key=sort) if sort else found
    return rows


def row(name, **values):
    """A row of values that are computed from several runs."""
    return Run({"name": name, **values})


def part(place):
    """Returns a part of a run's name as a number."""
    return lambda row: float(row.parts[place])


def scaled(value, by):
    return lambda row: by * value_of(row, value)


def code(value):
    return lambda row: f"`{value_of(row, value)}`"


def ratio(over, under):
    return lambda row: row[over] / row[under]


def between(points, x):
    """Returns y at x of points (x, y) that ascend in x, read in logarithms; None beyond them."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1:
            return y0 * (y1 / y0) ** (math.log(x / x0) / math.log(x1 / x0) if x1 > x0 else 0)
    return None


def power(xs, ys):
    """Returns the exponent p and the factor c of y = c x^p, by least squares in logarithms."""
    exponent, start = statistics.linear_regression([math.log(x) for x in xs], [math.log(y) for y in ys])
    return exponent, math.exp(start)
