"""Runs the code of one page of README or docs, in a folder of its own, as a reader would: shell, Python and C++ in their order, C++
and C under two compilers, a scene by `ist run --check`, a sweep file by a share of `ist sweep` that has no part. A block without a
language that follows is what they print: it is compared, where its `…` stands for any text. The notes that change this are those
of pages.py. A block of any other language is an error: no block is passed over, but for those whose note gives the reason.

Fragments of C++, blocks without `int main`, are one program together. Blocks of Python are one too: each knows the names of
those before it. A file of Python is a program of its own.
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import pages

SKIPPED = 77
OTHER_COMPILER = "clang++-14"
PYTHON = "/usr/bin/python3"
C_COMPILERS = ("gcc", "clang-14")
STUBS = pathlib.Path(__file__).resolve().parent / "stubs"
PACKAGE = STUBS.parents[2] / "src/python"  # where the package `ist` is
VIEW = STUBS.parents[2] / "build/viewer/ist.html"  # the page that `ist view` fills
LANGUAGES = ("", "sh", "python", "cpp", "c", "toml", "csv", "json", "cmake")
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]


def missing_modules(page):
    """The modules of others that the page's Python imports, where it is run, and PYTHON does not have."""
    named = {name for block in page.blocks if block.language == "python" and not block.says("not run")
             for name in re.findall(r"(?m)^(?:import|from) (\w+)", block.text)} - {"ist"}
    return [name for name in sorted(named)
            if subprocess.run([PYTHON, "-c", f"import {name}"], stderr=subprocess.DEVNULL, check=False).returncode != 0]


class Failure(Exception):
    pass


def is_output(expected, printed):
    """Whether they are equal, with `…` for any text, also of several lines."""
    pattern = ".*".join(re.escape(part) for part in expected.rstrip("\n").split("…"))
    return re.fullmatch(pattern, printed.rstrip("\n"), re.S) is not None


