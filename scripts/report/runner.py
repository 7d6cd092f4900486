"""Runs benchmark programs, and keeps their raw results."""

import json
import os
import pathlib
import subprocess
import sys
import time

from report.figures import changed_since, has_history, is_commit

PROGRAMS = pathlib.Path("build/bench/bench")


def fixed_loop():
    """The median time of a fixed loop on this machine, µs, as a text."""
    return subprocess.run([PROGRAMS / "fixed_loop"], capture_output=True, text=True, check=True).stdout.strip()


class Runner:
    def __init__(self, results, context, quick, environment=None):
        self.results, self.context = results, context
        # Without an environment by the caller, variables of other purposes do not change the measurements.
        own = {name: value for name, value in os.environ.items() if not name.startswith("IST_") or name == "IST_DATA_DIR"}
        self.environment = environment or own | ({"IST_QUICK": "1"} if quick else {})
        # The least time of benchmarks that Google Benchmark repeats by itself.
        self.least = ["--benchmark_min_time=0.02"] if quick else []
        results.mkdir(parents=True, exist_ok=True)

    def run(self, programs, again):
        """Runs all programs, or only the ones without results of this code."""
        missing = [p for p in programs if again or not self._is_whole(p)]
        for program in programs:
            if program not in missing:
                print(f"perf_report: {program}: results of this code are there", file=sys.stderr)
        for place, program in enumerate(missing, 1):
            self.measure(program, f"[{place}/{len(missing)}] {program}")

    def _is_whole(self, program):
        """Whether the results cover the whole program, not a part that the arguments of bench.py chose, and are of this code, made by
        this compiler with these flags. An earlier commit counts if nothing that the program rests on has changed since."""
        file = self.results / f"{program}.json"
        if not file.exists():
            return False
        made, now = json.loads(file.read_text())["context"], dict(item.split("=", 1) for item in self.context)
        if made.get("arguments") or any(made.get(name) != now.get(name) for name in ("compiler", "flags")):
            return False
        commit = made["commit"]
        if commit == now["commit"]:
            # A + says that code differed from the commit: it may differ otherwise by now.
            return not commit.endswith("+")
        return has_history() and is_commit(commit) and not changed_since(commit, program)

    def measure(self, program, title, more=(), shown=False):
        """Runs a program with more arguments, and keeps its results with them. `shown` tells whether its output is shown."""
        loop_before, begin, part = fixed_loop(), time.monotonic(), self.results / f"{program}.part"
        print(title, file=sys.stderr)
        done = subprocess.run([PROGRAMS / program, *self.least, f"--benchmark_out={part}", "--benchmark_out_format=json", *more],
                              env=self.environment, stdout=None if shown else subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            part.unlink(missing_ok=True)
            sys.exit(f"perf_report: {program} failed: {''.join(done.stderr.splitlines(keepends=True)[-5:])}")
        data = json.loads(part.read_text())
        for run in data["benchmarks"]:
            if run.get("error_occurred"):
                part.unlink()
                sys.exit(f"perf_report: {program}: {run['name']}: {run['error_message']}")
        # Google Benchmark's own option for its context refuses values with a '=' or a ','.
        data["context"] |= dict(item.split("=", 1) for item in self.context) | {
            "seconds": f"{time.monotonic() - begin:.1f}", "arguments": " ".join(more), "loop_before": loop_before, "loop_after": fixed_loop(),
            "load_after": f"{os.getloadavg()[0]:.2f}"}
        part.write_text(json.dumps(data, indent=1) + "\n")
        # The file of results is whole or absent. The next run repeats an interrupted one.
        part.rename(self.results / f"{program}.json")
