"""How a door goes on, ends and what its log says, and that it types what the pages have."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
DOORS = ("scans", "haptics", "script", "cycles")


class Door(unittest.TestCase):
    def setUp(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        self.folder = pathlib.Path(made.name)

    def walk(self, steps, *options, **environment):
        """Walks a door of these steps, in unpacked packages. Returns how it ended and its log."""
        door = self.folder / "tiny.sh"
        door.write_text(f'source "{HERE}/door.sh"\ndoor tiny "$@"\n{steps}\n')
        clean = {name: value for name, value in os.environ.items() if name != "IST_REQUIRE_ALL"}
        ran = subprocess.run(["bash", door, *(options or ["--without-root"])], capture_output=True, text=True, check=False,
                             env={**clean, "IST_DOORS": str(self.folder / "doors"), **environment}, stdin=subprocess.DEVNULL)
        log = self.folder / "doors/tiny.log"
        return ran, log.read_text() if log.exists() else ""

    def test_each_step_has_its_time_and_its_output_in_the_log(self):
        ran, log = self.walk('step "the long one" sleep 0.4\ntypes "a user\'s" "echo six times seven is $((6 * 7))"\nend_door')
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("$ echo six times seven is 42\nsix times seven is 42\n", log)
        for said in (log, ran.stdout):
            times = dict(re.findall(r"\| (.+) \| ([\d.]+) \|", said))
            self.assertEqual(list(times), ["the long one", "a user's", "all"])
            self.assertTrue(0.4 <= float(times["the long one"]) <= float(times["all"]), said)

    def test_a_step_that_fails_ends_the_door_and_shows_the_end_of_the_log(self):
        for failing in ("types wrong 'echo before; false; echo after'", "types wrong 'echo before; false | cat; echo after'",
                        "wrong() { echo before; false; echo after; }\nstep wrong wrong"):
            ran, log = self.walk(f'step "first" true\n{failing}\nstep "never" touch {self.folder}/never\nend_door')
            self.assertEqual(ran.returncode, 1)
            self.assertIn("step 2 failed with 1: wrong", ran.stderr)
            self.assertIn("\nbefore\n", ran.stderr)
            self.assertNotIn("\nafter\n", log)
            self.assertFalse((self.folder / "never").exists())
            self.assertRegex(log, r"\| wrong \| [\d.]+ \|\n\| all")
            self.assertNotIn("walked;", ran.stdout)

    def test_the_log_begins_with_the_way_and_why(self):
        ran, log = self.walk("end_door")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertEqual(log.splitlines()[0], "door tiny, in unpacked packages, without a root of its own: --without-root asks for it")
        # As a user who is not root sees it, and where debootstrap is not there.
        for stand_in, why in (("id() { echo 1000; }", "debootstrap needs root"),
                              ("id() { echo 0; }\ncommand() { [ $2 != debootstrap ]; }",
                               "debootstrap is not installed: scripts/setup.sh --doors does that"),
                              ("id() { echo 0; }\ncommand() { true; }\nunshare() { false; }", "nothing may be mounted here")):
            door = f'eval "{stand_in}"\n'.replace("$2", r"\$2")
            (self.folder / "why.sh").write_text(f'IST_DOORS={self.folder}\nsource "{HERE}/door.sh"\n{door}why_no_root\n')
            said = subprocess.run(["bash", self.folder / "why.sh"], capture_output=True, text=True, check=False)
            self.assertEqual(said.stdout.strip(), why, said.stderr)

    def test_what_is_lacking_is_named_and_no_failure_unless_all_is_required(self):
        steps = 'step "look" true\nneeds_here python:no_such_module\nstep "never" touch "$walk/never"\nend_door'
        ran, log = self.walk(steps)
        self.assertEqual(ran.returncode, 77)
        self.assertIn("door tiny cannot be walked: it needs no_such_module for /usr/bin/python3: scripts/setup.sh --doors", ran.stderr)
        self.assertIn("cannot be walked", log)
        self.assertNotIn("never", log)
        self.assertEqual(self.walk(steps, IST_REQUIRE_ALL="1")[0].returncode, 1)

    def test_what_a_page_shows_is_compared(self):
        page = self.folder / "page.md"
        ends = "```sh\necho {} 2 3\n```\n\n```\n1 … 3\n```\n"
        for number, status in (("1", 0), ("4", 1)):
            page.write_text(ends.format(number))
            ran, log = self.walk(f"source={self.folder}\nby_page page.md 'echo {number}'\nend_door")
            self.assertEqual(ran.returncode, status, ran.stderr)
            self.assertIn(f"$ echo {number} 2 3\n{number} 2 3\n", log)

    def test_an_option_that_is_not_known_is_refused(self):
        ran, log = self.walk("end_door", "--without-roots")
        self.assertEqual((ran.returncode, log), (2, ""))
        self.assertIn("tiny: unknown option --without-roots", ran.stderr)

    def test_all_that_the_doors_take_of_pages_is_there_once(self):
        taken = 0
        for name in DOORS:
            text = (HERE / f"{name}.sh").read_text()
            calls = [(page, verb, double or single or bare) for page, verb, double, single, bare in re.findall(
                r"block (\S+\.md) (block|line|compare) (?:\"([^\"]+)\"|'([^']+)'|([^\s)\"|]+))", text)]
            calls += [(page, "block", words) for page, words in re.findall(r'by_page(?:_alone)? (\S+) "([^"]+)"', text)]
            calls += [(page, "file", words) for page, words in re.findall(r"writes (\S+) (\S+)", text)]
            for page, verb, words in calls:
                with self.subTest(door=name, page=page, words=words):
                    verb = "block" if verb == "compare" else verb
                    ran = subprocess.run([sys.executable, "-B", HERE / "page_block.py", HERE.parents[1] / page, verb, words],
                                         capture_output=True, text=True, check=False)
                    self.assertEqual(ran.returncode, 0, ran.stderr)
                    self.assertTrue(ran.stdout.strip())
            taken += len(calls)
        self.assertGreater(taken, 15)


if __name__ == "__main__":
    unittest.main()
