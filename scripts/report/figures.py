"""Figures know their commit: the stamp beside each table, and whether the sources that it rests on have changed since.

A stamp is one line below a table:

    Measured at commit `0123456` on 2026-11-23 by `ablation_bench`. …

scripts/check_figures.sh reads the stamps again, and names those whose sources have changed by now.
"""

import datetime
import functools
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[2]


FOLDERS = ("src", ".", "bench", "tests", *(f"src/{library}/include" for library in ("c", "hardware", "loop", "models")))  # for the headers
# The first sources and folders of figures, by the script or the benchmark that makes them, beside a benchmark's own files. The figures also rest
# on the folder of each file of src and simd that these include, directly or not, and on the other files that these include.
BEGINS = {
    "calls.py": ["bench/python", "src/c", "src/python/ist"],
    "hardware_report.py": ["scripts/hardware", "src/hardware"],
    "ist bench": ["src/cli/commands/bench.cpp", "src/advise/closing_path.cpp", "src/models"],
    "mutate.py": ["examples", "scripts/mutants", "scripts/report", "scripts/bench_compare.py", "scripts/try.py", "simd", "src", "tests"],
    "stability_border.py": ["bench/stability_border.cpp", "tests/haptics/wall_press.cpp"],
    "stability_report.py": ["simd", "src/answers", "src/c", "src/cli", "src/ist", "src/loop", "src/models", "src/sweep", "src/verify",
                            *(f"tests/{room}" for room in ("capi", "cli", "fuzz", "query", "scene", "simd", "stability", "support"))],
    "sweep_bench": ["bench/python/sweep_loop.py", "src/c", "src/python/ist"],
    "target_instructions.py": ["tests/instructions"],
    "viewer_ratio.mjs": ["src/answers/engine.cpp", "src/viewer/engine/pair.cpp"],
}
# Those that no compiler of this project makes.
UNCOMPILED = {"hardware_report.py", "mutate.py"}
# Files of CMake. Their flags decide the compiled code; warnings, names of folders and exceptions from sanitizers do not.
FLAGGED = ["CMakeLists.txt", "CMakePresets.json", "bench/CMakeLists.txt", "src/library.cmake", "src/platform.cmake",
           *(f"src/{library}/CMakeLists.txt" for library in ("ist", "loop", "models", "sweep"))]
FLAG = re.compile(r"(?<![\w-])-[OfmDs][\w=+,.-]*|CMAKE_(?:BUILD_TYPE|CXX_\w*FLAGS\w*|CXX_STANDARD|INTERPROCEDURAL_\w+)\W+\w+")
IDLE = re.compile(r"-f\w+-prefix-map|-fno-sanitize|-fsanitize")
# Those that count, and time nothing: a count is the same on every machine, whatever else runs there.
COUNTERS = {"hardware_bench", "hardware_report.py", "mutate.py", "stability_border.py", "stability_report.py", "target_instructions.py"}
STAMP = re.compile(r"Measured at commit `([0-9a-f]+\+?)` on (\d{4}-\d\d-\d\d) by `([\w. ]+)`")
# The state of the machine, beside the stamp of figures that are times.
STATE = re.compile(r"Load [\d.]+ before, [\d.]+ after; a fixed loop took [\d.]+")
# Figures that cannot be stale: a test repeats them in every run.
REPEATED = re.compile(r"Repeated by the test `([\w.]+)`")
# Pages of results: each of their tables needs a stamp, or the test that repeats it.
PAGES = ["README.md", "docs/performance.md", "perf/HAPTIC_STABILITY.md", "perf/HARDWARE.md", "perf/MUTANTS.md", "perf/REPORT.md", "perf/STABILITY.md"]
# The figure that the page itself shows, as JSON: its commit, and who makes it.
SHOWN = ("src/viewer/page/native_ratio.json", "viewer_ratio.mjs")


def shown_commit():
    return json.loads((ROOT / SHOWN[0]).read_text())["commit"]


def git(*arguments):
    """Returns the output of git, or None if it fails: no history, or no such commit."""
    # Files of any kind are compared: each byte is a character.
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, encoding="latin-1")
    return done.stdout if done.returncode == 0 else None


def has_history():
    """Tells whether the folder has a whole history of its own. A copy inside of a repository does not have its own history."""
    shallow, top = (git("rev-parse", "--is-shallow-repository", "--show-toplevel") or "\n\n").splitlines()[:2]
    return shallow == "false" and pathlib.Path(top).resolve() == ROOT.resolve()


def is_commit(name):
    return git("cat-file", "-e", f"{name}^{{commit}}") is not None


def here():
    """The commit of the working tree, with a + if files that are compiled differ from it, and the date of today."""
    commit = (git("rev-parse", "--short=7", "HEAD") or "0000000+\n").strip()
    changed = git("diff", "--quiet", "HEAD", "--", "CMakeLists.txt", "CMakePresets.json", "src", "simd", "tests", "bench") is None
    return commit.rstrip("+") + ("+" if changed else ""), datetime.date.today().isoformat()


