"""This machine, the names of what results on it are made with, and the builds that programs are measured of."""

import json
import os
import pathlib
import re
import subprocess
import sys
from typing import NamedTuple

from report.figures import ROOT, here


class Machine(NamedTuple):
    model: str  # the processor
    compiler: str
    commit: str  # ends in + if files that are compiled differ from it
    results: pathlib.Path  # the folder of raw results; its name is the processor and its cores
    context: list  # of the benchmarks: each as name=value


def machine():
    def number(name):
        found = re.search(rf"^{name}[^:\n]*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
        return found[1] if found else ""

    model, family = number("model name") or os.uname().machine, number("cpu family")
    compiler = subprocess.run(["g++", "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    commands, flags = ROOT / "build/bench/compile_commands.json", ""
    if commands.exists():
        command = next((each["command"] for each in json.loads(commands.read_text()) if each["file"].endswith("/triangle_search.cpp")), "")
        flags = " ".join(word for word in command.split() if re.match("-(O|f|m|std=|DNDEBUG)", word) and "-prefix-map=" not in word)
    # Processors of one name differ: their family and model tell them apart.
    kind = f" (family {family}, model {number('model' + chr(9))})" if family else ""
    commit, cores = here()[0], len(os.sched_getaffinity(0))
    folder = pathlib.Path("perf/results", re.sub("[^A-Za-z0-9]+", "-", model).rstrip("-") + f"-{cores}")
    return Machine(model, compiler, commit, folder, [f"processor={model}{kind}", f"compiler={compiler}", f"flags={flags}", f"commit={commit}"])


def run(*command, **options):
    """Runs a command; its output goes to stderr. Ends the program if the command fails."""
    done = subprocess.run([str(word) for word in command], cwd=ROOT, stdout=sys.stderr, **options)
    if done.returncode != 0:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {' '.join(map(str, command))} ends with {done.returncode}")


def output(*command):
    """Returns a finished command, with its `stdout` and `stderr`. Ends the program if the command fails."""
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True)
    if done.returncode != 0:
        said = (done.stdout + done.stderr)[-3000:]
        sys.exit(f"{pathlib.Path(sys.argv[0]).stem}: {' '.join(map(str, command))} ends with {done.returncode}:\n{said}")
    return done


def build(preset, *targets, needs):
    """Installs the packages of scripts/setup.sh for `needs`, and builds targets of a preset, or all targets. Makes the project's folder the
    current one."""
    os.chdir(ROOT)
    run("scripts/setup.sh", *needs)
    run("cmake", "--preset", preset)
    run("cmake", "--build", "--preset", preset, *(["--target", *targets] if targets else []))


def refuse(words, doc):
    """Prints a script's help and ends, if the words ask for it, or are more than the script takes."""
    if words:
        print(doc.strip(), file=sys.stdout if words[0] in ("-h", "--help") else sys.stderr)
        sys.exit(0 if words[0] in ("-h", "--help") else 2)
