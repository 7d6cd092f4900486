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

from report import flags

ROOT = pathlib.Path(__file__).parents[2]


def both(stem):
    """A source and its header."""
    return [f"{stem}.cpp", f"{stem}.h"]


# What every query rests on.
PREDICATES = [*both("src/ist/mesh/orientation"), *both("src/ist/mesh/triangles_meet"), "src/ist/mesh/whole_number.h"]
QUERY = ["simd", "src/ist/base", "src/ist/mesh/clusters", "src/ist/mesh/mesh.h", *PREDICATES, "src/ist/query", "src/ist/tree", "src/ist/voxel"]
MEASURE = [*QUERY, "src/ist/measure", "src/ist/mesh/bounding_box.h", *both("src/ist/mesh/nearest_point"), *both("src/ist/mesh/pseudonormals"),
           *both("src/ist/mesh/self_intersections"), *both("src/ist/mesh/surface_sides"), *both("src/ist/mesh/winding_number")]
LOOP = [*QUERY, "src/ist/haptics", "src/ist/scene"]
SHAPES = ["src/ist/models", *both("tests/support/shapes")]
# What figures rest on, by the benchmark or the script that makes them, beside a benchmark's own files. A benchmark's bodies come
# from files or from built-in models, by readers that are not timed.
RESTS = {
    "ablation_bench": [*QUERY, "src/verify"],
    "accuracy_bench": [*MEASURE, *SHAPES, "src/ist/haptics", "src/verify", *both("tests/query/contacts/closed_forms"),
                       "tests/query/contacts/contact_cases.h", *both("tests/query/contacts/form_errors"), *both("tests/query/query_cases"),
                       *both("tests/support/random")],
    "advise_bench": [*QUERY, "src/advise"],
    "build_bench": ["src/ist/base", "src/ist/mesh", "src/ist/tree", "src/ist/voxel"],
    "coherent_bench": LOOP,
    "deadline_bench": [*QUERY, *SHAPES, *both("tests/support/conformal")],
    "hardware_bench": ["src/hardware", "src/ist/query/query_rules.h", "src/ist/tree", "src/ist/voxel", "tests/hardware/node_pair.h",
                       "tests/hardware/pair_walk.h"],
    "hardware_report.sh": ["scripts/hardware", "src/hardware"],
    "haptics_bench": LOOP,
    "loop_bench": LOOP,
    "measure_bench": MEASURE,
    "peers_bench": [*MEASURE, "src/cli/bench/rivals.h"],
    "scaling_bench": [*QUERY, *SHAPES, *both("tests/support/conformal")],
    "seed_bench": [*QUERY, "src/ist/mesh/bounding_box.h"],
    "sweep_bench": [*MEASURE, "bench/python/sweep_loop.py", "src/ist/capi", "src/ist/sweep", "src/python/ist"],
    "world_bench": [*QUERY, "src/ist/models"],
    "calls.py": [*MEASURE, "bench/python", "src/ist/capi", "src/python/ist"],
    "ist bench": [*QUERY, "src/advise", "src/cli/bench", "src/cli/commands/bench.cpp", "src/cli/engine.cpp", "src/ist/models"],
    "mutate.sh": ["scripts/mutants", "scripts/report", "scripts/try.py", "examples", "simd", "src", "tests"],
    "stability_border.sh": ["bench/stability_border.cpp", *QUERY, "src/ist/haptics", "tests/haptics/wall_press.cpp"],
    "stability_report.sh": ["simd", "src/cli", "src/ist", "src/verify",
                            *(f"tests/{room}" for room in ("capi", "cli", "fuzz", "query", "scene", "simd", "stability", "support"))],
    "target_instructions.py": [*QUERY, "tests/instructions"],
    "viewer_ratio.mjs": [*QUERY, "src/cli/engine.cpp", "src/viewer/engine/pair.cpp"],
}
# The presets that build what makes them, where these are not that of the benchmarks.
PRESETS = {"calls.py": ["release"], "hardware_report.sh": [], "ist bench": ["release"], "mutate.sh": [], "stability_report.sh": ["test"],
           "target_instructions.py": ["arm64", "release"], "viewer_ratio.mjs": ["release", "wasm"]}
# Those that count, and time nothing: a count is the same on every machine, whatever else runs there.
COUNTERS = {"hardware_bench", "hardware_report.sh", "mutate.sh", "stability_border.sh", "stability_report.sh", "target_instructions.py"}
STAMP = re.compile(r"Measured at commit `([0-9a-f]+\+?)` on (\d{4}-\d\d-\d\d) by `([\w. ]+)`")
# Of figures that are times: the machine's, beside the stamp.
STATE = re.compile(r"Load [\d.]+ before, [\d.]+ after; a fixed loop took [\d.]+")
# Figures that cannot be stale: a test repeats them in every run.
REPEATED = re.compile(r"Repeated by the test `([\w.]+)`")
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
    """Whether the folder has a history of its own, and all of it. A copy inside of a repository has none."""
    shallow, top = (git("rev-parse", "--is-shallow-repository", "--show-toplevel") or "\n\n").splitlines()[:2]
    return shallow == "false" and pathlib.Path(top).resolve() == ROOT.resolve()


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
    own = ["bench/CMakeLists.txt", f"bench/{maker}.cpp", f"bench/{stem}", "bench/support"] if stem != maker else []
    if stem == maker and maker not in RESTS:
        raise ValueError(f"{maker} makes no figures")
    compiled = flags.FILES if presets_of(maker) else []
    return sorted({*RESTS.get(maker, QUERY), *(path for path in [*own, *compiled] if (ROOT / path).exists())})


