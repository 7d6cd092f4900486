"""Checks every link and picture of the pages: the file is there, and so is the heading that a link names. Every page of docs
is reached from README, and every page with code is run by a test, whose pages are the arguments."""

import pathlib
import re
import subprocess
import sys

import pages

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def without_code(text):
    text = re.sub(r"(?ms)^ *```.*?^ *```$", "", text)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(text):
    """The names that GitHub gives the headings."""
    found = set()
    for heading in re.findall(r"(?m)^#+ +(.*)$", re.sub(r"(?ms)^ *```.*?^ *```$", "", text)):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        found.add(re.sub(r"[^\w\- ]", "", plain).replace(" ", "-"))
    return found


def main():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*.md"], capture_output=True, text=True, check=False)
    # A tree without git, such as an unpacked archive, has no other pages than its own.
    names = listed.stdout.splitlines() or [str(p.relative_to(ROOT)) for p in ROOT.rglob("*.md") if "build" not in p.parts]
    texts = {name: (ROOT / name).read_text() for name in names if (ROOT / name).exists()}
    wrong, links, linked = [], 0, set()
    for name, text in texts.items():
        for target in LINK.findall(without_code(text)):
            if target.startswith(("http://", "https://", "mailto:")):
                continue
            links += 1
            path, _, anchor = target.partition("#")
            file = (ROOT / name).parent / path if path else ROOT / name
            if not file.exists():
                wrong.append(f"{name}: {target}: no such file")
                continue
            at = str(file.resolve().relative_to(ROOT))
            if name == "README.md":
                linked.add(at)
            if anchor and anchor not in anchors(texts.get(at, "")):
                wrong.append(f"{name}: {target}: no such heading")
    for name, text in texts.items():
        if re.fullmatch(r"docs/[\w-]+\.md", name) and name not in linked:
            wrong.append(f"{name}: README does not link to it")
        try:
            has_code = any(block.language for block in pages.read(text).blocks)
        except pages.PageError as error:
            wrong.append(f"{name}, {error}")
            continue
        if has_code and name not in sys.argv[1:]:
            wrong.append(f"{name}: its code is run by no test")
    for line in wrong:
        print(line, file=sys.stderr)
    print(f"{links} links in {len(texts)} pages, {len(wrong)} wrong")
    return 1 if wrong or links == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
