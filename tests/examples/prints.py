"""Fails unless a command ends with 0 and prints the text of a file.

    prints.py FILE COMMAND [ARGUMENT …]

If Debian's Python lacks numpy, a program in Python is skipped: the exit code is 77, or 1 with IST_REQUIRE_ALL=1."""

import difflib
import os
import pathlib
import subprocess
import sys


def main(file, *command):
    expected = pathlib.Path(file).read_text()
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if "No module named 'numpy'" in ran.stderr:
        print("skipped: /usr/bin/python3 has no numpy: scripts/setup.sh --oracles installs it", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77
    print(ran.stderr, end="", file=sys.stderr)
    if ran.returncode != 0:
        print(f"it ended with {ran.returncode}", file=sys.stderr)
    lines = difflib.unified_diff(expected.splitlines(), ran.stdout.splitlines(), file, "printed", lineterm="")
    print("\n".join(lines), end="")
    return 0 if ran.returncode == 0 and ran.stdout == expected else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
