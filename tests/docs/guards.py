"""Checks that each invariant of HACKING names a test, that the tests it names exist, and the presets that the page names; and that
each guarantee of docs/guarantees.md names tests that exist and a mutant that a test killed. The argument is the build folder."""

import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
from mutants import MUTANTS  # noqa: E402  after its folder is known

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


def cells_of(text, heading):
    """The cells of the rows of the table under a heading."""
    section = text.split(f"\n### {heading}\n")[1].split("\n##")[0]
    rows = [line.strip("|").split("|") for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows[2:]]


PROOF = "a proof at compile time"


def begins(test, name):
    """Whether a test is the one of that name, or of that suite, or has a name that begins so behind the suite's."""
    return test == name or test.startswith((name + ".", name + "/")) or "." in name and test.startswith(name)


def flaws_of_guarantees(text, tests, mutants, killed):
    """The errors in the table of guarantees, and how many tests it names. A test is named by its whole name or by how it begins.
    `killed` has the test that killed a mutant: one of its row, or a proof at compile time."""
    wrong, named = [], 0
    for guarantee, guards, mutant in cells_of(text, "Each guarantee, its tests, and a mutant that they kill"):
        if not guarantee:
            wrong.append("a row states no guarantee")
        for cell, what in ((guards, "test"), (mutant, "mutant")):
            if not re.fullmatch(r"`[\w/.-]+`(, `[\w/.-]+`)*", cell):
                wrong.append(f"'{guarantee}' names no {what}: {cell}")
        names = re.findall(r"`([^`]*)`", guards)
        for name in names:
            named += 1
            if not any(begins(test, name) for test in tests):
                wrong.append(f"'{guarantee}' names {name}, and there is no such test")
        for name in re.findall(r"`([^`]*)`", mutant):
            if name not in mutants:
                wrong.append(f"'{guarantee}' names {name}, and there is no such mutant")
            elif name not in killed:
                wrong.append(f"'{guarantee}' names {name}, and no test has killed it: scripts/mutate.py {name}")
            elif killed[name] != PROOF and names and not any(begins(killed[name], test) for test in names):
                wrong.append(f"'{guarantee}' names {name}, and {killed[name]} killed it, none of its tests")
    return wrong, named


def cases_of(folder):
    """The tests of every GoogleTest program in a folder, as Suite.Case."""
    found = set()
    for program in folder.glob("*_test"):
        if program.name != "ist_c11_test":
            said = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
            suite = ""
            for line in said.splitlines():
                suite = suite if line.startswith(" ") else line.split()[0]
                if line.startswith("  "):
                    found.add(suite + line.split()[0])
    return found


def main():
    listed = subprocess.run(["ctest", "--test-dir", sys.argv[1], "-N"], capture_output=True, text=True, check=True).stdout
    tests = set(re.findall(r"(?m)^ *Test +#\d+: (\S+)", listed)) | cases_of(pathlib.Path(sys.argv[1]) / "tests")
    suites = {name.split(".")[0] for name in tests}
    presets = {each["name"] for each in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]}
    wrong, guards = flaws((ROOT / "HACKING.md").read_text(), suites, presets)
    ran = json.loads((ROOT / "perf/results/mutants.json").read_text())
    killed = {name: row["killed_by"] for name, row in ran.items() if row["killed_by"]}
    broken, named = flaws_of_guarantees((ROOT / "docs/guarantees.md").read_text(), tests, {mutant.name for mutant in MUTANTS}, killed)
    for page, lines in (("HACKING.md", wrong), ("docs/guarantees.md", broken)):
        for line in lines:
            print(f"{page}: {line}", file=sys.stderr)
    print(f"{guards} and {named} tests named, {len(wrong) + len(broken)} wrong")
    return 1 if wrong or broken or guards == 0 or named == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
