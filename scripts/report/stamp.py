"""Writes into raw results what they were made with: `python3 -m report.stamp FILE NAME=VALUE…`. Google Benchmark's own
option for that takes no value with a '=' or a ',' in it."""

import json
import pathlib
import sys


def stamp(file, context):
    """`context` as NAME=VALUE; the file is whole, as it was or stamped."""
    file = pathlib.Path(file)
    data = json.loads(file.read_text())
    data["context"].update(item.split("=", 1) for item in context)
    part = file.with_suffix(".stamped")
    part.write_text(json.dumps(data, indent=1) + "\n")
    part.rename(file)


if __name__ == "__main__":
    stamp(sys.argv[1], sys.argv[2:])
