"""Figures on pages of results: each names its commit, and scripts/check_figures.sh names those that are older than their code.

Without the history of commits that is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it is 1."""

import contextlib
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
from report import figures  # noqa: E402
from report.runner import Runner  # noqa: E402


class Pages(unittest.TestCase):
    """The pages of this project."""

    def test_every_table_has_a_stamp(self):
        bare = [f"{page}:{number}" for page in figures.PAGES for number, stamped in figures.tables_in(page) if not stamped]
        self.assertEqual(bare, [])

    def test_every_stamp_names_a_commit_of_this_history(self):
        stamps = [(page, number, commit) for page in figures.PAGES for number, commit, _ in figures.stamps_in(page)]
        stamps.append((figures.SHOWN[0], 1, figures.shown_commit()))
        self.assertGreater(len(stamps), 0)
        if not figures.has_history():
            missing = "no whole history of commits is here, in which the commits of stamps could be looked up: clone the project without --depth"
            if os.environ.get("IST_REQUIRE_ALL") == "1":
                self.fail(f"IST_REQUIRE_ALL is set, and {missing}")
            self.skipTest(missing)
        self.assertEqual([f"{page}:{number}: {commit}" for page, number, commit in stamps if not figures.is_commit(commit)], [])

    def test_what_the_page_shows_has_sources_whose_changes_are_seen(self):
        file, maker = figures.SHOWN
        self.assertTrue((figures.ROOT / "scripts" / maker).exists())
        for source in figures.sources_of(maker):
            self.assertTrue((figures.ROOT / source).exists(), f"{file} rests on {source}")
        if figures.has_history():
            first = figures.git("rev-list", "--max-parents=0", "HEAD").split()[0]
            self.addCleanup(setattr, figures, "shown_commit", figures.shown_commit)
            figures.shown_commit = lambda: first
            self.assertEqual([line.split(":")[0] for line in figures.stale_in_page()], [file])

    def test_the_figures_of_ist_bench_have_a_stamp(self):
        begin, end = "<!-- ist bench -->", "<!-- end of ist bench -->"
        between = (figures.ROOT / "README.md").read_text().split(begin)[1].split(end)[0]
        self.assertRegex(between, figures.STAMP)

    def test_every_maker_of_figures_has_sources(self):
        made = {maker for page in figures.PAGES for _, _, maker in figures.stamps_in(page)}
        for maker in made | set(figures.BEGINS):
            for source in figures.sources_of(maker):
                self.assertTrue((figures.ROOT / source).exists(), f"{maker} rests on {source}")

    def test_times_name_the_load_and_a_fixed_loop_beside_their_commit(self):
        bare, timed = [], 0
        for page in figures.PAGES:
            text = (figures.ROOT / page).read_text()
            for number, line in enumerate(text.splitlines(), 1):
                makers = {found.group(3) for found in figures.STAMP.finditer(line)} - figures.COUNTERS
                timed += len(makers)
                if makers and not figures.STATE.search(line):
                    bare.append(f"{page}:{number}")
        self.assertEqual(bare, [])
        self.assertGreater(timed, 0)


class Sources(unittest.TestCase):
    """Figures rest on what their program includes, directly or not."""

    def test_a_benchmark_rests_on_the_rooms_that_it_asks(self):
        for maker, rooms in (("sweep_bench", ["src/sweep", "src/ist/measure", "src/python/ist"]),
                             ("loop_bench", ["src/loop/scene", "src/loop/haptics"]),
                             ("deadline_bench", ["tests/support/conformal.cpp", "src/ist/query/traversal", "simd"]),
                             ("hardware_bench", ["src/hardware/include/ist/hardware", "tests/hardware/pair_walk.h"]),
                             ("peers_bench", ["src/ist/measure", "src/ist/query/triangles"]), ("stability_border.py", ["src/loop/haptics"])):
            self.assertEqual(set(rooms) - set(figures.sources_of(maker)), set(), maker)
        self.assertNotIn("src/loop/haptics", figures.sources_of("ablation_bench"))
        self.assertNotIn("src/ist/mesh/format", figures.sources_of("peers_bench"))

    def test_a_maker_of_nothing_is_refused(self):
        self.assertRaisesRegex(ValueError, "nothing.sh makes no figures", figures.sources_of, "nothing.sh")

    def test_a_change_is_told_by_the_innermost_room(self):
        self.assertEqual(figures.rooms(["src/ist/a.cpp", "src/b.cpp"], ["src", "src/ist"]), "src, src/ist")


