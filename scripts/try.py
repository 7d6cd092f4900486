"""Compares runs of `ist bench` of a working tree and of HEAD: see try.sh, which makes them."""

import json
import pathlib
import statistics
import sys


def read(folder, side):
    """Medians by query, in µs, one a run; and what the query lists, which no run may change."""
    times, listed = {}, {}
    for file in sorted(pathlib.Path(folder).glob(f"{side}-*.jsonl")):
        for line in map(json.loads, file.read_text().splitlines()):
            if "question" not in line:
                continue
            key = (line["question"], line["way"], line["spheres"] or "", line["workers"])
            times.setdefault(key, []).append(line["microseconds_median"])
            listed.setdefault(key, set()).add(line["listed"])
    return times, listed


# Medians of four runs lie all beyond those of the other four once in 70 rows by chance alone, and hardly ever by this much.
LEAST = 1.03


def verdict(before, after):
    times = statistics.median(after) / statistics.median(before)
    if min(after) > max(before) and times > LEAST:
        return "slower"
    if max(after) < min(before) and times < 1 / LEAST:
        return "faster"
    return ""


def rows_of(head, tree):
    """Yields (name, µs before, µs after, ratio, verdict) of every query that both have."""
    for key, before in head.items():
        if key not in tree:
            continue
        question, way, spheres, workers = key
        name = ", ".join(word for word in (question, way, spheres, f"{workers} workers" if workers > 1 else "") if word)
        a, b = statistics.median(before), statistics.median(tree[key])
        yield name, a, b, b / a, verdict(before, tree[key])


def main(folder):
    (head, listed_before), (tree, listed_after) = read(folder, "head"), read(folder, "tree")
    if not head or not tree:
        raise ValueError(f"{folder} holds no runs of both sides")
    if not head.keys() & tree.keys():
        raise ValueError("the two sides have no query in common")
    print(f"{'query':<58} {'HEAD, µs':>10} {'tree, µs':>10} {'times':>7}")
    slower = 0
    for name, before, after, ratio, word in rows_of(head, tree):
        slower += word == "slower"
        print(f"{name:<58} {before:>10.2f} {after:>10.2f} {ratio:>7.3f} {word}")
    lost = sorted(head.keys() - tree.keys())
    for side, keys in (("HEAD", lost), ("the tree", sorted(tree.keys() - head.keys()))):
        for key in keys:
            print(f"only of {side}: {', '.join(map(str, key))}")
    others = [key for key in head if key in tree and listed_before[key] != listed_after[key]]
    for key in others:
        print(f"another answer: {', '.join(map(str, key))}: {sorted(map(str, listed_before[key]))} pairs, now {sorted(map(str, listed_after[key]))}")
    return 1 if slower or others or lost else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1]))
    except (OSError, ValueError, KeyError) as error:
        print(f"try: {error}", file=sys.stderr)
        sys.exit(2)
