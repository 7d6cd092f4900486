"""Figures know their commit: the stamp beside each table, and whether the sources that it rests on have changed since.

A stamp is one line below a table:

    Measured at commit `0123456` on 2026-11-23 by `ablation_bench`; its code was the same when this was written. …

scripts/check_figures.sh reads the stamps again, and names those whose sources have changed by now.
"""

import datetime
import json
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).parents[2]
# What every query rests on.
QUERY = ["simd", "src/ist/base", "src/ist/query", "src/ist/tree", "src/ist/voxel"]
LOOP = [*QUERY, "src/ist/haptics", "src/ist/scene"]
# What figures rest on, by the benchmark or the script that makes them, beside a benchmark's own files.
RESTS = {
    "accuracy_bench": [*QUERY, "src/ist/measure"],
    "advise_bench": [*QUERY, "src/advise"],
    "build_bench": ["src/ist/base", "src/ist/mesh", "src/ist/tree", "src/ist/voxel"],
    "coherent_bench": LOOP,
    "hardware_bench": ["src/hardware", "src/ist/tree", "src/ist/voxel"],
    "hardware_report.sh": ["scripts/hardware", "src/hardware"],
    "haptics_bench": LOOP,
    "loop_bench": LOOP,
    "measure_bench": [*QUERY, "src/ist/measure"],
    "calls.py": ["bench/python", "src/ist/capi", "src/python/ist"],
    "ist bench": [*QUERY, "src/advise", "src/cli/bench", "src/cli/commands/bench.cpp", "src/cli/engine.cpp", "src/ist/models"],
    "mutate.sh": ["scripts/mutants", "simd", "src", "tests"],
    "stability_border.sh": ["bench/stability_border.cpp", *QUERY, "src/ist/haptics", "tests/haptics/wall_press.cpp"],
    "stability_report.sh": ["simd", "src/ist", "tests/fuzz", "tests/query", "tests/stability"],
    "target_instructions.py": [*QUERY, "tests/instructions"],
    "viewer_ratio.mjs": [*QUERY, "src/cli/engine.cpp", "src/viewer/engine/pair.cpp"],
}
STAMP = re.compile(r"Measured at commit `([0-9a-f]+\+?)` on (\d{4}-\d\d-\d\d) by `([\w. ]+)`")
# Figures that cannot be stale: a test repeats them in every run.
REPEATED = re.compile(r"Repeated by the test `[\w.]+`")
# Pages of results: each of their tables needs a stamp, or the test that repeats it.
PAGES = ["README.md", "docs/performance.md", "perf/HAPTIC_STABILITY.md", "perf/HARDWARE.md", "perf/MUTANTS.md",
         "perf/REPORT.md", "perf/STABILITY.md"]


# The figure that the page itself shows, as JSON: its commit, and who makes it.
SHOWN = ("src/viewer/page/native_ratio.json", "viewer_ratio.mjs")


def shown_commit():
    return json.loads((ROOT / SHOWN[0]).read_text())["commit"]


def git(*arguments):
    """Returns what git prints, or None where it fails: no history, or no such commit."""
    # Files of any kind are compared: each byte is a character.
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, encoding="latin-1")
    return done.stdout if done.returncode == 0 else None


def has_history():
    return git("rev-parse", "--is-shallow-repository") == "false\n"


def is_commit(name):
    return git("cat-file", "-e", f"{name}^{{commit}}") is not None


def here():
    """The commit of the working tree, with a + where files that are compiled differ from it, and the date of today."""
    commit = (git("rev-parse", "--short=7", "HEAD") or "0000000+\n").strip()
    changed = git("diff", "--quiet", "HEAD", "--", "CMakeLists.txt", "CMakePresets.json", "src", "simd", "tests", "bench") is None
    return commit.rstrip("+") + ("+" if changed else ""), datetime.date.today().isoformat()


