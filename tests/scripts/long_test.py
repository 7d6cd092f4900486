"""Which parts of long work scripts/parts.sh runs again, and what scripts/long_table.py makes of their logs."""

import contextlib
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).parents[2] / "scripts"
sys.path.insert(0, str(SCRIPTS))
import long_table  # noqa: E402

# `stops` is a function whose first command fails: it ends there, as a script would.
PROGRAM = """#!/usr/bin/env bash
set -euo pipefail
jobs=2
source {scripts}/parts.sh
begin_parts "$PWD/logs" "$@"
also[good]="README.md docs :!docs/results.md"
stops() {{ [ -e mended ]; echo stops >>ran; }}
alone good bash -c 'echo good >>ran'
aside slow bash -c 'sleep 0.2; echo slow >>ran'
aside bad bash -c 'echo bad >>ran; [ -e mended ]'
alone stops stops
alone absent bash -c 'echo absent >>ran; exit 77'
end_parts
"""


class Parts(unittest.TestCase):
    """Five parts in a repository of their own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "long.sh").write_text(PROGRAM.format(scripts=SCRIPTS))
        (self.folder / ".gitignore").write_text("logs\nran\nmended\n")
        self.git("init", "--quiet")
        self.commit()

    def git(self, *arguments):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *arguments], cwd=self.folder, check=True, capture_output=True)

    def commit(self, *changed):
        for name in changed:
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text("changed")
        self.git("add", ".")
        self.git("commit", "--quiet", "-m", "a change")

    def run_parts(self, *arguments, environment=None):
        (self.folder / "ran").write_text("")
        done = subprocess.run(["bash", "long.sh", *arguments], cwd=self.folder, capture_output=True, text=True, check=False,
                              env={"PATH": "/usr/bin:/bin", **(environment or {})})
        self.said = done.stdout + done.stderr
        return done.returncode, sorted((self.folder / "ran").read_text().split())

    def mend(self):
        (self.folder / "mended").write_text("")

    def test_one_that_fails_stops_no_other(self):
        self.assertEqual(self.run_parts(), (1, ["absent", "bad", "good", "slow"]))
        self.assertIn("failed: bad stops;", self.said)

    def test_all_that_pass(self):
        self.mend()
        self.assertEqual(self.run_parts(), (0, ["absent", "bad", "good", "slow", "stops"]))

    def test_one_that_is_skipped_fails_where_all_are_required(self):
        self.mend()
        self.assertEqual(self.run_parts(environment={"IST_REQUIRE_ALL": "1"})[0], 1)
        self.assertIn("failed: absent;", self.said)

    def test_those_that_passed_do_not_run_again(self):
        self.run_parts()
        self.mend()
        self.assertEqual(self.run_parts("--resume"), (0, ["absent", "bad", "stops"]))
        self.assertEqual(self.run_parts("--resume"), (0, ["absent"]))
        self.assertEqual(len(self.run_parts()[1]), 5)

    def test_they_run_again_where_something_else_than_a_page_or_a_result_changed(self):
        self.mend()
        self.run_parts()
        for changed, again in (("docs/results.md", 1), ("perf/results/machine.json", 1), ("HACKING.md", 1), ("README.md", 2), ("docs/page.md", 2),
                               ("code.cpp", 5), ("src/README.md", 5)):
            with self.subTest(changed=changed):
                self.commit(changed)
                self.assertEqual(len(self.run_parts("--resume")[1]), again, self.said)  # one is skipped each time

    def test_what_passed_at_a_commit_that_is_not_known_does_not_count(self):
        self.run_parts("good")
        log = self.folder / "logs/good.log"
        log.write_text("passed at 0123456789ab on 2026-01-02 in 3 s\n")
        self.assertEqual(self.run_parts("--resume", "good"), (0, ["good"]))

    def test_a_page_that_is_not_committed_ages_what_rests_on_it(self):
        self.commit("docs/page.md")
        self.run_parts("good", "slow")
        for page, again in (("docs/results.md", []), ("docs/page.md", ["good"]), ("long.py", ["good", "slow"])):
            (self.folder / page).write_text("changed again")
            self.assertEqual(self.run_parts("--resume", "good", "slow"), (0, again))
            (self.folder / page).unlink()
            self.git("checkout", "--quiet", "--", ".")

    def test_they_pass_for_nothing_where_what_they_rest_on_changes_meanwhile(self):
        commit = "; git add .; git commit -qm meanwhile"
        steps = "".join(f"alone {name} bash -c 'echo {name} >>{file}{then}'\n" for name, file, then in (
            ("results", "docs/results.md", ""), ("committed", "docs/results.md", commit), ("good", "docs/page.md", ""),
            ("code", "code.cpp", commit), ("after", "docs/results.md", commit)))
        (self.folder / "long.sh").write_text(f"{PROGRAM.format(scripts=SCRIPTS).split('stops()')[0]}{steps}end_parts\n")
        self.git("config", "user.name", "a")
        self.git("config", "user.email", "a@b")
        self.commit("docs/page.md")
        self.assertEqual(self.run_parts()[0], 0)
        for name, changed in (("results", False), ("committed", False), ("good", True), ("code", True), ("after", False)):
            with self.subTest(name=name):
                self.assertEqual(" with changes on " in (self.folder / f"logs/{name}.log").read_text(), changed)

    def test_they_pass_for_nothing_with_changes(self):
        self.mend()
        (self.folder / "more").write_text("")
        self.run_parts()
        self.assertEqual(len(self.run_parts("--resume")[1]), 5)
        (self.folder / "more").unlink()
        self.assertEqual(len(self.run_parts("--resume")[1]), 5)

    def test_one_that_was_killed_has_not_passed(self):
        self.mend()
        self.run_parts()
        log = self.folder / "logs/slow.log"
        log.write_text("half of it\n")
        self.assertEqual(self.run_parts("--resume")[1], ["absent", "slow"])

    def test_no_more_run_at_once_than_may(self):
        wait = "until grep -q begin.{} ran; do sleep 0.01; done; "
        steps = "".join(f"{kind} {name} bash -c 'echo begin {name} >>ran; {wait.format(other) if other else ''}"
                        f"sleep 0.2; echo end {name} >>ran'\n"
                        for kind, name, other in (("aside", "a", "b"), ("aside", "b", "a"), ("aside", "c", ""),
                                                  ("alone", "d", ""), ("aside", "e", "")))
        head = PROGRAM.format(scripts=SCRIPTS).split("stops()")[0]
        (self.folder / "long.sh").write_text(f"{head}{steps}end_parts\n")
        self.assertEqual(self.run_parts()[0], 0)
        running, most, beside = set(), 0, set()
        for line in (self.folder / "ran").read_text().splitlines():
            word, name = line.split()
            (running.add if word == "begin" else running.remove)(name)
            most = max(most, len(running))
            beside |= running - {"d"} if "d" in running else set()
        self.assertEqual((most, beside), (2, set()))

    def test_those_that_are_named_run_alone(self):
        self.assertEqual(self.run_parts("go", "sl"), (0, ["good", "slow"]))
        self.assertEqual(self.run_parts("gone"), (2, []))
        self.assertIn("no part begins with gone", self.said)
        self.assertEqual(self.run_parts("--again"), (2, []))

    def test_how_they_stand(self):
        self.assertEqual(self.run_parts("--list")[0], 0)
        self.assertIn("good: never begun", self.said)
        self.run_parts("good")
        self.assertEqual(self.run_parts("--list"), (0, []))
        self.assertRegex(self.said, "good: counts at this commit: passed at [0-9a-f]{12} on ")
        self.run_parts("bad")
        self.commit("docs/results.md")
        self.run_parts("--list")
        self.assertRegex(self.said, "good: counts at this commit: passed at ")
        self.assertRegex(self.said, "bad: not at this commit: failed at ")
        self.commit("code.cpp")
        self.run_parts("--list")
        self.assertRegex(self.said, "good: not at this commit: passed at ")


class Table(unittest.TestCase):
    """The table of made-up logs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def log(self, name, text, verdict="passed at 0123456789ab on 2026-01-02 in 90 s", cases=""):
        (self.folder / f"{name}.log").write_text(f"{text}\n{verdict}\n")
        if cases:
            (self.folder / f"{name}.jsonl").write_text(cases)

    def rows(self):
        return list(long_table.rows(self.folder).values())

    def test_it_has_the_parts_of_the_long_runs_in_their_order(self):
        (self.folder / "scripts").mkdir()
        for name in ("long.sh", "parts.sh", "run_preset.sh"):
            shutil.copy(SCRIPTS / name, self.folder / "scripts" / name)
        subprocess.run(["git", "init", "--quiet"], cwd=self.folder, check=True)
        said = subprocess.run([self.folder / "scripts/long.sh", "--list"], capture_output=True, text=True, check=True).stdout
        self.assertEqual([line.partition(":")[0] for line in said.splitlines()], list(long_table.PARTS))
        self.assertEqual(len(set(long_table.PARTS.values())), len(long_table.PARTS))

    def test_counts(self):
        self.log("suite", "100% tests passed, 0 tests failed out of 7\n100% tests passed, 0 tests failed out of 12\n\n"
                          "The following tests did not run:\n\t 5 - Some.Test (Skipped)")
        self.log("stability", "[  PASSED  ] 3 tests.\n[  PASSED  ] 4 tests.", cases='{"samples": 5, "broken": 0}\n{"samples": 8, "broken": 1}\n')
        self.log("coherent", "1000 ticks: 3 kept\n2000 ticks: 4 kept\n[  PASSED  ] 1 test.")
        suite, stability, coherent = self.rows()
        self.assertIn("| tests: 19, skipped: 1 | `0123456789ab`, 2026-01-02 | 2 min |", suite)
        self.assertIn("| tests: 7, most samples of a case: 8, cases: 2, broken: 1 |", stability)
        self.assertIn("| tests: 1, ticks: 3,000 |", coherent)

    def test_doors_say_what_they_lead_from(self):
        self.log("doors-scans", "door scans, in a bare Debian 12 root\nstep", "passed at a on 2026-01-02 in 20 s")
        self.log("doors-cycles", "door cycles, in unpacked packages, without a root of its own: none", "passed at a on 2026-01-02 in 3 s")
        scans, cycles = self.rows()
        self.assertIn("| passed | in a bare Debian 12 root: 1 | `a`, 2026-01-02 | 20 s |", scans)
        self.assertIn("| passed | in unpacked packages: 1 |", cycles)

    def test_what_did_not_pass_is_said(self):
        self.log("suite", "", "failed at 0123 on 2026-01-02 in 90 s")
        self.log("blender", "", "skipped at 0123 on 2026-01-02 in 1 s")
        self.log("golden", "half of it", "")
        self.log("threads", "", "passed at 0123 with changes on 2026-01-02 in 90 s")
        suite, blender, threads = self.rows()
        self.assertIn("| **failed** |", suite)
        self.assertIn("| **skipped** |", blender)
        self.assertIn("`0123+`", threads)

    def test_rows_of_parts_without_a_log_stay(self):
        page = f"before\n{long_table.BEGIN}No part has been run yet.\n{long_table.END}after\n"
        self.log("suite", "", "passed at a on 2026-01-02 in 60 s")
        self.log("fuzz-2", "", "passed at a on 2026-01-02 in 60 s")
        page = long_table.written(page, long_table.rows(self.folder))
        for log in self.folder.iterdir():
            log.unlink()
        self.log("fuzz-2", "", "passed at b on 2026-01-03 in 60 s")
        self.log("kills", "", "passed at b on 2026-01-03 in 60 s")
        page = long_table.written(page, long_table.rows(self.folder))
        before, _, _, _, suite, kills, fuzz, _, after = page.splitlines()
        self.assertEqual((before, after), ("before", "after"))
        for row, part, commit in ((suite, "suite", "a"), (kills, "kills", "b"), (fuzz, "fuzz-2", "b")):
            self.assertTrue(row.startswith(f"| {long_table.PARTS[part]} | passed |"), row)
            self.assertIn(f"`{commit}`", row)

    def test_the_page_has_a_place(self):
        self.assertIn(long_table.BEGIN, long_table.PAGE.read_text())
        with self.assertRaises(SystemExit):
            long_table.written("a page", {})

    def test_a_row_of_no_part_is_named_and_not_lost(self):
        page = f"{long_table.BEGIN}| part |\n|---|\n| a part that was | passed |\n{long_table.END}"
        with self.assertRaisesRegex(SystemExit, "a row of no part: a part that was"):
            long_table.written(page, {})


