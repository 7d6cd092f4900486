"""What scripts/release.sh refuses, what it makes and how it compares: in a small project of its own, whose build takes no time.
And the version, which has one place."""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
from unittest import mock

SOURCE = pathlib.Path(__file__).parents[2]
TIME = 1700000000
FILES = {
    "CMakeLists.txt": "project(ist VERSION 1.2.3 DESCRIPTION small)\n",
    ".gitignore": "build/\n",
    "scripts/setup.sh": "#!/bin/sh\n",
    "scripts/check_figures.sh": "#!/bin/sh\n[ ! -e figures ] || { cat figures; exit 1; }\n",
    "scripts/test.sh": '#!/bin/sh\n[ "$1" = --left ] || exit 2\n[ ! -e runs ] || { cat runs; exit 1; }\n',
    # What it has been given, and what the sources say of their commit.
    "scripts/release/build.sh": '#!/bin/sh\nset -e\ncd "$(dirname "$0")/../.."\nout=$1\nshift\n'
                                'echo "$@" >"$out/options"\ncmake -P src/package/commit.cmake >"$out/time"\n. ./more.sh\n',
    "more.sh": "",
}
KEPT = ("scripts/release.sh", "scripts/version.sh", "src/package/commit.cmake", "src/package/commit.txt", ".gitattributes")


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        self.project = self.folder / "project"
        for name, text in FILES.items():
            self.write(name, text)
            (self.project / name).chmod(0o755)
        for name in KEPT:
            (self.project / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.project / name)
        self.git("init", "-q")
        self.commit()

    def write(self, name, text):
        (self.project / name).parent.mkdir(parents=True, exist_ok=True)
        (self.project / name).write_text(text)

    def git(self, *words):
        environment = {**os.environ, **{f"GIT_{who}_{what}": value for who in ("AUTHOR", "COMMITTER")
                                        for what, value in (("NAME", "A"), ("EMAIL", "a@example.org"), ("DATE", f"{TIME} +0900"))}}
        return subprocess.run(["git", "-C", self.project, *words], env=environment, check=True, capture_output=True, text=True).stdout

    def commit(self, **files):
        for name, text in files.items():
            self.write(name, text)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "a commit")

    def release(self, *options, project=None):
        (self.folder / "temporary").mkdir(exist_ok=True)
        environment = {name: value for name, value in os.environ.items() if name != "SOURCE_DATE_EPOCH"}
        return subprocess.run([(project or self.project) / "scripts/release.sh", *options], capture_output=True, text=True,
                              timeout=300, env={**environment, "TMPDIR": str(self.folder / "temporary")})

    def refused(self, code, *options, project=None):
        done = self.release(*options, project=project)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertFalse((self.project / "build").exists(), "a folder was made")
        return done.stderr

    def made(self, *options, name="ist-1.2.3"):
        before = {*(self.folder / "temporary").glob("*")}  # of builds that failed
        done = self.release(*options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual({*(self.folder / "temporary").iterdir()}, before)
        return done.stdout, self.project / "build" / name

    def test_a_wrong_option_is_named(self):
        for option in ("--nonsense", "-DIST_WERROR=ON", "-DIST_MAINTAINER="):
            self.assertIn(f"unknown option {option}; see --help", self.refused(2, option))

    def test_its_help_names_every_option(self):
        said = self.release("--help").stdout
        for option in ("--out", "--once", "--despite-figures", "-DIST_MAINTAINER", "-DIST_HOMEPAGE", "Exit codes"):
            self.assertIn(option, said)
        self.assertNotIn("set -euo", said)

    def test_a_tree_that_differs_from_its_commit_is_refused(self):
        self.write("new.txt", "")
        self.assertIn("the working tree differs from its commit: commit, or remove\n?? new.txt", self.refused(1))
        (self.project / "new.txt").unlink()
        self.write("more.sh", "echo\n")
        self.assertIn(" M more.sh", self.refused(1))

    def test_what_is_no_checkout_is_refused_within_another_one_too(self):
        inner = self.project / "inner"
        shutil.copytree(self.project / "scripts", inner / "scripts")
        self.assertIn("no git checkout", self.refused(1, project=inner))
        shutil.rmtree(self.project / ".git")
        self.assertIn("no git checkout", self.refused(1))

    def test_a_folder_that_is_there_is_left_alone(self):
        there = self.folder / "there"
        there.mkdir()
        self.assertIn(f"{there} is there already", self.refused(1, "--out", str(there)))

    def test_stale_figures_are_named_and_make_a_draft_at_most(self):
        self.commit(runs="a part failed\n")
        self.assertIn("a part failed\n", self.refused(1))
        self.commit(figures="docs/page.md:7: measured long ago\n")
        said = self.refused(1)
        self.assertIn("docs/page.md:7: measured long ago\na part failed\n", said)
        self.assertIn("--despite-figures", said)
        said, folder = self.made("--despite-figures", name="ist-1.2.3-draft")
        self.assertIn("this is a draft", said)
        self.assertTrue((folder / "SHA256SUMS").exists())

    def test_a_folder_of_a_draft_is_always_called_so(self):
        for options, name in (("--despite-figures",), "mine"), (("--once",), "yours"), (("--despite-figures", "--once"), "ours-draft"):
            _, folder = self.made(*options, "--out", f"build/{name}", name=f"{name.removesuffix('-draft')}-draft")
            self.assertTrue((folder / "SHA256SUMS").exists())
        self.assertEqual(len(list((self.project / "build").iterdir())), 3)

    def test_what_was_made_is_kept_where_it_cannot_be_copied(self):
        full = self.folder / "bin/cp"
        full.parent.mkdir()
        full.write_text('#!/bin/sh\n/bin/cp "$@"\n[ "$1" != -r ]\n')
        full.chmod(0o755)
        with mock.patch.dict(os.environ, PATH=f"{full.parent}:{os.environ['PATH']}"):
            done = self.release()
        self.assertEqual(done.returncode, 1)
        self.assertEqual(list((self.project / "build").iterdir()), [])
        kept = pathlib.Path(re.search(r"release: what was made so far is in (.*)", done.stderr)[1])
        self.assertTrue((kept / "made-first/SHA256SUMS").exists())

    def test_the_folder_has_all_files_and_their_hashes(self):
        said, folder = self.made()
        files = sorted(file.name for file in folder.iterdir())
        self.assertEqual(files, ["SHA256SUMS", "ist-1.2.3-source.tar.gz", "options", "time"])
        hashes = "".join(f"{hashlib.sha256((folder / name).read_bytes()).hexdigest()}  {name}\n" for name in files[1:])
        self.assertEqual((folder / "SHA256SUMS").read_text(), hashes)
        self.assertTrue(said.endswith(hashes), said)
        self.assertIn("both builds have the same bytes", said)

    def test_the_archive_is_of_the_commit_and_knows_its_time(self):
        _, folder = self.made("--once", name="ist-1.2.3-draft")
        archive = folder / "ist-1.2.3-source.tar.gz"
        self.assertEqual(archive.read_bytes()[3:8], bytes(5), "gzip keeps a name or a time")
        listed = subprocess.run(["tar", "tvzf", archive, "--utc", "--full-time"], capture_output=True, text=True, check=True).stdout
        names = [line.split()[-1] for line in listed.splitlines()]
        self.assertEqual(names, sorted(names))
        self.assertIn("ist-1.2.3/more.sh", names)
        self.assertEqual({tuple(line.split()[3:5]) for line in listed.splitlines()}, {("2023-11-14", "22:13:20")})
        self.assertEqual((folder / "time").read_text(), f"{TIME}\n")
        text = subprocess.run(["tar", "xzOf", archive, "ist-1.2.3/src/package/commit.txt"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(text, f"{self.git('rev-parse', 'HEAD')}{TIME}\n")

    def test_an_archive_within_another_checkout_keeps_its_own_commit(self):
        _, folder = self.made("--once", name="ist-1.2.3-draft")
        inner = self.project / "build/inner"
        inner.mkdir()
        subprocess.run(["tar", "xzf", folder / "ist-1.2.3-source.tar.gz", "-C", inner], check=True)
        self.git("commit", "-q", "--allow-empty", "-m", "another", "--date", "1")
        script = inner / "print.cmake"
        script.write_text("include(${CMAKE_CURRENT_LIST_DIR}/ist-1.2.3/src/package/commit.cmake)\nist_commit(commit seconds)\n"
                          "ist_format_time(${seconds} %Y-%m-%d date)\nmessage(\"${commit} ${date}\")\n")
        said = subprocess.run(["cmake", "-P", script], capture_output=True, text=True, check=True).stderr
        self.assertEqual(said, f"{self.git('rev-parse', 'HEAD~')[:8]} 2023-11-14\n")

    def test_a_build_with_other_bytes_is_named(self):
        self.commit(**{"more.sh": 'pwd >"$out/place"\necho same >"$out/other"\n'})
        said = self.refused(1)
        self.assertIn("the second build has other bytes", said)
        self.assertIn("place", said)
        self.assertNotIn("other ", said.partition("bytes:")[2])
        said, _ = self.made("--once", name="ist-1.2.3-draft")
        self.assertIn("built once: that another build has the same bytes is not shown, so this is a draft", said)

    def test_a_build_with_one_file_more_is_named(self):
        self.commit(**{"more.sh": 'case $PWD in *second*) touch "$out/extra" ;; esac\n'})
        self.assertRegex(self.refused(1), r"Only in .*second.*: extra")

    def test_a_build_that_fails_shows_why(self):
        self.commit(**{"more.sh": "echo the reason\nfalse\n"})
        said = self.refused(1)
        self.assertIn("the reason\nrelease: the build first failed", said)

    def test_it_says_whom_the_packages_name(self):
        said, folder = self.made("--once", name="ist-1.2.3-draft")
        self.assertIn('IST_MAINTAINER is unset: the packages say "IST developers"', said)
        self.assertIn("IST_HOMEPAGE is unset", said)
        self.assertEqual((folder / "options").read_text(), "\n")
        shutil.rmtree(folder)
        options = ["-DIST_MAINTAINER=Ada Example <ada@example.org>", "-DIST_HOMEPAGE=https://example.org"]
        said, folder = self.made("--once", *options, name="ist-1.2.3-draft")
        self.assertNotIn("unset", said)
        self.assertEqual((folder / "options").read_text(), " ".join(options) + "\n")


class Version(unittest.TestCase):
    """Of this project: project() of CMakeLists.txt has it, and a heading of CHANGELOG.md."""

    version = re.search(r"project\(ist VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]

    def test_the_changelog_begins_with_it(self):
        text = (SOURCE / "CHANGELOG.md").read_text()
        first = re.search(r"(?ms)^## (.*?)\n(.*?)(?=^## |\Z)", text)
        self.assertEqual(first[1], self.version)
        self.assertEqual(re.findall(r"(?m)^### (.*)$", first[2]), ["API", "Features", "Fixes"])

    def test_no_other_file_has_it(self):
        names = [SOURCE / name for folder in ("src", "simd", "scripts", "docs", "examples", "tests/package", "tests/python")
                 for name in (SOURCE / folder).rglob("*")]
        text = re.compile(rf"(?<![\d.]){re.escape(self.version)}(?![\d.])")
        found = []
        for file in names:
            if file.is_file() and file.suffix in (".cpp", ".h", ".py", ".md", ".txt", ".cmake", ".in", ".toml", ".sh", ".js", ".mjs", ".json") \
                    and "node_modules" not in file.parts and file.name != "package-lock.json" and text.search(file.read_text(errors="replace")):
                found.append(str(file.relative_to(SOURCE)))
        self.assertEqual(found, [])

    def test_who_looks_for_the_package_asks_for_it(self):
        minor = self.version.rpartition(".")[0]
        files = [*(SOURCE / "docs").glob("*.md"), SOURCE / "README.md", *(SOURCE / "examples").rglob("CMakeLists.txt")]
        asked = {(file.name, version) for file in files for version in re.findall(r"find_package\(ist ([\d.]+)", file.read_text())}
        self.assertEqual(asked, {("building.md", minor), ("CMakeLists.txt", minor)})

    def test_the_package_of_node_has_none(self):
        self.assertNotIn('"version"', (SOURCE / "src/viewer/package.json").read_text())


if __name__ == "__main__":
    unittest.main()
