"""Checks the names in capitals on README and the pages of docs: each is in a public header, or is an option of CMake or a
variable of the environment that something reads. Checks that lists of mesh formats are complete. Checks the names of
scripts in HACKING: each is there, and none is left out."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NAME = re.compile(r"\bIST_[A-Z][A-Z0-9_]*\b")
# option(NAME …) and set(NAME "…" CACHE …) of CMake; getenv("NAME"), environ["NAME"], environ.get("NAME"), $ENV{NAME}, ${NAME:-…}.
READ = re.compile(r"\b(?:option\(|set\((?=\w+ \"[^\"]*\" CACHE)|getenv\(\"|environ(?:\[|\.get\()\"|ENV\{)(IST_\w+)|\$\{(IST_\w+):-")
SCRIPT = re.compile(r"\b[a-z]\w*\.(?:sh|py|mjs)\b")
SOURCES = ("*.cpp", "*.h", "*.py", "*.sh", "*.cmake", "CMakeLists.txt")


def known():
    """The names of the public headers, without their comments, and those that something reads."""
    names = set()
    listed = re.findall(r"^ist/\S+", (ROOT / "src/package/public_headers.txt").read_text(), re.MULTILINE)
    for header in [*(ROOT / "src" / name for name in listed), *(ROOT / "src").glob("*/include/**/*.h")]:
        names.update(NAME.findall(re.sub(r"(?s)/\*.*?\*/|//[^\n]*", "", header.read_text())))
    files = [ROOT / "CMakeLists.txt"]
    files += (file for folder in ("src", "tests", "scripts", "bench") for kind in SOURCES for file in (ROOT / folder).rglob(kind))
    for file in files:
        names.update(one or other for one, other in READ.findall(file.read_text()))
    return names


def unknown(text, names):
    """The lines of a page that have a name which is not known, and these names."""
    return [(number, name) for number, line in enumerate(text.splitlines(), 1) for name in NAME.findall(line) if name not in names]


def scripts_wrong(text, scripts, others):
    """What is wrong with the names of scripts in a text: those that neither `scripts` nor `others` have, and those of `scripts`
    that it leaves out. A file of Python behind a shell script of the same name needs none of its own."""
    named = set(SCRIPT.findall(text))
    needed = {name for name in scripts if name.removesuffix(".py") + ".sh" not in scripts}
    return [f"there is no {name}" for name in sorted(named - scripts - others)] + [f"{name} is not named" for name in sorted(needed - named)]


def formats_left_out():
    """The places that list the formats of meshes, and the formats that they leave out."""
    listed = re.search(r'kMeshFormats =\s*"([^"]*)"', (ROOT / "src/ist/mesh/format/mesh_readers.h").read_text())[1]
    formats = [name.removesuffix(" PolyData") for name in re.split(", | or ", listed)]
    places = [ROOT / "docs/command.md", ROOT / "src/ist/mesh/mesh.h", ROOT / "src/python/ist/_mesh.py", *(ROOT / "src").rglob("ist_c.h")]
    return [f"{place.relative_to(ROOT)}: the format {name} is not listed" for place in places for name in formats
            if not re.search(rf"\b{re.escape(name)}\b", place.read_text())]


def main():
    pages, names = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "src").glob("*/README.md")], known()
    wrong = [f"{page.relative_to(ROOT)}:{number}: there is no {name}" for page in pages for number, name in unknown(page.read_text(), names)]
    scripts = {file.name for file in (ROOT / "scripts").iterdir() if SCRIPT.fullmatch(file.name)}
    others = {file.name for folder in ("tests", "src", "bench", "examples", "scripts") for file in (ROOT / folder).rglob("*")
              if SCRIPT.fullmatch(file.name)}
    wrong += [f"HACKING.md: {what}" for what in scripts_wrong((ROOT / "HACKING.md").read_text(), scripts, others)]
    wrong += formats_left_out()
    print("\n".join(wrong), file=sys.stderr)
    print(f"{len(pages)} pages, {len(names)} names, {len(wrong)} that are not there")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
