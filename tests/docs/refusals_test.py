"""Tests the tests of the pages: what each of them has to refuse, it refuses, and says where and why."""

import contextlib
import io
import pathlib
import shutil
import tempfile
import unittest

import guards
import names
import pages
import snippets

NOTE = "<!-- snippet: {} -->\n"


def block(language, text="nonsense\n"):
    return f"```{language}\n{text}```\n"


class Pages(unittest.TestCase):
    def refuses(self, text, *parts):
        with self.assertRaises(pages.PageError) as refused:
            pages.read(text)
        for part in parts:
            self.assertIn(part, str(refused.exception))

    def test_fences_that_would_hide_a_block(self):
        self.refuses("a page\n\n~~~sh\nfalse\n~~~\n", "line 3", "~~~sh")
        self.refuses('```sh title="x"\nfalse\n```\n', "line 1", 'title="x"')
        self.refuses("> ```sh\n> false\n> ```\n", "line 1", "> ```sh")
        self.refuses(block("`sh"), "line 1", "````sh")
        self.refuses("\n```sh\nfalse\n", "line 2", "no end")
        self.refuses("```sh\nfalse\n" + block("sh"), "line 1", "before the next one")

    def test_notes_without_a_reason_or_a_block(self):
        for note in ("not run", "not run,", "output varies", "compiled, ", "runs elsewhere", "file"):
            self.refuses(NOTE.format(note) + block("sh"), "line 1", note.strip())
        self.refuses(NOTE.format("not run, since") + "words\n" + block("sh"), "line 2", "not run, since")
        self.refuses(NOTE.format("file a.sh") * 2 + block("sh"), "line 2", "file a.sh")
        self.refuses(block("sh") + NOTE.format("file a.sh"), "line 4", "file a.sh")
        self.refuses("<!-- snippet: setup\nfalse\n", "line 1", "no end")

    def test_a_page_as_it_should_be(self):
        page = pages.read("<!-- snippet: setup\ntrue\n-->\n\n" + NOTE.format("not run, since it is long") + block("sh") + block(""))
        self.assertEqual([(each.language, each.text, each.line) for each in page.blocks], [("sh", "nonsense\n", 6), ("", "nonsense\n", 9)])
        self.assertEqual((page.setup, page.blocks[0].note), ("true\n", "not run, since it is long"))


class Snippets(unittest.TestCase):
    def reads(self, text, ist="exit 1\n"):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            there = pathlib.Path(folder)
            (there / "bin").mkdir()
            (there / "bin/ist").write_text(f"#!/bin/sh\n{ist}")
            (there / "bin/ist").chmod(0o755)
            (there / "lib/pkgconfig").mkdir(parents=True)
            (there / "lib/pkgconfig/ist_loop.pc").write_text("Name: ist_loop\nDescription: none\nVersion: 0\n")
            reader = snippets.Reader("page.md", there, there, "g++")
            reader.read(pages.read(text))
            return reader.counts

    def refuses(self, text, *parts):
        with self.assertRaises(snippets.Failure) as refused:
            self.reads(text)
        for part in parts:
            self.assertIn(part, str(refused.exception))

    def test_languages_that_nothing_runs(self):
        for language in ("c++", "bash", "console", "text", "shell"):
            self.refuses(block(language), "page.md, line 1", f"'{language}'")
            self.refuses(NOTE.format("not run, since it is long") + block(language), "line 2", f"'{language}'")
        for language in ("cmake", "json", "csv", "toml"):
            self.refuses(block(language), "page.md, line 1", f"this {language} needs the note")

    def test_scenes_and_sweeps_are_read_by_the_command(self):
        scene, sweep = (NOTE.format("file a.toml") + block("toml", text) for text in ("[fixed]\n", "[fixed]\n[[poses.axes]]\n"))
        by_run, by_sweep = '[ "$1 $3" = "run --check" ]\n', '[ "$1 $3 $5" = "sweep -o --share" ]\n'
        self.assertEqual(self.reads(scene, by_run)["run"], 1)
        self.assertEqual(self.reads(sweep, by_sweep)["run"], 1)
        self.refuses(scene, "page.md, line 2", "ist run", "failed with 1")
        self.refuses(sweep.replace("[[poses.axes]]", "[poses.box]"), "page.md, line 2", "ist sweep", "failed with 1")

    def test_what_a_command_prints(self):
        self.assertEqual(self.reads(block("sh", "echo 1\n") + block("", "1\n"))["compared"], 1)
        self.refuses(block("sh", "echo 1\n") + block("", "2\n"), "line 4", "the page shows\n2")
        self.refuses(block("sh", "echo 1\n") + block("text", "2\n"), "line 4", "'text'")
        self.refuses(block("", "1\n"), "line 1", "follows nothing that prints")
        self.refuses(block("sh", "exit 3\n"), "line 1", "failed with 3")

    def test_blocks_of_python_are_one_program(self):
        first = block("python", "one = 1\nprint('first', end='')\n") + block("", "first\n")
        self.assertEqual(self.reads(first + block("python", "print(one + 1)\n") + block("", "2\n"))["compared"], 2)
        self.refuses(first + block("python", "print(one + 1)\n") + block("", "3\n"), "line 11", "the page shows\n3", "printed:\n2")
        self.refuses(block("python", "print(one)\n") + first, "line 1", "NameError")
        self.refuses(first + block("python", "raise SystemExit(0)\n"), "line 8", "this Python failed")

    def test_a_block_that_shows_what_it_prints(self):
        first = block("python", ">>> one = 1\n>>> one + 1\n2\n")
        self.assertEqual(self.reads(first + block("python", ">>> one\n1\n"))["run"], 2)
        self.refuses(first + block("python", ">>> one\n2\n"), "line 6", "Expected:\n    2\nGot:\n    1")

    def test_a_file_of_python_is_a_program_of_its_own(self):
        first = block("python", "one = 1\n") + NOTE.format("file own.py")
        self.assertEqual(self.reads(first + block("python", "print(__file__[-6:])\n") + block("", "own.py\n"))["compared"], 1)
        self.refuses(first + block("python", "print(one)\n"), "line 5", "NameError")

    @unittest.skipUnless(shutil.which(snippets.OTHER_COMPILER), "scripts/setup.sh --package installs the other compiler")
    def test_code_that_is_compiled_alone(self):
        note = NOTE.format("compiled, since a library is missing")
        with_stub = "#include <chai3d.h>\nvoid set(chai3d::cWorld& world) { world.setLocalPos({1.0, 2.0, 3.0}); }\n"
        self.assertEqual(self.reads(note + block("cpp", with_stub))["compiled"], 1)
        self.refuses(note + block("cpp", with_stub.replace("setLocalPos", "setPlace")), "line 2", "setPlace")
        self.refuses(note + block("c", with_stub), "line 2", "only cpp")