def included(begins):
    """The project's files that sources include, directly or not, with the source beside each header, and the room that a header names."""
    waiting = [file for begin in map(ROOT.joinpath, begins) for file in (begin.rglob("*.*") if begin.is_dir() else [begin])]
    seen = set()
    while waiting:
        file = waiting.pop()
        if file in seen or file.suffix not in (".h", ".cpp") or not file.is_file():
            continue
        seen.add(file)
        source = pathlib.Path(str(file).replace("/include/ist/", "/"))  # of a public header
        waiting += [file.with_suffix(".h"), source.with_suffix(".cpp"), *source.with_suffix("").glob("*.*")]
        for name in re.findall(r'^ *# *include "([^"]+)"', file.read_text(), re.M):
            waiting += [folder / name for folder in (file.parent, *map(ROOT.joinpath, FOLDERS)) if (folder / name).is_file()][:1]
    return {file.relative_to(ROOT) for file in seen}


def sources_of(maker):
    """The folders and files that the figures of a benchmark or a script rest on."""
    stem = maker.removesuffix("_bench")
    own = [f"bench/{maker}.cpp", f"bench/{stem}"] if stem != maker else []
    if not own and maker not in BEGINS:
        raise ValueError(f"{maker} makes no figures")
    begins = [*BEGINS.get(maker, ()), *(path for path in own if (ROOT / path).exists())]
    reached = {str(file.parent if file.parts[0] in ("src", "simd") else file) for file in included(begins)}
    return sorted({*begins, *reached, *(file for file in FLAGGED if maker not in UNCOMPILED and (ROOT / file).exists())})


def code_of(text, name):
    """The part of a text that decides the compiled code: sources without comments and space, the flags of CMake's files, all of others."""
    if name in FLAGGED:
        return [flag for flag in FLAG.findall(re.sub("#.*", "", text)) if not IDLE.match(flag)]
    if not name.endswith((".h", ".cpp", ".c")):
        return text
    string = r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\''
    without = re.sub(rf"({string})|//[^\n]*|/\*.*?\*/", lambda found: found.group(1) or " ", text, flags=re.S)
    return " ".join(without.split())


@functools.cache
def code_at(_root, commit, name):
    """The code of a file at a commit; None if it is not there. Makers share files, so each is read once."""
    text = git("show", f"{commit}:{name}")
    return None if text is None else code_of(text, name)


def code_now(name):
    return code_of((ROOT / name).read_bytes().decode("latin-1"), name) if (ROOT / name).exists() else None


def changed_since(commit, maker):
    """Returns the files that the figures of a maker rest on whose code is another in the working tree than at a commit, in order
    of name. Texts about the code do not count, nor the figure that the page shows."""
    begins = {*BEGINS.get(maker, ())}
    paths = [path if path in begins or not (ROOT / path).is_dir() else f":(glob){path}/*" for path in sources_of(maker)]
    names = git("diff", "--name-only", commit, "--", *paths)
    if names is None:
        raise ValueError(f"{commit} is no commit of this history")
    return [name for name in names.splitlines() if not name.endswith(".md") and name != SHOWN[0] and code_at(ROOT, commit, name) != code_now(name)]


def rooms(files, sources):
    """The innermost of the sources that hold the files: simd, src/ist/query."""
    return ", ".join(sorted({max((source for source in sources if file == source or file.startswith(source + "/")), key=len) for file in files}))


def stamp(commit, date, maker, more=""):
    """Returns the line for the foot of a table that a benchmark or a script measured at a commit."""
    state = ", **with changes that no commit holds**" if commit.endswith("+") else ""
    return f"Measured at commit `{commit}` on {date} by `{maker}`{state}.{' ' + more if more else ''}"


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


def verdict(commit, maker):
    """Returns a flaw of the figures of a maker at a commit, or an empty value."""
    if not is_commit(commit):
        return f"measured at {commit}, which is no commit of this history"
    changed = changed_since(commit, maker)
    files = f"{len(changed)} file{'s' if len(changed) > 1 else ''}"
    return changed and f"measured at {commit} by {maker}; since then {files} changed in {rooms(changed, sources_of(maker))}"


def stale(page):
    """Yields a line of text for each stamp of the page whose sources have changed since its commit, or whose commit does not exist."""
    known = {}
    for number, commit, maker in stamps_in(page):
        if (commit, maker) not in known:
            known[commit, maker] = verdict(commit, maker)
        if known[commit, maker]:
            yield f"{page}:{number}: {known[commit, maker]}"


def stale_in_page():
    """Yields a line of text if the figure that the page shows is stale."""
    if said := verdict(shown_commit(), SHOWN[1]):
        yield f"{SHOWN[0]}: {said}"


def main(pages):
    for page in pages:
        if not (ROOT / page).is_file():
            sys.exit(f"check_figures: {page} is not there: the pages of results are {', '.join(PAGES)}")
    if not has_history():
        sys.exit("check_figures: no whole history of commits is here: clone the repository, not a part of it")
    bare = [f"{page}:{number}: the table names neither the commit that it was measured at nor a test, of those that ctest knows, that repeats it"
            for page in pages for number, is_stamped in tables_in(page) if not is_stamped]
    found = [*bare, *(line for page in pages for line in stale(page)), *(stale_in_page() if pages is PAGES else ())]
    print("\n".join(found) if found else f"every figure on {len(pages)} page{'s' if len(pages) > 1 else ''} is of the code as it is")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or PAGES))
