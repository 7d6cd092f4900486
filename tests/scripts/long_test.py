"""Which long tests scripts/test.sh --long runs again, with a ctest that only prints."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts/test.sh"
CTEST = """#!/bin/bash
case "$*" in
  *-N*)
    echo "  Test #1: Long.one"
    echo "  Test #12: Long.two" ;;
  *)
    echo "asked $*"
    echo "1/2 Test  #1: Long.one .........   Passed    1.00 sec"
    echo "2/2 Test #12: Long.two .........***Failed    1.00 sec"
    exit 8 ;;
esac
"""


class Long(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.bin = pathlib.Path(folder.name) / "project", pathlib.Path(folder.name) / "bin"
        (self.root / "scripts").mkdir(parents=True)
        self.bin.mkdir()
        shutil.copy(SCRIPT, self.root / "scripts")
        for file, text in ((self.bin / "ctest", CTEST), (self.bin / "cmake", "#!/bin/sh\n"), (self.root / "scripts/setup.sh", "#!/bin/sh\n"),
                           (self.root / "scripts/viewer.sh", "#!/bin/sh\n"), (self.root / ".gitignore", "build/\n")):
            file.write_text(text)
            file.chmod(0o755)
        self.git("init", "-q")
        self.commit()

    def git(self, *words):
        subprocess.run(["git", "-C", self.root, "-c", "user.name=A", "-c", "user.email=a@example.org", *words], check=True, capture_output=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "a commit")

    def say(self, *words):
        done = subprocess.run([self.root / "scripts/test.sh", *words], capture_output=True, text=True,
                              env=os.environ | {"PATH": f"{self.bin}:{os.environ['PATH']}"})
        return done.returncode, done.stdout + done.stderr

    def asked(self, *words):
        return [line for line in self.say("--long", *words)[1].splitlines() if line.startswith("asked")]

    def test_a_test_that_passed_at_this_commit_is_not_run_again(self):
        code, said = self.say("--long")
        self.assertEqual(code, 8, said)
        self.assertIn(r"-R ^(Long\.one|Long\.two)$", said)
        self.assertIn(r"-R ^(Long\.two)$", self.asked()[0])
        self.assertEqual(self.say("--left")[0], 1)

    def test_another_commit_and_a_change_count_as_other_code(self):
        self.say("--long")
        (self.root / "new").write_text("")
        self.assertIn("Long.one|", "".join(self.asked()).replace("\\", ""))
        self.commit()
        self.assertIn("Long.one|", "".join(self.asked()).replace("\\", ""))

    def test_what_ran_with_changes_gets_no_stamp(self):
        (self.root / "new").write_text("")
        self.say("--long")
        (self.root / "new").unlink()
        self.assertIn("Long.one\nLong.two", self.say("--left")[1])

    def test_nothing_left_is_success(self):
        (self.bin / "ctest").write_text(CTEST.replace("echo \"  Test #12: Long.two\"", "true"))
        self.say("--long")
        self.assertEqual(self.say("--left")[0], 0)

    def test_a_word_that_names_no_test_is_refused(self):
        (self.bin / "ctest").write_text("#!/bin/sh\n")
        self.assertEqual(self.say("--long", "nonsense")[0], 2)


if __name__ == "__main__":
    unittest.main()
