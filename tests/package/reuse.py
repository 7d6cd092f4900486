"""Stands before the compiler (CMAKE_CXX_COMPILER_LAUNCHER) where the library is built once more, in another
project: what would be compiled by the same command as in the build that is tested, but for warnings and
folders, is taken from there. All else is compiled, and noted in a file of the build.

    reuse.py TESTED_BUILD THIS_BUILD COMPILER ARGUMENT…"""

import json
import pathlib
import shlex
import shutil
import subprocess
import sys


def meaning(arguments, build):
    """The meaning of a command: its words without outputs and warnings, and without the build's place. Without -m
    flags Eigen aligns by 16 bytes, told or not."""
    words, rest = [], iter(arguments)
    for word in rest:
        if word in ("-o", "-MT", "-MF"):
            next(rest)
        elif word not in ("-MD", "-DEIGEN_MAX_ALIGN_BYTES=16") and not word.startswith("-W"):
            words.append(word.replace(str(build), "@"))
    return words


def same_source(a, b):
    return a == b or (a.exists() and b.exists() and a.read_bytes() == b.read_bytes())


def find(tested, build, command):
    """The object that the same command made, or nothing."""
    mine = meaning(command, build)
    source = pathlib.Path(command[-1])
    for entry in json.loads((tested / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        words = words[words.index(command[0]):] if command[0] in words else words
        if meaning(words, tested) == mine and same_source(pathlib.Path(entry["file"]), source):
            made = pathlib.Path(entry["directory"], words[words.index("-o") + 1])
            return made if made.exists() else None
    return None


def main(tested, build, *command):
    tested, build = pathlib.Path(tested), pathlib.Path(build)
    made = find(tested, build, command)
    if made is not None:
        shutil.copy(made, command[command.index("-o") + 1])
        return 0
    with open(build / "compiled", "a", encoding="utf-8") as compiled:
        print(pathlib.Path(command[-1]).name, file=compiled)
    return subprocess.run(command, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