def presets_of(maker):
    return PRESETS.get(maker, ["bench"])


def code_of(text, name):
    """The text without comments and without the space between words, where it is code; of other files the text as it is."""
    if not name.endswith((".h", ".cpp", ".c")):
        return text
    string = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    without = re.sub(rf"({string})|//[^\n]*|/\*.*?\*/", lambda found: found.group(1) or " ", text, flags=re.S)
    return " ".join(without.split())


def texts_at(commit, names):
    """By name, the text of each file at a commit, or None where it was not there: by one process, for thousands are asked for."""
    done = subprocess.run(["git", "-C", ROOT, "cat-file", "--batch"], input="".join(f"{commit}:{name}\n" for name in names).encode("latin-1"),
                          capture_output=True, check=True).stdout
    texts, at = {}, 0
    for name in names:
        end = done.index(b"\n", at)
        head, at = done[at:end], end + 1
        if head.endswith(b" missing"):
            texts[name] = None
        else:
            size = int(head.split()[-1])
            texts[name], at = done[at:at + size].decode("latin-1"), at + size + 1
    return texts


def changed_since(commit, maker):
    """Returns the files that the figures of a maker rest on whose code is another in the working tree than at a commit, in order
    of name. Comments and texts about the code do not count, nor the figure that the page shows, nor CMake's files but for the flags in
    them."""
    def code(text):
        return flags.of(name, text, presets_of(maker)) if name in flags.FILES else code_of(text, name)

    names = git("diff", "--name-only", commit, "--", *sources_of(maker))
    if names is None:
        raise ValueError(f"{commit} is no commit of this history")
    found, names = [], [name for name in names.splitlines() if not name.endswith(".md") and name != SHOWN[0]]
    for name, before in texts_at(commit, names).items():
        now = ROOT / name
        if before is None or not now.exists() or code(before) != code(now.read_bytes().decode("latin-1")):
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
        changed = changed_since(commit, maker)
        state = (f"**its code has changed since**, in {rooms(changed, sources_of(maker))}" if changed else
                 "its code was the same when this was written")
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
    missing = [name for name in ("load_avg", "load_after", "loop_before", "loop_after") if not context.get(name)]
    if missing:
        raise ValueError(f"results that are times say nothing of {', '.join(missing)}: measure them again")
    on = f"On {context['processor']}. " if "processor" in context else ""
    return (f"{on}Load {context['load_avg'][0]:.1f} before, {float(context['load_after']):.1f} after; a fixed loop took "
            f"{context['loop_before']} µs before and {context['loop_after']} µs after.")


def is_test(name):
    """Whether ctest knows a test by that name: one that CMake adds, or a case of a suite."""
    suite, _, case = name.rpartition(".")
    added = re.compile(rf"(?:add_test\(\s*NAME |ist_add_command\(){re.escape(name)}\s")
    written = re.compile(rf"\bTEST(_F)?\({suite},\s*{case}\)")
    tests = ROOT / "tests"
    return (any(added.search(file.read_text()) for file in tests.rglob("CMakeLists.txt")) or
            bool(suite) and any(written.search(file.read_text()) for file in tests.rglob("*.cpp")))


def cells(line):
    return [cell.strip(" `") for cell in line.strip().strip("|").split("|")]


def stamps_in(page):
    """Yields (line number, commit, maker) of each stamp on a page, and of each row that names its program and its commit."""
    columns = None
    for number, line in enumerate((ROOT / page).read_text().splitlines(), 1):
        for found in STAMP.finditer(line):
            yield number, found.group(1), found.group(3)
        if not line.startswith("|"):
            columns = None
        elif columns is None:
            columns = cells(line)
        elif {"program", "commit"} <= set(columns) and not line.startswith("|-"):
            row = dict(zip(columns, cells(line)))
            yield number, row["commit"], row["program"]


def tables_in(page):
    """Yields the line number of each table on a page, and whether its figures name their commit: by a stamp below it, before the
    next table or heading, or row by row; or a test that there is repeats them."""
    lines = (ROOT / page).read_text().splitlines()
    begins = [i for i, line in enumerate(lines) if line.startswith("|") and (i == 0 or not lines[i - 1].startswith("|"))]
    for begin in begins:
        below = begin
        while below < len(lines) and lines[below].startswith("|"):
            below += 1
        stamped = {"program", "commit"} <= set(cells(lines[begin]))
        for line in lines[below:]:
            if line.startswith(("|", "#")):
                break
            repeated = REPEATED.search(line)
            stamped = stamped or STAMP.search(line) is not None or repeated is not None and is_test(repeated.group(1))
        yield begin + 1, stamped