def sources_of(maker):
    """The folders and files that the figures of a benchmark or a script rest on."""
    stem = maker.removesuffix("_bench")
    own = [f"bench/{maker}.cpp", f"bench/{stem}", "bench/support"] if stem != maker else []
    if stem == maker and maker not in RESTS:
        raise ValueError(f"{maker} makes no figures")
    return sorted(RESTS.get(maker, QUERY) + [path for path in own if (ROOT / path).exists()])


def code_of(text, name):
    """The text without comments and without the space between words, where it is code; of other files the text as it is."""
    if not name.endswith((".h", ".cpp", ".c")):
        return text
    string = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    without = re.sub(rf"({string})|//[^\n]*|/\*.*?\*/", lambda found: found.group(1) or " ", text, flags=re.S)
    return " ".join(without.split())


def changed_since(commit, paths):
    """Returns the files among `paths` whose code is another in the working tree than at a commit, in order of name. Comments and
    texts about the code do not count."""
    names = git("diff", "--name-only", commit, "--", *paths)
    if names is None:
        raise ValueError(f"{commit} is no commit of this history")
    found = []
    for name in names.splitlines():
        if name.endswith(".md"):
            continue
        now = ROOT / name
        before = git("show", f"{commit}:{name}")
        if before is None or not now.exists() or code_of(before, name) != code_of(now.read_text("latin-1"), name):
            found.append(name)
    return found


def rooms(files, sources):
    """Those of the sources that hold some of the files: `simd`, `src/ist/query`."""
    return ", ".join(f"`{source}`" for source in sources if any(file == source or file.startswith(source + "/") for file in files))


def stamp(commit, date, maker, more=""):
    """Returns the line for the foot of a table that a benchmark or a script measured at a commit."""
    if commit.endswith("+"):
        state = "**with changes that no commit holds**"
    elif not has_history():
        state = "and no history was here to say whether its code has changed since"
    elif not is_commit(commit):
        state = "**a commit that this history does not have**"
    else:
        sources = sources_of(maker)
        changed = changed_since(commit, sources)
        state = f"**its code has changed since**, in {rooms(changed, sources)}" if changed else "its code was the same when this was written"
    return f"Measured at commit `{commit}` on {date} by `{maker}`; {state}.{' ' + more if more else ''}"


def stamped(lines, line):
    """Returns the lines with one more below each table."""
    made = []
    for this, after in zip(lines, [*lines[1:], ""]):
        made.append(this)
        if this.startswith("|") and not after.startswith("|"):
            made += ["", line]
    return made


def machine_state(context):
    """Returns a sentence on the machine before and after a run: its load, and the time of a fixed loop."""
    load = context.get("load_avg", [])
    before = f"{load[0]:.1f}" if load else "unknown"
    on = f"On {context['processor']}. " if "processor" in context else ""
    if "loop_before" not in context:
        return f"{on}Load {before} before."
    return (f"{on}Load {before} before, {float(context['load_after']):.1f} after; a fixed loop took {context['loop_before']} µs before and "
            f"{context['loop_after']} µs after.")


def stamps_in(page):
    """Yields (line number, commit, maker) of each stamp on a page."""
    for number, line in enumerate((ROOT / page).read_text().splitlines(), 1):
        for found in STAMP.finditer(line):
            yield number, found.group(1), found.group(3)


def tables_in(page):
    """Yields the line number of each table on a page, and whether its figures name their commit: by a stamp below it, before the
    next table or heading, or row by row."""
    lines = (ROOT / page).read_text().splitlines()
    begins = [i for i, line in enumerate(lines) if line.startswith("|") and (i == 0 or not lines[i - 1].startswith("|"))]
    for begin in begins:
        below = begin
        while below < len(lines) and lines[below].startswith("|"):
            below += 1
        stamped = "| commit |" in lines[begin]
        for line in lines[below:]:
            if line.startswith(("|", "#")):
                break
            stamped = stamped or STAMP.search(line) is not None or REPEATED.search(line) is not None
        yield begin + 1, stamped
