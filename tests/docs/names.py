"""Checks the names in capitals on README and the pages of docs: each is in a public header, or is an option of CMake or a
variable of the environment that something reads."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NAME = re.compile(r"\bIST_[A-Z][A-Z0-9_]*\b")
# option(NAME …) and set(NAME "…" CACHE …) of CMake; getenv("NAME"), environ["NAME"], environ.get("NAME"), $ENV{NAME}, ${NAME:-…}.
READ = re.compile(r"\b(?:option\(|set\((?=\w+ \"[^\"]*\" CACHE)|getenv\(\"|environ(?:\[|\.get\()\"|ENV\{)(IST_\w+)|\$\{(IST_\w+):-")
SOURCES = ("*.cpp", "*.h", "*.py", "*.sh", "*.cmake", "CMakeLists.txt")


def known():
    """The names of the public headers, without their comments, and those that something reads."""
    names = set()
    for header in re.findall(r"^ist/\S+", (ROOT / "src/package/public_headers.txt").read_text(), re.MULTILINE):
        names.update(NAME.findall(re.sub(r"(?s)/\*.*?\*/|//[^\n]*", "", (ROOT / "src" / header).read_text())))
    files = [ROOT / "CMakeLists.txt"]
    files += (file for folder in ("src", "tests", "scripts", "bench") for kind in SOURCES for file in (ROOT / folder).rglob(kind))
    for file in files:
        names.update(one or other for one, other in READ.findall(file.read_text()))
    return names


def unknown(text, names):
    """The lines of a page that have a name which is not known, and these names."""
    return [(number, name) for number, line in enumerate(text.splitlines(), 1) for name in NAME.findall(line) if name not in names]


def main():
    pages, names = [ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "src").glob("*/README.md")], known()
    wrong = [f"{page.relative_to(ROOT)}:{number}: there is no {name}" for page in pages for number, name in unknown(page.read_text(), names)]
    print("\n".join(wrong), file=sys.stderr)
    print(f"{len(pages)} pages, {len(names)} names, {len(wrong)} that are not there")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
