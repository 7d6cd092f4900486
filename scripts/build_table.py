#!/usr/bin/env python3
"""Writes the README's table of build times and sizes from the raw results of build_bench.

    scripts/build_table.py perf/results/MACHINE/build_bench.json README.md
"""
import json
import math
import pathlib
import re
import sys


def main(results, readme):
    data = json.loads(pathlib.Path(results).read_text())
    rows = {}
    for run in data["benchmarks"]:
        if run.get("aggregate_name", "median") != "median":
            continue
        _, policy, size = run["name"].split("/")[:3]
        rows.setdefault(float(size), {})[policy] = run
    lines = [
        "| voxel size | voxels | to `table` tree | in memory | with `tight` | in memory | peak |",
        "|---|---|---|---|---|---|---|",
    ]
    for size, by in sorted(rows.items(), reverse=True):
        table, tight = by["table"], by["tight"]
        lines.append(
            f"| {size:g} | {table['leaves']:,.0f} | {table['real_time']:,.0f} ms | {table['tree_MB']:,.1f} MB "
            f"| {tight['real_time']:,.0f} ms | {tight['tree_MB']:,.0f} MB | {tight['peak_MB']:,.0f} MB |")
    ends = [rows[max(rows)], rows[min(rows)]]
    growth = {p: math.log(ends[1][p]["real_time"] / ends[0][p]["real_time"]) / math.log(ends[1][p]["leaves"] / ends[0][p]["leaves"])
              for p in ("table", "tight")}
    pair, date = data["benchmarks"][0]["label"], data["context"]["date"][:10]
    text = (
        f"Building a tree from the {pair} upper jaw (106,998 triangles), two cores, median"
        f" ({pathlib.Path(results).parent.name}, {date}); from {max(rows):g} to {min(rows):g} the time grows as"
        f" voxels^{growth['table']:.2f}, with `tight` as voxels^{growth['tight']:.2f}:\n\n" + "\n".join(lines))
    file = pathlib.Path(readme)
    marked = re.compile(r"<!-- build table -->.*?(?=\n## )", re.S)
    file.write_text(marked.sub(lambda _: f"<!-- build table -->\n{text}\n", file.read_text()))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
