"""How the tests of packages run commands, and how they fail."""

import os
import shutil
import subprocess
import sys


class Missing(Exception):
    """A tool is not installed, so there is nothing to test with."""


def run(*command, **options):
    """What a command prints. Where it fails, the test does, and shows all of it."""
    ran = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    if ran.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nfailed with {ran.returncode}:\n{ran.stdout}{ran.stderr}")
    return ran.stdout


def require(holds, text):
    if not holds:
        sys.exit(f"packages: {text}")


def need(*tools):
    for tool in tools:
        if shutil.which(tool) is None:
            raise Missing(f"{tool} is not installed: scripts/setup.sh --package does that")


def ends(test):
    """The exit code of a test: 77 where what it needs is not installed, 1 then with IST_REQUIRE_ALL=1."""
    try:
        test()
    except Missing as missing:
        print(f"packages: skipped: {missing}", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77
    return 0
