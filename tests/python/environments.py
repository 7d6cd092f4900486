"""How the tests of packages run Python: Debian's, without the modules and the library that a build offers."""

import os
import subprocess

PYTHON = "/usr/bin/python3"
OF_A_BUILD = ("PYTHONPATH", "IST_LIBRARY", "LD_LIBRARY_PATH")


def clean_environment(**more):
    kept = {name: value for name, value in os.environ.items() if name not in OF_A_BUILD}
    return {**kept, **{name: str(value) for name, value in more.items()}}


def tries(*command, **environment):
    """A command that may fail, with its output as text."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False,
                          env=clean_environment(**environment))
