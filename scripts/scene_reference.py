#!/usr/bin/env python3
"""Writes values, units and defaults into the tables of docs/scene-reference.md, as the reader of scenes has them.

    scripts/scene_reference.py build/test/tests/docs/scene_keys           writes the page
    scripts/scene_reference.py build/test/tests/docs/scene_keys --check   fails if the page would change

The rows of the page explain the keys. Each key of the reader must have a row, and other rows are errors.
"""

import json
import re
import sys

from machine import output
from report.figures import ROOT

PAGE = ROOT / "docs/scene-reference.md"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Read as tables of their own.
TABLES = {"fixed", "held", "device", "safety", "coupling", "effects"}


def power(match):
    """Returns a power of ten with a raised exponent, from 10000 up and below 0.001, and other numbers as they are."""
    value = float(match[0])
    digit, exponent = f"{value:.0e}".split("e")
    if digit not in ("1", "-1") or float(f"{value:.0e}") != value or 1e-3 <= abs(value) < 1e4:
        return match[0]
    return f"{digit}0{str(int(exponent)).translate(RAISED)}"


def readable(text):
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", power, text)


def read_keys(program):
    """Returns the keys by path. Both bodies have the same keys."""
    keys = {}
    for line in map(json.loads, output(program, *sorted((ROOT / "tests/docs/scenes").glob("*.toml"))).stdout.splitlines()):
        path = re.sub(r"^(fixed|held)\.", "body.", line["path"])
        known = keys.setdefault(path, line)
        if not known["values"]:
            known["values"], known["unit"] = line["values"], line["unit"]
        if line["values"] and (known["values"], known["unit"], known["default"]) != (line["values"], line["unit"], line["default"]):
            sys.exit(f"scene_reference: {path} differs between scenes: {known} and {line}")
    return {path: key for path, key in keys.items() if path not in TABLES and key["values"] != "a table"}


def written(page, keys):
    """Returns the page with the reader's values, and the errors in its rows."""
    table, rows, wrong = None, [], []
    lines = page.splitlines()
    for at, line in enumerate(lines):
        if line.startswith("## "):
            names = re.findall(r"`\[([\w.]+)\]`", line)
            table = "body." if "fixed" in names else f"{names[0]}." if names else ""
        elif found := re.match(r"\| `([\w.]+)` \| (.*?) \|", line):
            path = table + found[1]
            if not lines[at - 1].startswith("|"):
                wrong.append(f"line {at + 1}: the row of {path} has no table above it")
                continue
            if path not in keys:
                wrong.append(f"line {at + 1}: no reader asks for {path}")
                continue
            rows.append(path)
            key = keys[path]
            default = key["default"] or ("–" if key["optional"] else "mandatory")
            unit = key["unit"].removeprefix("in the ")
            cells = [f"`{found[1]}`", found[2], readable(key["values"]).replace("|", "\\|"), unit, readable(default)]
            lines[at] = "| " + " | ".join(cells) + " |"
    wrong += [f"{path} has no row" for path in keys if path not in rows]
    wrong += [f"{path} has two rows" for path in set(rows) if rows.count(path) > 1]
    return "\n".join(lines) + "\n", wrong


def main():
    words = [word for word in sys.argv[1:] if word != "--check"]
    if len(words) != 1:
        sys.exit(__doc__)
    keys = read_keys(words[0])
    before = PAGE.read_text()
    after, wrong = written(before, keys)
    if wrong:
        sys.exit("\n".join(f"scene_reference: {PAGE.name}: {line}" for line in wrong))
    if "--check" in sys.argv and before != after:
        sys.exit(f"scene_reference: {PAGE.name} is not as the reader is: run scripts/scene_reference.py")
    PAGE.write_text(after)
    print(f"{len(keys)} keys")


if __name__ == "__main__":
    main()
