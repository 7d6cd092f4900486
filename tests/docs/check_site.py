"""Makes the site of pages and reference as scripts/docs.sh does, and checks it: every link of a page leads somewhere, also to
the heading that it names; the navigation has every page; nothing is loaded from elsewhere; no page shows Markdown.

    check_site.py FOLDER

FOLDER has the reference of scripts/site/reference.sh. Where a tool is missing, that is said, and the exit code is 77; with
IST_REQUIRE_ALL=1 it is 1."""

import html.parser
import os
import pathlib
import re
import subprocess
import sys
import urllib.parse

import pages as sources

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LOADS = {"script": "src", "img": "src", "iframe": "src", "source": "src", "object": "data", "link": "href"}
ELSEWHERE = re.compile(r"(\w+:)?//")
MARKDOWN = re.compile(r"\|\s*:?---|```|<!--|\]\(|^#+ |\*\*\w", re.M)


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.names, self.loaded, self.shown, self.code, self.blocks = [], set(), [], "", 0, 0
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.names |= {values.get("id"), values.get("name")}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        if tag in LOADS and values.get(LOADS[tag]) and values.get("rel") != "canonical":
            self.loaded.append(values[LOADS[tag]])
        self.code += tag in ("code", "pre", "script")
        self.blocks += tag == "pre"

    def handle_endtag(self, tag):
        self.code -= tag in ("code", "pre", "script")

    def handle_data(self, data):
        if not self.code:
            self.shown += data

    def handle_comment(self, data):
        self.shown += "<!-- snippet" if data.startswith(" snippet") else ""


def flaws(folder):
    """What is wrong, a line each, and how many links were followed."""
    site = folder / "site"
    pages = {file: Page(file.read_text()) for file in site.rglob("*.html")}
    own = {file for file in pages if not file.is_relative_to(site / "reference")}
    wrong, followed = [], 0
    for file, page in pages.items():
        name = file.relative_to(site)
        wrong += [f"{name} loads {what}" for what in page.loaded if ELSEWHERE.match(what)]
        if file not in own or file.name in ("404.html", "search.html", "page.html"):
            continue
        wrong += [f"{name} shows {found[0]!r}" for found in MARKDOWN.finditer(page.shown)]
        for link in page.links:
            if urllib.parse.urlsplit(link).scheme:
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (file.parent / path).resolve() if path else file
            followed += 1
            if not target.is_file():
                wrong.append(f"{name}: {link}: no such file")
            elif anchor and anchor not in pages[target].names:
                wrong.append(f"{name}: {link}: no such heading")
    for file in site.rglob("*.css"):
        wrong += [f"{file.relative_to(site)} loads {what}"
                  for what in re.findall(r"(?:url\(|@import )['\"]?((?:\w+:)?//[^'\")\s]+)", file.read_text())]
    # docs/viewer.html shows page.html. The page of answers to a search has the navigation and nothing else.
    reached = {(site / link.partition("#")[0]).resolve() for link in pages[site / "search.html"].links}
    wrong += [f"{file.relative_to(site)}: not in the navigation"
              for file in own - reached if file.name not in ("404.html", "search.html", "page.html")]
    for source in (folder / "pages").rglob("*.md"):
        made = source.relative_to(folder / "pages").with_suffix(".html")
        made = made.with_name("index.html") if made.name == "README.html" else made
        expected, blocks = len(sources.read(source.read_text()).blocks), pages[site / made].blocks
        if blocks < expected:
            wrong.append(f"{made}: {blocks} blocks of code of {expected}")
    return wrong, followed


def main(folder):
    if not (folder / "reference/html").exists():
        print("site: skipped: it has no reference: scripts/setup.sh --docs installs doxygen", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77
    made = subprocess.run([sys.executable, "-B", ROOT / "scripts/site/pages.py", folder], check=False)
    if made.returncode != 0:
        return made.returncode
    wrong, followed = flaws(folder)
    for line in wrong:
        print(line, file=sys.stderr)
    print(f"{followed} links, {len(wrong)} flaws")
    return 1 if wrong or followed == 0 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
