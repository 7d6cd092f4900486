"""Checks that each invariant of HACKING names a test, and that the tests it names exist. The argument is the build folder."""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def main():
    listed = subprocess.run(["ctest", "--test-dir", sys.argv[1], "-N"], capture_output=True, text=True, check=True).stdout
    suites = {name.split(".")[0] for name in re.findall(r"(?m)^ *Test +#\d+: (\S+)", listed)}
    section = (ROOT / "HACKING.md").read_text().split("\n## What must stay true\n")[1].split("\n## ")[0]
    wrong, guards = [], 0
    for invariant in re.split(r"(?m)^- (?=\*\*)", section)[1:]:
        title = re.match(r"\*\*(.*?)\*\*", invariant)[1]
        names = re.match(r"\*\*.*?\*\*[^`]*((?:`[A-Z][\w/]*`(?:, )?)*)", invariant, re.S)[1]
        named = re.findall(r"`([^`]*)`", names)
        guards += len(named)
        if not named:
            wrong.append(f"'{title}' names no test")
        wrong += [f"'{title}' names {name}, and there is no such test" for name in named if name not in suites]
    for line in wrong:
        print(f"HACKING.md: {line}", file=sys.stderr)
    print(f"{guards} tests named, {len(wrong)} wrong")
    return 1 if wrong or guards == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
