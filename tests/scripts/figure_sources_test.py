"""What figures rest on: all that a benchmark includes, and the flags that it is compiled with."""

import json
import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
import mutants  # noqa: E402  after its folder is known
from report import figures, flags  # noqa: E402


class Sources(unittest.TestCase):
    """What benchmarks include is what their figures rest on."""

    @staticmethod
    def includes(file):
        """The project's files that a source includes. A header of users stands for those that it gathers, and for its room."""
        for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M):
            for folder in ("src", file.relative_to(figures.ROOT).parts[0], "bench", "tests", "."):
                found = figures.ROOT / folder / name
                if found.exists() and found.parent == figures.ROOT / "src/ist":
                    yield from Sources.includes(found)
                    yield from [room.relative_to(figures.ROOT) for room in [found.with_suffix("")] if room.is_dir()]
                elif found.exists():
                    yield found.relative_to(figures.ROOT)
                else:
                    continue
                break

    @staticmethod
    def unlisted(program):
        """The files that a benchmark includes, it or those of the tests that are compiled into it, and does not rest on."""
        own = [figures.ROOT / f"bench/{program}.cpp", *(figures.ROOT / "bench" / program.removesuffix("_bench")).rglob("*.*")]
        return Sources.not_among(figures.sources_of(program), [file for file in own if file.suffix in (".h", ".cpp") and file.exists()])

    @staticmethod
    def not_among(rests, waiting):
        """What these files include, they or those of the tests that they include, beside what figures rest on."""
        seen = set()
        while waiting:
            file = waiting.pop()
            for name in Sources.includes(file):
                if name in seen:
                    continue
                seen.add(name)
                if name.parts[0] == "tests":
                    waiting += filter(pathlib.Path.exists, (figures.ROOT / name, (figures.ROOT / name).with_suffix(".cpp")))
        return sorted(str(name) for name in seen if not Sources.is_among(rests, name))

    @staticmethod
    def is_among(rests, name):
        return any(name == pathlib.Path(rest) or pathlib.Path(rest) in name.parents for rest in rests)

    @staticmethod
    def stability_sources():
        """The sources of the programs that scripts/stability_report.sh runs."""
        programs = re.search(r"^programs=\((.*)\)$", (figures.ROOT / "scripts/stability_report.sh").read_text(), re.M)[1].split()
        found = {}
        for listing in (figures.ROOT / "tests").rglob("CMakeLists.txt"):
            for program, sources in re.findall(r"ist_add_test\((\w+)\s([^)]*)\)", listing.read_text()):
                if program in programs:
                    found[program] = [listing.parent / name for name in sources.split() if name.endswith(".cpp")]
        assert sorted(found) == sorted(programs), found
        return [source for sources in found.values() for source in sources]

    def test_every_benchmark_rests_on_what_it_includes(self):
        programs = sorted(file.stem for file in (figures.ROOT / "bench").glob("*_bench.cpp")) + ["peers_bench"]
        self.assertIn("sweep_bench", programs)
        for program in programs:
            self.assertEqual(self.unlisted(program), [], program)

    def test_stability_rests_on_its_programs_and_what_they_include(self):
        rests, own = figures.sources_of("stability_report.sh"), self.stability_sources()
        self.assertEqual([str(file) for file in own if not self.is_among(rests, file.relative_to(figures.ROOT))], [])
        self.assertEqual(self.not_among(rests, own), [])
        self.assertIn("src/cli/page/page_file.h", self.not_among([rest for rest in rests if rest != "src/cli"], self.stability_sources()))

    def test_mutants_rest_on_the_files_that_they_break(self):
        broken = {pathlib.Path(file) for mutant in mutants.MUTANTS for file, _, _ in mutant.edits}
        self.assertIn(pathlib.Path("scripts/try.py"), broken)
        self.assertEqual([str(file) for file in broken if not self.is_among(figures.sources_of("mutate.sh"), file)], [])

    def test_a_room_that_is_not_listed_is_found(self):
        for program, room in (("sweep_bench", "src/ist/sweep"), ("accuracy_bench", "src/ist/haptics"), ("peers_bench", "src/ist/measure"),
                              ("deadline_bench", "tests/support/conformal.h"), ("loop_bench", "src/ist/scene")):
            rests = figures.RESTS[program]
            self.addCleanup(figures.RESTS.__setitem__, program, rests)
            figures.RESTS[program] = [rest for rest in rests if rest != room]
            self.assertTrue(any(name.startswith(room) for name in self.unlisted(program)), (program, room))


class Flags(unittest.TestCase):
    """Of CMake's files only what changes the compiled code counts."""

    TEXT = "project(ist VERSION 1)\nif(GCC)  # (why)\n  target_compile_options(ist INTERFACE -O3 -Wall)\nendif()\n"

    def same(self, one, other, name="CMakeLists.txt"):
        return flags.of(name, one, ["bench"]) == flags.of(name, other, ["bench"])

    def test_a_flag_counts(self):
        self.assertFalse(self.same(self.TEXT, self.TEXT.replace("-O3", "-O2")))

    def test_the_condition_of_a_flag_counts(self):
        self.assertFalse(self.same(self.TEXT, self.TEXT.replace("if(GCC)", "if(NOT GCC)")))
        self.assertFalse(self.same(self.TEXT, self.TEXT.replace("if(GCC)", "if(GCC)\nelse()")))

    def test_versions_warnings_and_comments_do_not(self):
        for old, new in (("VERSION 1", "VERSION 2"), (" -Wall", " -Wextra"), (" -Wall", " -fno-sanitize=vptr"), ("why", "a reason"),
                         ("endif()", "  target_compile_options(ist INTERFACE -fmacro-prefix-map=/=)\nendif()\nadd_library(b c.cpp)")):
            self.assertTrue(self.same(self.TEXT, self.TEXT.replace(old, new)), new)

    def test_what_a_preset_inherits_counts_and_other_presets_do_not(self):
        def text(**kinds):
            presets = [{"name": "base", "cacheVariables": {"TYPE": kinds.get("base", "Release")}},
                       {"name": "bench", "displayName": kinds.get("shown", ""), "inherits": "base", "cacheVariables": {"BENCHES": "ON"}},
                       {"name": "fuzz", "inherits": "base", "cacheVariables": {"FUZZ": kinds.get("fuzz", "ON")}}]
            return json.dumps({"configurePresets": presets})

        self.assertFalse(self.same(text(), text(base="Debug"), "CMakePresets.json"))
        self.assertTrue(self.same(text(), text(fuzz="OFF", shown="a name"), "CMakePresets.json"))


if __name__ == "__main__":
    unittest.main()
