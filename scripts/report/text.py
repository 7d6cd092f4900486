"""Markdown that is made of numbers."""


def number(value, digits=3):
    """With as many digits as count: 12,345 or 1.23 or 0.0123."""
    if value == 0:
        return "0"
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:,.0f}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.9f}".rstrip("0").rstrip(".") if "e" in text else text


def table(head, rows):
    """A table, whose cells are texts or numbers."""
    cell = lambda value: value if isinstance(value, str) else number(value)
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(cell(value) for value in row) + " |" for row in rows]
    return lines