class States(unittest.TestCase):
    CONTEXT = {"load_avg": [0.25, 1, 1], "load_after": "0.5", "loop_before": "140.0", "loop_after": "141.0"}

    def test_load_and_loop_are_in_a_stamp_of_times(self):
        self.assertRegex(figures.machine_state(self.CONTEXT), figures.STATE)

    def test_results_without_them_are_refused(self):
        for name in self.CONTEXT:
            with self.assertRaisesRegex(ValueError, name):
                figures.machine_state({key: value for key, value in self.CONTEXT.items() if key != name})


class Code(unittest.TestCase):
    def test_comments_and_space_of_sources_do_not_count(self):
        for one, other, name, same in (("int a; // one\n/* two\nlines */ int b;\n", "int a;\n  int b;", "a.cpp", True),
                                       ('auto a = "//1";', 'auto a = "//2";', "a.cpp", False), ("a // b", "a // c", "a.cmake", False)):
            self.assertEqual(figures.code_of(one, name) == figures.code_of(other, name), same, one)

    def test_of_cmake_the_flags_count_and_warnings_do_not(self):
        text = 'project(ist VERSION 1)\ntarget_compile_options(ist INTERFACE -O3 -Wall)  # -O1\nset(CMAKE_BUILD_TYPE Release)\n'
        for old, new, same in (("-O3", "-O2", False), ("Release", "Debug", False), ("VERSION 1", "VERSION 2", True), (" -Wall", " -Wextra", True),
                               ("# -O1", "# why", True), (" -Wall", " -fno-sanitize=vptr", True), (" -Wall", " -fmacro-prefix-map=/=", True)):
            self.assertEqual(figures.code_of(text, "CMakeLists.txt") == figures.code_of(text.replace(old, new), "CMakeLists.txt"), same, new)


class Project(unittest.TestCase):
    """A project of one source and one page, in a history of its own."""

    PAGE = "page.md"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, real = pathlib.Path(folder.name), (figures.ROOT, dict(figures.BEGINS))
        figures.ROOT = self.root
        figures.BEGINS = {"made": ["src"]}
        self.addCleanup(self.restore, *real)
        (self.root / "src").mkdir()
        self.git("init", "-q")
        self.git("config", "user.email", "nobody@nowhere")
        self.git("config", "user.name", "nobody")
        self.commit = self.write("int a;  // one\n")

    @staticmethod
    def restore(root, begins):
        figures.ROOT = root
        figures.BEGINS = begins

    def git(self, *arguments):
        return subprocess.run(["git", "-C", self.root, *arguments], capture_output=True, text=True, check=True).stdout.strip()

    def write(self, code):
        (self.root / "src/a.cpp").write_text(code)
        self.git("add", ".")
        self.git("commit", "-q", "-m", "a change")
        return self.git("rev-parse", "--short=7", "HEAD")


