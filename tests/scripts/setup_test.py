"""Refusals of setup.sh, test.sh and lint.sh: one line with the remedy."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).parents[2] / "scripts"
# All that the script may call beside the stubs of a test.
TOOLS = ("bash", "cat", "dirname", "dpkg", "env", "grep", "mktemp", "rm", "sed", "tail")


class Refusals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bin = pathlib.Path(folder.name)
        for tool in TOOLS:
            (self.bin / tool).symlink_to(shutil.which(tool))
        self.stub("dpkg-query", "exit 1")  # no package is installed

    def stub(self, name, body):
        (self.bin / name).write_text(f"#!/usr/bin/env bash\n{body}\n")
        (self.bin / name).chmod(0o755)

    def refused(self, code, script, *words):
        """Runs a script that must end with this code. Returns its one line of errors."""
        ran = subprocess.run([SCRIPTS / script, *words], env={"PATH": str(self.bin)}, capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, code, ran.stderr)
        lines = ran.stderr.splitlines()
        self.assertEqual(len(lines), 1, ran.stderr)
        return lines[0]

    def test_unknown_words(self):
        self.assertEqual(self.refused(2, "setup.sh", "--tset"), "setup: unknown option --tset; see --help")
        self.stub("nproc", "echo 2")
        self.assertIn('no label or option "fats": take fast, slow', self.refused(2, "test.sh", "fats"))
        self.assertIn('"slow" is a second one', self.refused(2, "test.sh", "fast", "slow"))
        self.assertIn('no tool "tidy": take clang-format', self.refused(2, "lint.sh", "tidy"))

    def test_users_who_may_not_install(self):
        self.stub("id", "echo 1000")
        self.assertIn("neither root nor has sudo: ask for apt-get install g++ cmake", self.refused(1, "setup.sh"))

    def test_no_network(self):
        self.stub("id", "echo 0")
        self.stub("apt-get", 'case "$*" in *update*) ;; *) echo reading; echo "E: Failed to fetch http://a/b.deb"; exit 100 ;; esac')
        self.assertIn("apt-get failed (E: Failed to fetch http://a/b.deb): check the network", self.refused(1, "setup.sh"))


if __name__ == "__main__":
    unittest.main()
