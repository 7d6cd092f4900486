"""Runs benchmark programs, and keeps what they give as raw results."""

import json
import os
import pathlib
import subprocess
import sys
import threading
import time

from report.figures import changed_since, has_history, is_commit
from report.stamp import stamp

PROGRAMS = pathlib.Path("build/bench/bench")


def fixed_loop():
    """The median time of a fixed loop on this machine, µs, as a text."""
    return subprocess.run([PROGRAMS / "fixed_loop"], capture_output=True, text=True, check=True).stdout.strip()


class Runner:
    def __init__(self, results, context, quick):
        self.results, self.context = results, context
        # No variable that is set for another purpose changes the measurements.
        self.environment = {name: value for name, value in os.environ.items()
                            if not name.startswith("IST_") or name == "IST_DATA_DIR"}
        if quick:
            self.environment["IST_QUICK"] = "1"
        # The least time of benchmarks that Google Benchmark repeats by itself.
        self.least = ["--benchmark_min_time=0.02"] if quick else []
        results.mkdir(parents=True, exist_ok=True)

    def run(self, programs, again):
        """Runs those that have no results of this code yet, or all."""
        missing = [p for p in programs if again or not self._is_whole(p)]
        for program in programs:
            if program not in missing:
                print(f"perf_report: {program}: results of this code are there", file=sys.stderr)
        for place, program in enumerate(missing, 1):
            self._run(program, f"[{place}/{len(missing)}] {program}")

    def _is_whole(self, program):
        """Whether the results cover the whole program, not a part that the arguments of bench.sh chose, and are of this code, made by
        this compiler with these flags. An earlier commit counts where all that the program rests on is as it was then."""
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

    def _run(self, program, title):
        command = [str(PROGRAMS / program), *self.least]
        listed = subprocess.run([*command, "--benchmark_list_tests"], env=self.environment, capture_output=True, text=True)
        if listed.returncode != 0:
            sys.exit(f"perf_report: {program}: {listed.stderr}")
        count = len(listed.stdout.splitlines())
        loop_before = fixed_loop()
        part, begin = self.results / f"{program}.part", time.monotonic()
        with subprocess.Popen([*command, f"--benchmark_out={part}", "--benchmark_out_format=json"], env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
            said = []
            listener = threading.Thread(target=lambda: said.extend(run.stderr))
            listener.start()
            done = 0
            for line in run.stdout:
                done += line.split("/")[0].isidentifier() and "/" in line
                show(title, done, count, begin)
            listener.join()
        end_line(title, begin)
        if run.returncode != 0:
            part.unlink(missing_ok=True)
            sys.exit(f"perf_report: {program} failed: {''.join(said[-5:])}")
        wrong = [run for run in json.loads(part.read_text())["benchmarks"] if run.get("error_occurred")]
        if wrong:
            part.unlink()
            sys.exit(f"perf_report: {program}: {wrong[0]['name']}: {wrong[0]['error_message']}")
        # Whole or not there: an interrupted run is run again.
        stamp(part, [*self.context, f"seconds={time.monotonic() - begin:.1f}", f"loop_before={loop_before}",
                     f"loop_after={fixed_loop()}", f"load_after={os.getloadavg()[0]:.2f}"])
        part.rename(self.results / f"{program}.json")


def show(title, done, count, begin):
    """A bar on a terminal."""
    if not sys.stderr.isatty():
        return
    width = 30
    filled = width * done // max(count, 1)
    print(f"\r{title:<24} [{'#' * filled}{'.' * (width - filled)}] {done}/{count} {time.monotonic() - begin:4.0f} s ",
          end="", file=sys.stderr, flush=True)


def end_line(title, begin):
    print(f"\r\033[K{title} {time.monotonic() - begin:.0f} s" if sys.stderr.isatty() else
          f"{title} {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
