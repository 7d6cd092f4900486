"""Checks that each invariant of HACKING names a test, that the tests it names exist, and the presets that the page names. The
argument is the build folder."""

import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# After the title, and a remark on it: names that commas separate, also at the end of a line.
NAMES = re.compile(r"\*\*.*?\*\*[^`]*((?:`[A-Z][\w/]*`(?:,\s+)?)*)", re.S)
PRESETS = re.compile(r"[Pp]resets?:?\s+((?:`\w+`(?:,?\s+|,?\s+and\s+)?)+)")


def flaws(text, suites, presets):
    """The errors in the text of HACKING, and how many tests it names."""
    section = text.split("\n## What must stay true\n")[1].split("\n## ")[0]
    wrong = [f"this stands under no title, which is bold: {line}" for line in re.findall(r"(?m)^- (?!\*\*).*", section)]
    guards = 0
    for invariant in re.split(r"(?m)^- (?=\*\*)", section)[1:]:
        title = re.match(r"\*\*(.*?)\*\*", invariant)[1]
        named = re.findall(r"`([^`]*)`", NAMES.match(invariant)[1])
        guards += len(named)
        if not named:
            wrong.append(f"'{title}' names no test")
        wrong += [f"'{title}' names {name}, and there is no such test" for name in named if name not in suites]
    for listed in PRESETS.findall(text):
        wrong += [f"there is no preset {name}" for name in re.findall(r"`(\w+)`", listed) if name not in presets]
    return wrong, guards


def main():
    listed = subprocess.run(["ctest", "--test-dir", sys.argv[1], "-N"], capture_output=True, text=True, check=True).stdout
    suites = {name.split(".")[0] for name in re.findall(r"(?m)^ *Test +#\d+: (\S+)", listed)}
    presets = {each["name"] for each in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]}
    wrong, guards = flaws((ROOT / "HACKING.md").read_text(), suites, presets)
    for line in wrong:
        print(f"HACKING.md: {line}", file=sys.stderr)
    print(f"{guards} tests named, {len(wrong)} wrong")
    return 1 if wrong or guards == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
