"""Compares the benchmark runs of two commits. bench_compare.sh makes them."""

import json
import pathlib
import statistics
import sys

NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}


def nanoseconds(benchmark):
    """Returns the time by the clock that the benchmark chose. The processor's clock stands still while other programs run."""
    by_wall = benchmark["name"].endswith(("/real_time", "/manual_time"))
    return benchmark["real_time" if by_wall else "cpu_time"] * NANOSECONDS[benchmark["time_unit"]]


def read(folder, side):
    """Returns the times of each benchmark in ns, one a run, from the files SIDE-RUN-PROGRAM.json."""
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


def verdict(base, head, least):
    """Returns SLOWER if all new times exceed all old ones, and faster if all are shorter, by a factor of the medians of at least `least`."""
    times = statistics.median(head) / statistics.median(base)
    if min(head) > max(base) and times > least:
        return "SLOWER"
    return "faster" if max(head) < min(base) and times < 1 / least else "-"


def readable(time):
    """Returns a time, given in ns, in the unit that suits it."""
    unit = next((unit for unit in ("s", "ms", "us") if time >= NANOSECONDS[unit]), "ns")
    return f"{time / NANOSECONDS[unit]:.3g} {unit}"


def compare(base, head, base_name="base", head_name="head", least=1):
    """Returns the lines of the table, and the names of the slower rows. Raises ValueError if the sides share no row."""
    both = [name for name in base if name in head]
    if not both:
        raise ValueError(f"nothing is on both sides: {len(base)} in {base_name}, {len(head)} in {head_name}")
    width = max(map(len, both))
    lines = [f"{'':<{width}} {base_name:>9} {head_name:>9}  ratio  best {head_name}/worst {base_name}"]
    slower = []
    for name in both:
        old, new = statistics.median(base[name]), statistics.median(head[name])
        said = verdict(base[name], head[name], least)
        lines.append(f"{name:<{width}} {readable(old):>9} {readable(new):>9} {new / old:6.3f} {min(head[name]) / max(base[name]):6.3f}  {said}")
        if said == "SLOWER":
            slower.append(name)
    for side, here, there in ((base_name, base, head), (head_name, head, base)):
        lines += [f"only in {side}, not compared: {name}" for name in here if name not in there]
    return lines, slower


def report_errors(script, main, folder):
    """Returns the exit code of a comparison. It is 2 if the runs cannot be compared."""
    try:
        return main(folder)
    except (OSError, ValueError, KeyError) as error:
        print(f"{script}: {error}", file=sys.stderr)
        return 2


def main(folder):
    lines, slower = compare(read(folder, "base"), read(folder, "head"))
    print("\n".join(lines))
    print(f"{len(slower)} slower: {', '.join(slower)}" if slower else "nothing is slower")
    print(f"raw results: {folder}")
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(report_errors("bench_compare", main, sys.argv[1]))