class History(Project):
    def page(self, below):
        (self.root / self.PAGE).write_text("| a |\n|---|\n| 1 |\n\n" + below + "\n")

    def check(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            return figures.main([self.PAGE]), said.getvalue()

    def test_figures_of_the_code_as_it_is_are_fine(self):
        self.page(figures.stamp(self.commit, "2026-01-01", "made"))
        self.write("int a;  // two\n")
        self.assertEqual(self.check()[0], 0)

    def test_figures_of_other_code_are_stale(self):
        self.page(figures.stamp(self.commit, "2026-01-01", "made"))
        self.write("int b;\n")
        self.assertEqual(self.check(), (1, f"page.md:5: measured at {self.commit} by made; since then 1 file changed in src\n"))

    def test_a_commit_that_is_not_there_is_named(self):
        self.page("Measured at commit `fedcba9` on 2026-01-01 by `made`.")
        code, said = self.check()
        self.assertEqual(code, 1)
        self.assertIn("measured at fedcba9, which is no commit of this history", said)

    def test_changes_that_no_commit_holds_are_named(self):
        self.page(figures.stamp(self.commit + "+", "2026-01-01", "made"))
        self.assertIn("**with changes that no commit holds**", (self.root / self.PAGE).read_text())
        self.assertEqual(self.check()[0], 1)

    def test_a_table_without_a_stamp_is_named(self):
        self.page("No word of its commit.")
        code, said = self.check()
        self.assertEqual(code, 1)
        self.assertIn("page.md:1: the table names neither the commit", said)

    def test_a_table_that_a_test_repeats_needs_none(self):
        (self.root / "tests").mkdir()
        (self.root / "tests/a_test.cpp").write_text("TEST_F(Some, Test) {}\n")
        (self.root / "tests/CMakeLists.txt").write_text("add_test(NAME Whole COMMAND a_test)\n")
        for name, known in (("Some.Test", True), ("Whole", True), ("Some.Tes", False), ("Whol", False), ("Other", False)):
            self.page(f"Repeated by the test `{name}`.")
            self.assertEqual(self.check()[0], 0 if known else 1, name)

    def rows(self, commit):
        (self.root / self.PAGE).write_text(f"| program | commit |\n|---|---|\n| `made` | {commit} |\n")

    def test_a_row_may_name_its_program_and_its_commit(self):
        self.rows(self.commit)
        self.assertEqual(self.check()[0], 0)
        self.assertEqual(list(figures.stamps_in(self.PAGE)), [(3, self.commit, "made")])
        self.write("int b;\n")
        self.assertEqual(self.check()[0], 1)
        self.rows("fedcba9")
        self.assertEqual(self.check(), (1, "page.md:3: measured at fedcba9, which is no commit of this history\n"))
        (self.root / self.PAGE).write_text(f"| a | commit |\n|---|---|\n| 1 | {self.commit} |\n")
        self.assertEqual(self.check()[0], 1)

    def test_a_folder_within_a_repository_has_no_history(self):
        self.assertTrue(figures.has_history())
        figures.ROOT = self.root / "src"
        self.assertFalse(figures.has_history())

    def test_figures_of_other_flags_are_stale(self):
        for flag, code in (("-O2", 0), ("-O2 -Wall", 0), ("-O3", 1)):
            (self.root / "CMakeLists.txt").write_text(f"target_compile_options(a PRIVATE {flag})\n")
            if flag == "-O2":
                self.commit = self.write("int a;\n")
                self.page(figures.stamp(self.commit, "2026-01-01", "made"))
            self.assertEqual(self.check()[0], code, flag)

    def test_a_page_that_is_not_there_is_named(self):
        with self.assertRaises(SystemExit) as said:
            figures.main(["nowhere.md"])
        self.assertIn("nowhere.md is not there", str(said.exception))


class Missing(Project):
    """scripts/perf_report.py runs a benchmark again that has no results, or results of other code."""

    MADE = {"compiler": "g++ 12", "flags": "-O3"}

    def runs(self, results, now, again=False, **context):
        """The programs that run if `results` is the context of what was measured before, or None."""
        ran, folder = [], self.root / "build"
        runner = Runner(folder, [f"{name}={value}" for name, value in {**self.MADE, "commit": now, **context}.items()], quick=False)
        runner.measure = lambda program, _: ran.append(program)
        file = folder / "made.json"
        file.unlink(missing_ok=True)
        if results is not None:
            file.write_text(json.dumps({"context": {**self.MADE, **results}}))
        with contextlib.redirect_stderr(io.StringIO()):
            runner.run(["made"], again)
        return ran

    def test_results_of_this_code_count_unless_all_is_asked_for(self):
        self.assertEqual(self.runs({"commit": self.commit, "arguments": ""}, self.commit), [])
        self.assertEqual(self.runs({"commit": self.commit}, self.write("int a;  // why\n")), [])
        self.assertEqual(self.runs({"commit": self.commit}, self.commit, again=True), ["made"])

    def test_other_results_are_missing(self):
        for results in (None, {"commit": self.commit + "+"}, {"commit": "fedcba9"}, {"commit": self.commit, "arguments": "--benchmark_filter=a"},
                        *({"commit": self.commit, name: "another"} for name in self.MADE)):
            self.assertEqual(self.runs(results, self.commit), ["made"], results)
        self.assertEqual(self.runs({"commit": self.commit + "+"}, self.commit + "+"), ["made"])
        self.assertEqual(self.runs({"commit": self.commit}, self.write("int b;\n")), ["made"])


if __name__ == "__main__":
    ended = unittest.main(exit=False).result
    for _, reason in ended.skipped:
        print(f"skipped: {reason}", file=sys.stderr)
    sys.exit(1 if not ended.wasSuccessful() else 77 if ended.skipped else 0)
