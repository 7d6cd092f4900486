#!/usr/bin/env python3
"""Writes values, units and defaults into the tables of docs/scene-reference.md, as the reader of scenes has them.

    scripts/scene_reference.py build/test/tests/docs/scene_keys           writes the page
    scripts/scene_reference.py build/test/tests/docs/scene_keys --check   fails where the page would change

The page's rows say what a key means. A row of a key that the reader does not ask for is an error, and so is a key without a
row.
"""

import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/scene-reference.md"
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Read as tables of their own.
TABLES = {"fixed", "held", "device", "safety", "coupling", "effects"}


def power(match):
    """Powers of ten as people write them: from 10000 up, and below 0.001."""
    value = float(match[0])
    exponent = f"{value:.0e}".split("e")
    short = exponent[0] in ("1", "-1") and float(f"{value:.0e}") == value
    if not short or 1e-3 <= abs(value) < 1e4:
        return match[0]
    return exponent[0].replace("1", "10") + str(int(exponent[1])).translate(RAISED)


def readable(text):
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", power, text)


def read_keys(program):
    """By path; the two bodies have the same keys."""
    scenes = sorted((ROOT / "tests/docs/scenes").glob("*.toml"))
    listed = subprocess.run([program, *scenes], capture_output=True, text=True, check=True).stdout
    keys = {}
    for line in map(json.loads, listed.splitlines()):
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
            unit = "scene's unit" if key["unit"] == "in the scene's unit" else key["unit"]
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
