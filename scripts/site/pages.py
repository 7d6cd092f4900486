"""Makes FOLDER/site, a site of the pages, by mkdocs, and fails at its warnings. The site has all pages that links lead to from README.
site/reference is a copy of the reference that reference.sh made.

    pages.py FOLDER

Without mkdocs the exit code is 77; with IST_REQUIRE_ALL=1 it is 1. Runs by Debian's python."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = '<div id="the-page"></div>'
LINK = re.compile(r"\]\(([^)#\s]+)[^)\s]*\)")


def linked_files(first):
    """The files of the project that can be reached from a page."""
    found, ahead = set(), [ROOT / first]
    while ahead:
        file = ahead.pop()
        if file in found or not file.is_file():  # mkdocs names a link to nothing
            continue
        found.add(file)
        if file.suffix == ".md":
            text = re.sub(r"(?ms:^ *```.*?^ *```$)|`[^`\n]*`", "", file.read_text())
            ahead += [(file.parent / target).resolve() for target in LINK.findall(text) if ":" not in target]
    return found


def show_page(site):
    """Puts the page with the engine, if scripts/viewer.sh has made it, into the page about it."""
    made, about = ROOT / "build/viewer/ist.html", site / "docs/viewer.html"
    if not made.exists():
        print("pages: docs/viewer.html is without the page itself: scripts/viewer.sh makes that", file=sys.stderr)
        return
    shutil.copyfile(made, site / "docs/page.html")
    shown = '<iframe src="page.html" title="The page" style="width:100%;height:48rem;border:1px solid #999"></iframe>'
    html = about.read_text()
    if PAGE not in html:
        raise SystemExit(f"pages: {about} has no place for the page: {PAGE}")
    about.write_text(html.replace(PAGE, shown))


def main(folder):
    if shutil.which("mkdocs") is None:
        print("pages: skipped: mkdocs is not installed: scripts/setup.sh --docs does that", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77
    pages = folder / "pages"
    shutil.rmtree(pages, ignore_errors=True)
    for file in linked_files("README.md"):
        copy = pages / file.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copy)
    ran = subprocess.run(["mkdocs", "build", "--strict", "--config-file", ROOT / "scripts/site/mkdocs.yml", "--site-dir",
                          folder / "site"], env=dict(os.environ, IST_PAGES=str(pages)), check=False, capture_output=True, text=True)
    if ran.returncode != 0:
        print(ran.stdout + ran.stderr, file=sys.stderr)
        return ran.returncode
    for sitemap in (folder / "site").glob("sitemap.xml*"):  # of addresses, which nobody knows
        sitemap.unlink()
    show_page(folder / "site")
    if (folder / "reference/html").exists():
        shutil.copytree(folder / "reference/html", folder / "site/reference")
    print(f"pages: {len(list(pages.rglob('*.md')))} pages, without a warning")
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
