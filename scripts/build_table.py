#!/usr/bin/env python3
"""Writes the table of build times and sizes in docs/performance.md from the raw results of build_bench, each time a median.

    scripts/bench.sh build_bench -- --benchmark_repetitions=5
    scripts/build_table.py perf/results/MACHINE/build_bench.json docs/performance.md
"""
import json
import math
import pathlib
import re
import statistics
import sys

from report.figures import machine_state, stamp

POLICIES = ("table", "tight", "slab")


def read_rows(benchmarks):
    """By voxel size and policy: what was counted, and the median of the times."""
    rows = {}
    for run in benchmarks:
        if run["run_type"] == "iteration":
            _, policy, size = run["name"].split("/")[:3]
            rows.setdefault(float(size), {}).setdefault(policy, []).append(run)
    for size, by in rows.items():
        for policy in POLICIES:
            runs = by.get(policy, [])
            if len(runs) < 3:
                sys.exit(f"{size:g}, {policy}: {len(runs)} runs make no median: give --benchmark_repetitions=5")
            by[policy] = dict(runs[0], real_time=statistics.median(run["real_time"] for run in runs),
                              peak_MB=statistics.median(run["peak_MB"] for run in runs))
    return rows


def main(results, page):
    data = json.loads(pathlib.Path(results).read_text())
    rows = read_rows(data["benchmarks"])
    lines = [
        "| voxel size | voxels |" + "".join(f" `{policy}` | in memory |" for policy in POLICIES) + " peak |",
        "|---|---|" + "---|---|" * len(POLICIES) + "---|",
    ]
    for size, by in sorted(rows.items(), reverse=True):
        cells = "".join(f" {by[p]['real_time']:,.0f} ms | {by[p]['tree_MB']:,.1f} MB |" for p in POLICIES)
        lines.append(f"| {size:g} | {by['table']['leaves']:,.0f} |{cells} {by['slab']['peak_MB']:,.0f} MB |")
    coarse, fine = rows[max(rows)], rows[min(rows)]
    growth = {p: math.log(fine[p]["real_time"] / coarse[p]["real_time"]) / math.log(fine[p]["leaves"] / coarse[p]["leaves"])
              for p in POLICIES}
    first, context = data["benchmarks"][0], data["context"]
    text = (
        f"Building a tree from the {first['label']} upper jaw ({first['triangles']:,.0f} triangles), two cores, medians"
        f" ({pathlib.Path(results).resolve().parent.name}). From {max(rows):g} to {min(rows):g} the time grows as"
        f" voxels^{growth['table']:.2f}, with `tight` as voxels^{growth['tight']:.2f} and with `slab` as"
        f" voxels^{growth['slab']:.2f}; the peak is that of `slab`, the default.\n\n" + "\n".join(lines)
        + "\n\n" + stamp(context["commit"], context["date"][:10], "build_bench", machine_state(context)))
    file = pathlib.Path(page)
    marked = re.compile(r"<!-- build table -->.*?(?=\n## |\Z)", re.S)
    file.write_text(marked.sub(lambda _: f"<!-- build table -->\n{text}\n", file.read_text()))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