class Check(unittest.TestCase):
    """What --check says in a repository of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, real = pathlib.Path(folder.name), (long_table.ROOT, long_table.PAGE)
        self.addCleanup(self.restore, *real)
        long_table.ROOT, long_table.PAGE = self.root, self.root / "docs/guarantees.md"
        self.write("scripts/parts.sh", (SCRIPTS / "parts.sh").read_text())
        self.git("init", "--quiet")
        self.commit = self.write("README.md", "one")

    @staticmethod
    def restore(root, page):
        long_table.ROOT, long_table.PAGE = root, page

    def git(self, *words):
        return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], cwd=self.root,
                              check=True, capture_output=True, text=True).stdout

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)
        if (self.root / ".git").exists():
            self.git("add", ".")
            self.git("commit", "--quiet", "-m", "a change")
            return self.git("rev-parse", "--short=12", "HEAD").strip()
        return None

    def lacking(self, without="release", verdict="passed", changes=""):
        """The parts that --check names on a page with the rows of all parts but one."""
        rows = [f"| {title} | {verdict} | – | `{self.commit}{changes}`, 2026-01-02 | 1 s |\n" for part, title in long_table.PARTS.items()
                if part != without]
        long_table.PAGE.parent.mkdir(exist_ok=True)
        long_table.PAGE.write_text("".join([long_table.BEGIN, "| part |\n", "|---|\n", *rows, long_table.END]))
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            code = long_table.main(["--check"])
        named = [part for part in long_table.PARTS if f" {part}," in said.getvalue() or f" {part}:" in said.getvalue()]
        self.assertEqual(code, 1 if named else 0, said.getvalue())
        return named

    def test_it_names_what_has_no_row(self):
        self.assertEqual(self.lacking(), [])
        self.assertEqual(self.lacking(without="fuzz-3"), ["fuzz-3"])

    def test_it_names_all_that_did_not_pass(self):
        for given in ({"verdict": "**failed**"}, {"verdict": "**skipped**"}, {"changes": "+"}):
            self.assertEqual(len(self.lacking(**given)), len(long_table.PARTS) - 1, given)

    def test_it_names_all_where_code_has_changed_and_doors_where_a_page_has(self):
        self.write("README.md", "two")
        self.assertEqual(self.lacking(), [part for part in long_table.PARTS if part.startswith("doors")])
        self.write("code.cpp", "int a;")
        self.assertEqual(self.lacking(), [part for part in long_table.PARTS if part != "release"])

    def test_it_names_all_where_changes_are_not_committed(self):
        (self.root / "code.cpp").write_text("int a;")
        self.assertEqual(len(self.lacking()), len(long_table.PARTS) - 1)

    def test_a_commit_that_is_not_there_counts_for_nothing(self):
        self.commit = "0123456789ab"
        self.assertEqual(len(self.lacking()), len(long_table.PARTS) - 1)


if __name__ == "__main__":
    unittest.main()