class Session:
    """A page's Python: one interpreter, which runs block after block. A block that begins with `>>>` shows what it prints: doctest
    compares it."""

    PROGRAM = """
import doctest, json, sys
names = {"__name__": "__main__"}
for line in sys.stdin:
    code = json.loads(line)
    if code.startswith(">>> "):
        test = doctest.DocTestParser().get_doctest(code, names, "the page", None, 0)
        if doctest.DocTestRunner().run(test, clear_globs=False).failed:
            sys.exit(1)
        names.update(test.globs)
    else:
        exec(compile(code, "the page", "exec"), names)
    print("\\0", flush=True)
"""

    def __init__(self, folder, environment):
        self.errors = folder / "python_errors.txt"
        with open(self.errors, "w") as errors:
            self.process = subprocess.Popen([PYTHON, "-Bc", self.PROGRAM], cwd=folder, env=environment, text=True,
                                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors)

    def run(self, text):
        """Whether a block runs to its end, and what it prints."""
        self.process.stdin.write(json.dumps(text) + "\n")
        self.process.stdin.flush()
        printed = []
        for line in self.process.stdout:
            if line.endswith("\0\n"):
                return True, "".join(printed) + line[:-2]
            printed.append(line)
        self.process.wait()
        return False, "".join(printed) + self.errors.read_text()

    def end(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()


class Reader:
    """Does what a page says."""

    def __init__(self, name, folder, prefix, compiler):
        self.name, self.folder, self.prefix, self.compiler = name, folder, prefix, compiler
        libraries = next(prefix.rglob("pkgconfig/ist_loop.pc")).parent.parent
        self.environment = dict(os.environ, PATH=f"{prefix}/bin:{os.environ['PATH']}", LD_LIBRARY_PATH=str(libraries),
                                PKG_CONFIG_PATH=str(libraries / "pkgconfig"), PYTHONPATH=str(PACKAGE), IST_PAGE=str(VIEW),
                                IST_LIBRARY=str(libraries / "libist_loop.so"), MPLBACKEND="Agg", PYTHONDONTWRITEBYTECODE="1")
        self.session = None  # of the page's Python, from its first block on
        self.printed = None  # of the last block, until it is compared
        self.fragments, self.outputs = [], []  # of the page's one program
        self.counts = {"run": 0, "compared": 0, "written": 0, "compiled": 0, "left": 0}

    def run(self, command, line):
        ran = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, cwd=self.folder,
                             env=self.environment, stdin=subprocess.DEVNULL)
        if ran.returncode != 0:
            raise Failure(f"{self.name}, line {line}: {' '.join(map(str, command))[:2000]}\n"
                          f"failed with {ran.returncode}:\n{ran.stdout}{ran.stderr}")
        return ran.stdout

    def shell(self, text, line):
        return self.run(["bash", "-euo", "pipefail", "-c", text], line)

    def python(self, text, line):
        if self.session is None:
            self.session = Session(self.folder, self.environment)
        is_run, printed = self.session.run(text)
        if not is_run:
            raise Failure(f"{self.name}, line {line}: this Python failed:\n{printed}")
        return printed

    def check_toml(self, file, block):
        """Reads a sweep file, with its trees and its poses, or a scene."""
        if re.search(r"(?m)^\[+poses\b", block.text) is None:
            self.run(["ist", "run", file, "--check"], block.line)
            return
        with tempfile.TemporaryDirectory() as parts:  # of a share that has no part
            self.run(["ist", "sweep", file, "-o", parts, "--share", "999999998/999999999"], block.line)

    def flags(self, what):
        return self.run(["pkg-config", what, "ist_loop"], 0).split()

    def program(self, text, line, ending, compilers, standard):
        """What a program prints, the same of each compiler."""
        source = self.folder / f"line_{line}.{ending}"
        source.write_text(text)
        printed = set()
        for compiler in compilers:
            binary = source.with_suffix(f".{pathlib.Path(compiler).name}")
            self.run([compiler, standard, *WARNINGS, *self.flags("--cflags"), source, "-o", binary, *self.flags("--libs")], line)
            printed.add(self.run([binary], line))
        if len(printed) != 1:
            raise Failure(f"{self.name}, line {line}: it prints by compiler: {printed}")
        return printed.pop()

    def compile(self, block):
        """Compiles a file of C++ that needs a library which is not there."""
        source = self.folder / f"line_{block.line}.cpp"
        source.write_text(block.text)
        for compiler in (self.compiler, OTHER_COMPILER):
            self.run([compiler, "-std=c++20", "-fsyntax-only", *WARNINGS, *self.flags("--cflags"), f"-I{STUBS}", source], block.line)

    def fragments_of(self, page):
        """The program of all fragments: includes first, the rest in main()."""
        lines = "".join(block.text for block in self.fragments).splitlines(keepends=True)
        includes = "".join(line for line in lines if line.startswith("#include"))
        rest = "".join(line for line in lines if not line.startswith("#include"))
        return f"{includes}{page.before}int main() {{\n{rest}}}\n"

    def compare(self, expected, printed, line):
        if not is_output(expected, printed):
            raise Failure(f"{self.name}, line {line}: the page shows\n{expected}\nand this is printed:\n{printed}")
        self.counts["compared"] += 1

    def block(self, block):
        if block.language not in LANGUAGES:
            raise Failure(f"{self.name}, line {block.line}: nobody knows how to run '{block.language}': it is one of "
                          f"{', '.join(LANGUAGES[1:])}, or nothing where it is output")
        if block.says("not run"):
            self.counts["left"] += 1
            print(f"{self.name}, line {block.line}: {block.note}")
            self.printed = None
        elif block.says("compiled"):
            if block.language != "cpp":
                raise Failure(f"{self.name}, line {block.line}: only cpp is compiled alone")
            self.compile(block)
            self.counts["compiled"] += 1
            self.printed = None
        elif block.language == "":
            if self.printed is not None:
                self.compare(block.text, self.printed, block.line)
            elif self.fragments and not block.note:
                self.outputs.append(block)
            elif not block.says("output varies"):
                raise Failure(f"{self.name}, line {block.line}: this output follows nothing that prints")
            self.printed = None
        elif block.says("file "):
            file = self.folder / block.note.removeprefix("file ").strip()
            file.write_text(block.text)
            self.counts["written"] += 1
            if block.language == "toml":
                self.check_toml(file, block)
                self.counts["run"] += 1
            if block.language == "c":
                self.printed = self.program(block.text, block.line, "c", C_COMPILERS, "-std=c11")
                self.counts["run"] += 1
            if block.language == "python":
                self.printed = self.run([PYTHON, "-B", file], block.line)
                self.counts["run"] += 1
        elif block.language == "cpp" and "int main" not in block.text:
            self.fragments.append(block)
            self.counts["run"] += 1
        elif block.language in ("sh", "python", "cpp"):
            if block.language == "cpp":
                printed = self.program(block.text, block.line, "cpp", (self.compiler, OTHER_COMPILER), "-std=c++20")
            else:
                printed = (self.shell(block.text, block.line) if block.language == "sh" else
                           self.python(block.text, block.line))
            self.printed = None if block.says("output varies") else printed
            self.counts["run"] += 1
        else:
            raise Failure(f"{self.name}, line {block.line}: this {block.language} needs the note 'file NAME', or 'not run, REASON'")

    def read(self, page):
        if page.setup:
            self.shell(page.setup, 0)
        try:
            for block in page.blocks:
                self.block(block)
        finally:
            if self.session is not None:
                self.session.end()
        if self.fragments:
            line = self.fragments[0].line
            printed = self.program(self.fragments_of(page), line, "cpp", (self.compiler, OTHER_COMPILER), "-std=c++20")
            self.compare("".join(block.text for block in self.outputs), printed, line)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--prefix", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", required=True)
    arguments = parser.parse_args()
    try:
        page = pages.read(arguments.page.read_text())
    except pages.PageError as wrong:
        print(f"{arguments.page.name}, {wrong}", file=sys.stderr)
        return 1
    missing = [f"{tool} is not installed: scripts/setup.sh --package does that" for tool in (OTHER_COMPILER, *C_COMPILERS)
               if shutil.which(tool) is None]
    missing += [f"{PYTHON} has no {name}: scripts/setup.sh --oracles --python installs it" for name in missing_modules(page)]
    if not VIEW.exists() and any(block.language == "sh" and "ist view " in block.text for block in page.blocks):
        missing.append(f"{VIEW} is not there: run scripts/viewer.sh")
    if missing:
        print(f"snippets: skipped: {'; '.join(missing)}", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else SKIPPED
    folder = arguments.work / arguments.page.stem
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    reader = Reader(arguments.page.name, folder, arguments.prefix, arguments.compiler)
    try:
        reader.read(page)
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    counts = reader.counts
    print(f"{arguments.page.name}: {counts['run']} run, {counts['compared']} outputs compared, {counts['written']} files "
          f"written, {counts['compiled']} compiled, {counts['left']} not run")
    return 0 if any(counts.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
