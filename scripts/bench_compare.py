"""Compares the benchmark runs of two commits: see bench_compare.sh, which makes them."""

import json
import pathlib
import statistics
import sys

NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}


def nanoseconds(benchmark):
    """By the clock that the benchmark chose: the processor's, which stands still while others run, or the wall's."""
    by_wall = benchmark["name"].endswith(("/real_time", "/manual_time"))
    return benchmark["real_time" if by_wall else "cpu_time"] * NANOSECONDS[benchmark["time_unit"]]


def read(folder, side):
    """Times by benchmark, in ns, one a run, from the files SIDE-RUN-PROGRAM.json."""
    times, runs = {}, set()
    for file in sorted(pathlib.Path(folder).glob(f"{side}-*.json")):
        run = file.name.split("-")[1]
        runs.add(run)
        for benchmark in json.loads(file.read_text())["benchmarks"]:
            name = benchmark["name"]
            if benchmark.get("error_occurred"):
                raise ValueError(f"{file}: {name}: {benchmark['error_message']}")
            if run in times.setdefault(name, {}):
                raise ValueError(f"{file}: {name} is there twice")
            times[name][run] = nanoseconds(benchmark)
    for name, by_run in times.items():
        if len(by_run) != len(runs):
            raise ValueError(f"{folder}: {side}: {name} is in {len(by_run)} of {len(runs)} runs")
    return {name: list(by_run.values()) for name, by_run in times.items()}


def verdict(base, head):
    """Slower if all new times exceed all old ones, faster if all are less, otherwise neither."""
    if min(head) > max(base):
        return "SLOWER"
    return "faster" if max(head) < min(base) else "-"


def readable(time):
    """A time in ns with a unit that suits it."""
    unit = next((unit for unit in ("s", "ms", "us") if time >= NANOSECONDS[unit]), "ns")
    return f"{time / NANOSECONDS[unit]:.3g} {unit}"


def compare(base, head):
    """The lines of the table, and the names of what is slower. Precondition: something is on both sides."""
    both = [name for name in base if name in head]
    width = max(len(name) for name in both)
    lines = [f"{'benchmark':<{width}} {'base':>9} {'head':>9}  ratio  best head/worst base"]
    slower = []
    for name in both:
        old, new = statistics.median(base[name]), statistics.median(head[name])
        said = verdict(base[name], head[name])
        lines.append(f"{name:<{width}} {readable(old):>9} {readable(new):>9} {new / old:6.3f} "
                     f"{min(head[name]) / max(base[name]):6.3f}  {said}")
        if said == "SLOWER":
            slower.append(name)
    for side, here, there in (("base", base, head), ("head", head, base)):
        lines += [f"only in {side}, not compared: {name}" for name in here if name not in there]
    return lines, slower


def main(folder):
    try:
        base, head = read(folder, "base"), read(folder, "head")
    except (OSError, ValueError, KeyError) as error:
        print(f"bench_compare: {error}", file=sys.stderr)
        return 2
    if not any(name in head for name in base):
        print(f"bench_compare: no benchmark is on both sides: {len(base)} in base, {len(head)} in head",
              file=sys.stderr)
        return 2
    lines, slower = compare(base, head)
    print("\n".join(lines))
    print(f"{len(slower)} slower: {', '.join(slower)}" if slower else "nothing is slower")
    print(f"raw results: {folder}")
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
