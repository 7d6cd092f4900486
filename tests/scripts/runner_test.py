"""Which benchmarks scripts/perf_report.sh runs again: those without results, or whose results are of other code."""

import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from report import figures  # noqa: E402  after its folder is known
from report.runner import Runner  # noqa: E402

MADE = {"compiler": "g++ 12", "flags": "-O3"}


class Missing(unittest.TestCase):
    """A project of one benchmark, whose figures rest on `src`, in a history of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name, value in (("ROOT", self.root), ("BEGINS", {"some_bench": ["src"]})):
            self.addCleanup(setattr, figures, name, getattr(figures, name))
            setattr(figures, name, value)
        self.git("init", "-q")
        self.git("config", "user.email", "nobody@nowhere")
        self.git("config", "user.name", "nobody")
        self.first = self.commit("src/a.cpp", "int a;")

    def git(self, *arguments):
        return subprocess.run(["git", "-C", self.root, *arguments], capture_output=True, text=True, check=True).stdout.strip()

    def commit(self, file, text):
        (self.root / file).parent.mkdir(exist_ok=True)
        (self.root / file).write_text(text)
        self.git("add", ".")
        self.git("commit", "-q", "-m", "a change")
        return self.git("rev-parse", "--short=7", "HEAD")

    def runs(self, results, now, again=False, **context):
        """The programs that run where `results` is the context of what was measured before, or None."""
        ran, folder = [], self.root / "build"
        runner = Runner(folder, [f"{name}={value}" for name, value in {**MADE, "commit": now, **context}.items()], quick=False)
        runner._run = lambda program, _: ran.append(program)
        file = folder / "some_bench.json"
        file.unlink(missing_ok=True)
        if results is not None:
            file.write_text(json.dumps({"context": {**MADE, **results}}))
        with contextlib.redirect_stderr(io.StringIO()):
            runner.run(["some_bench"], again)
        return ran

    def test_after_an_interruption_it_goes_on_where_it_was(self):
        self.assertEqual(self.runs({"commit": self.first}, self.first), [])
        self.assertEqual(self.runs(None, self.first), ["some_bench"])

    def test_fresh_runs_all(self):
        self.assertEqual(self.runs({"commit": self.first}, self.first, again=True), ["some_bench"])

    def test_results_of_other_code_are_missing(self):
        now = self.commit("src/a.cpp", "int b;")
        self.assertEqual(self.runs({"commit": self.first}, now), ["some_bench"])

    def test_results_before_a_commit_of_texts_count(self):
        now = self.commit("docs/page.md", "More words.")
        self.assertEqual(self.runs({"commit": self.first}, now), [])
        self.assertEqual(self.runs({"commit": self.first}, self.commit("src/a.cpp", "int a;  // why")), [])

    def test_results_of_changes_that_no_commit_holds_are_missing(self):
        self.assertEqual(self.runs({"commit": self.first + "+"}, self.first + "+"), ["some_bench"])
        self.assertEqual(self.runs({"commit": self.first + "+"}, self.first), ["some_bench"])

    def test_results_of_a_commit_that_is_not_there_are_missing(self):
        self.assertEqual(self.runs({"commit": "fedcba9"}, self.first), ["some_bench"])

    def test_results_of_a_part_are_missing(self):
        self.assertEqual(self.runs({"commit": self.first, "arguments": "--benchmark_filter=a"}, self.first), ["some_bench"])
        self.assertEqual(self.runs({"commit": self.first, "arguments": ""}, self.first), [])

    def test_results_of_another_compiler_or_of_other_flags_are_missing(self):
        for name in MADE:
            self.assertEqual(self.runs({"commit": self.first}, self.first, **{name: "another"}), ["some_bench"], name)


if __name__ == "__main__":
    unittest.main()
