"""Tests of packages run Debian's Python by this module, without the modules and the library that a build offers. It lists the files
that a wheel, an sdist and the Debian package hold."""

import os
import pathlib
import subprocess

PYTHON = "/usr/bin/python3"
OF_A_BUILD = ("PYTHONPATH", "IST_LIBRARY", "LD_LIBRARY_PATH")
SOURCE = pathlib.Path(__file__).resolve().parents[2]
# Others' code in the library that a wheel holds, and the project's: each has a licence there.
PARTS = ["Eigen", "Highway", "IST", "fmt", "nlohmann-json", "toml++", "xxHash", "zlib"]
LICENCES = [f"licences/{part}.txt" for part in PARTS]


def clean_environment(**more):
    kept = {name: value for name, value in os.environ.items() if name not in OF_A_BUILD}
    return {**kept, **{name: str(value) for name, value in more.items()}}


def tries(*command, **environment):
    """A command that may fail, with its output as text."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                          env=clean_environment(**environment))


def modules():
    folder = SOURCE / "src/python"
    return sorted(str(file.relative_to(folder)) for file in (folder / "ist").rglob("*")
                  if file.suffix in (".py", ".pyi") or file.name == "py.typed")
