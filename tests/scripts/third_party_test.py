"""How scripts/release/third_party.py finds whose files are used, and what it makes of that."""

import os
import pathlib
import sys
import tempfile
import tomllib
import unittest

RELEASE = pathlib.Path(__file__).parents[2] / "scripts/release"
sys.path.insert(0, str(RELEASE))
import third_party  # noqa: E402  after its folder is known

ENTRIES = tomllib.loads((RELEASE / "third_party.toml").read_text())["library"]
SMALL = [{"name": "One", "licence": "MIT", "owners": ["one-dev", "one"]},
         {"name": "Two", "licence": "Zlib", "owners": ["/opt/two/*"], "version": "one", "texts": ["/none/of/these"]}]


class Owners(unittest.TestCase):
    def test_a_file_of_a_package_is_that_package_s(self):
        header, library = "/usr/include/fmt/format.h", os.path.realpath("/usr/lib/x86_64-linux-gnu/libz.so.1")
        self.assertEqual(third_party.owners({header, library}), {header: "libfmt-dev", library: "zlib1g"})

    def test_a_file_of_nobody_is_its_own(self):
        self.assertEqual(third_party.owners({"/usr/include/nobody.h"}), {"/usr/include/nobody.h": "/usr/include/nobody.h"})
        self.assertEqual(third_party.owners(set()), {})

    def test_the_project_s_own_files_do_not_count(self):
        uses = third_party.Uses("/tmp/project")
        uses.add("wheel", third_party.COMPILED, {"/tmp/project/a.h", "/usr/include/fmt/format.h"})
        self.assertEqual({owner: dict(places) for owner, places in uses.items()}, {"libfmt-dev": {"wheel": {third_party.COMPILED}}})


class Entries(unittest.TestCase):
    USES = {"one": {"wheel": {third_party.LOADED}}, "one-dev": {"wheel": {third_party.COMPILED}, "page": {third_party.LINKED}}}

    def test_an_owner_without_an_entry_is_an_error(self):
        with self.assertRaisesRegex(SystemExit, "without an entry in third_party.toml: /opt/other, three"):
            third_party.by_entry({**self.USES, "three": {}, "/opt/other": {}}, SMALL)

    def test_uses_of_all_owners_are_joined_and_what_is_not_used_is_left_out(self):
        found = third_party.by_entry(self.USES, SMALL)
        self.assertEqual(list(found), ["One"])
        _, own, places = found["One"]
        self.assertEqual((own, places), (["one", "one-dev"], {"wheel": {third_party.LOADED, third_party.COMPILED}, "page": {third_party.LINKED}}))

    def test_a_pattern_fits_files_below_its_folder_alone(self):
        self.assertEqual(third_party.entry_of("/opt/two/include/a.h", SMALL)["name"], "Two")
        self.assertIsNone(third_party.entry_of("/opt/three/a.h", SMALL))

    def test_a_licence_that_is_missing_is_an_error(self):
        with self.assertRaisesRegex(SystemExit, "/none/of/these, the licence of Two, is missing"):
            third_party.texts_of(SMALL[1], ["/opt/two/a.h"], pathlib.Path("/"))

    def test_versions_are_those_of_the_authors(self):
        with tempfile.TemporaryDirectory() as folder:
            said = pathlib.Path(folder, "dpkg-query")
            said.write_text("#!/bin/sh\necho $SAID\n")
            said.chmod(0o755)
            before = dict(os.environ)
            self.addCleanup(os.environ.update, before)
            os.environ["PATH"] = f"{folder}:{before['PATH']}"
            for debian, version in {"9.1.0+ds1 9.1.0+ds1": "9.1.0", "1.2.13.dfsg": "1.2.13", "2.3.9~dfsg": "2.3.9",
                                    "5.0.10+really4.7.0~dfsg": "4.7.0", "12.2.0": "12.2.0"}.items():
                os.environ["SAID"] = debian
                self.assertEqual(third_party.version_of({}, ["a"], None), version)

    def test_every_entry_is_whole_and_owns_what_no_other_does(self):
        owners = [owner for entry in ENTRIES for owner in entry["owners"]]
        self.assertEqual(len(owners), len(set(owners)))
        for entry in ENTRIES:
            self.assertTrue(entry["name"] and entry["licence"] and entry["owners"], entry)
            self.assertLessEqual(set(entry), {"name", "licence", "owners", "version", "texts"})


class Site(unittest.TestCase):
    def test_a_copy_is_known_by_its_content_and_another_script_is_not(self):
        with tempfile.TemporaryDirectory() as folder:
            site, theme = pathlib.Path(folder, "site"), pathlib.Path(folder, "theme")
            for place, text in ((theme / "base.js", "a"), (site / "js/own.js", "a"), (site / "strange.css", "b"), (site / "empty.js", ""),
                                (site / "index.html", "c")):
                place.parent.mkdir(parents=True, exist_ok=True)
                place.write_text(text)
            found, unknown = third_party.copies(site, theme)
            self.assertEqual((found, unknown), ({str((theme / "base.js").resolve())}, {str(site / "strange.css")}))


class Notices(unittest.TestCase):
    def test_each_library_has_version_licence_use_and_text_and_common_licences_stand_at_the_end(self):
        with tempfile.TemporaryDirectory() as folder:
            text = pathlib.Path(folder, "copyright")
            text.write_text("Copyright Ada. See /usr/share/common-licenses/Apache-2.0.\n")
            entry = {"name": "Headers of fmt", "licence": "MIT", "owners": ["libfmt-dev"], "texts": [str(text)]}
            found = third_party.by_entry({"libfmt-dev": {"wheel": {third_party.COMPILED, third_party.LINKED}}}, [entry])
            said = third_party.notices(found, None, "1.2.3")
        self.assertRegex(said, r"(?m)^Headers of fmt \d+\.\d[\d.]*\n    licence: MIT\n    used: wheel \(compiled in, linked in\)$")
        self.assertIn("IST 1.2.3 ", said)
        self.assertIn("Copyright Ada.", said)
        self.assertIn("TERMS AND CONDITIONS FOR USE", said.partition("Copyright Ada.")[2])

    def test_a_library_that_the_page_s_own_notices_lack_is_an_error(self):
        entry = {"name": "One, with two", "licence": "MIT", "owners": ["one"]}
        for places, said in (({"page": set()}, "One. Copyright"), ({"wheel": set()}, "nothing")):
            third_party.check_page({entry["name"]: (entry, ["one"], places)}, said)
        with self.assertRaisesRegex(SystemExit, "not named in src/viewer/notices.txt: One, with two"):
            third_party.check_page({entry["name"]: (entry, ["one"], {"page": set(), "wheel": set()})}, "nothing")


if __name__ == "__main__":
    unittest.main()
