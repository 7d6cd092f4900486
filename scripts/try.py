"""Compares runs of `ist bench` of a working tree and of HEAD. try.sh makes them."""

import json
import pathlib
import sys

from bench_compare import NANOSECONDS, compare, report_errors

# The medians of all four runs of one side lie beyond the other side's in one of 70 rows by chance, and hardly ever by this factor.
LEAST = 1.03


def read(folder, side):
    """Returns the medians of each query in ns, one a run, and the numbers of pairs that it lists. All runs must list the same number."""
    times, listed = {}, {}
    for file in sorted(pathlib.Path(folder).glob(f"{side}-*.jsonl")):
        for line in map(json.loads, file.read_text().splitlines()):
            if "question" in line:
                workers = f"{line['workers']} workers" if line["workers"] > 1 else ""
                name = ", ".join(filter(None, (line["question"], line["way"], line["spheres"], workers)))
                times.setdefault(name, []).append(line["microseconds_median"] * NANOSECONDS["us"])
                listed.setdefault(name, set()).add(str(line["listed"]))
    return times, listed


def main(folder):
    (head, listed_before), (tree, listed_after) = read(folder, "head"), read(folder, "tree")
    lines, slower = compare(head, tree, "HEAD", "tree", LEAST)
    lost = head.keys() - tree.keys()
    others = [name for name in head if name in tree and listed_before[name] != listed_after[name]]
    print("\n".join(lines))
    for name in others:
        print(f"another answer: {name}: {sorted(listed_before[name])} pairs, now {sorted(listed_after[name])}")
    return 1 if slower or others or lost else 0


if __name__ == "__main__":
    sys.exit(report_errors("try", main, sys.argv[1]))