class Names(unittest.TestCase):
    def test_names_that_are_not_there(self):
        known = names.known()
        self.assertEqual(names.unknown("a\nb `IST_ERROR_HANDLE` and IST_OK\n", known), [(2, "IST_ERROR_HANDLE")])
        self.assertEqual(names.unknown("IST_OK, IST_MOST_BODIES, IST_API, -D IST_WITH_TBB=OFF, IST_LIBRARY=a.so\n", known), [])

    def test_scripts_that_are_not_there_or_left_out(self):
        def wrong(text):
            return names.scripts_wrong(text, {"test.sh", "mutate.sh", "mutate.py", "build_table.py"}, {"own_test.py"})

        self.assertEqual(wrong("`test.sh`, `mutate.sh`, `build_table.py`; a `*_test.py`, as own_test.py\n"), [])
        self.assertEqual(wrong("`tests.sh`, `mutate.sh`, `build_table.py`\n"), ["there is no tests.sh", "test.sh is not named"])


class Guards(unittest.TestCase):
    def flaws(self, invariants, presets=("test",)):
        text = f"# Way\n\n## What must stay true\n\n{invariants}\n## Recipes\n\nDo it with preset `test`.\n"
        return guards.flaws(text, {"Real", "Other"}, presets)

    def test_names_of_tests(self):
        self.assertEqual(self.flaws("- **A.** `Real`,\n  `Other`. They do `anything`\n- **B**: quiet. `Other`\n"), ([], 3))
        self.assertEqual(self.flaws("- **A.** `Real`,\n  `NoSuchTest`\n"), (["'A.' names NoSuchTest, and there is no such test"], 2))
        self.assertEqual(self.flaws("- **A.** words\n"), (["'A.' names no test"], 0))

    def test_guarantees(self):
        head = "# Page\n\n### Each guarantee, its tests, and a mutant that they kill\n\n| guarantee | tests | mutant |\n|---|---|---|\n"

        def flaws(row):
            return guards.flaws_of_guarantees(f"{head}{row}\n\n## Next\n", {"Real.Thing", "Some/Other.Thing/1"},
                                              {"broken", "lives", "elsewhere", "proven"},
                                              {"broken": "Real.Thing", "elsewhere": "Other.Thing", "proven": guards.PROOF})

        self.assertEqual(flaws("| It holds | `Real`, `Some/Other.Thing` | `broken` |"), ([], 2))
        self.assertEqual(flaws("| It holds | `Rea`, `Real` | `broken` |")[0], ["'It holds' names Rea, and there is no such test"])
        self.assertEqual(flaws("| It holds |  | `broken` |")[0], ["'It holds' names no test: "])
        self.assertEqual(flaws("| It holds | `Real` | none |")[0], ["'It holds' names no mutant: none"])
        self.assertEqual(flaws("| It holds | `Real` | `gone` |")[0], ["'It holds' names gone, and there is no such mutant"])
        self.assertEqual(flaws("| It holds | `Real` | `proven` |"), ([], 1))
        self.assertEqual(flaws("| It holds | `Real` | `elsewhere` |")[0],
                         ["'It holds' names elsewhere, and Other.Thing killed it, none of its tests"])
        self.assertEqual(flaws("| It holds | `Real` | `lives` |")[0], ["'It holds' names lives, and no test has killed it: scripts/mutate.py lives"])

    def test_lines_without_a_title(self):
        wrong, _ = self.flaws("- **A.** `Real`\n- Untitled. `NoSuchTest`\n")
        self.assertEqual(wrong, ["this stands under no title, which is bold: - Untitled. `NoSuchTest`"])

    def test_presets(self):
        self.assertEqual(self.flaws("- **A.** `Real`, preset `thread`\n")[0], ["there is no preset thread"])
        self.assertEqual(self.flaws("- **A.** `Real`\n", presets=())[0], ["there is no preset test"])
        self.assertEqual(self.flaws("- **A.** `Real`. Other presets: `test`, `none`.\n")[0], ["there is no preset none"])


if __name__ == "__main__":
    unittest.main()
