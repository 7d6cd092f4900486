#!/usr/bin/env python3
"""Reads a page of HTML as strictly as XML, and prints its content as JSON.

    read_html.py PAGE FOLDER

    text      all that is shown, words parted by single spaces
    tables    by their ids: rows of cells, as shown; the head first
    lists     by the id of what they are in: their items
    elements  how many there are of each
    outside   references to anything outside of the page: there should be none
    images    widths, heights and alternative texts; their bytes are in FOLDER, 0.png and so on

Ends with 1 where the page is not well-formed, or an id stands twice.
"""
import base64
import collections
import json
import pathlib
import re
import sys
import xml.etree.ElementTree as tree
from html.parser import HTMLParser

REFERENCES = {"href", "src", "srcset", "action", "data", "poster", "background", "cite", "formaction", "xlink:href"}


class Nesting(HTMLParser):
    """That HTML's own rules close each element where XML's do."""

    VOID = {"meta", "img", "br", "hr", "link", "input", "source", "wbr", "col", "base", "area", "embed", "track"}

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attributes):
        assert tag not in self.VOID, f"<{tag}> is not closed"
        self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        in_svg = "svg" in self.open
        assert in_svg or tag in self.VOID, f"<{tag} /> is not closed in HTML"

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> in {self.open}"
        self.open.pop()


def shown(element):
    return " ".join("".join(element.itertext()).split())


def main(page, folder):
    content = pathlib.Path(page).read_text(encoding="utf-8")
    assert content.startswith("<!DOCTYPE html>\n<html lang=")
    nesting = Nesting()
    nesting.feed(content)
    nesting.close()
    assert not nesting.open, nesting.open
    root = tree.fromstring(content)
    elements = list(root.iter())
    ids = [e.get("id") for e in elements if e.get("id")]
    assert len(ids) == len(set(ids)), ids
    outside, images = [], []
    for element in elements:
        for name, value in element.attrib.items():
            if name in REFERENCES and not value.startswith(("#", "data:image/png;base64,")):
                outside.append(value)
            if "url(" in value or name.startswith("on"):
                outside.append(value)
        if element.tag == "style":
            outside += re.findall(r"@import|url\([^)]*\)|https?:|//[a-z]", element.text)
        if element.tag == "img":
            bytes_ = base64.b64decode(element.get("src").removeprefix("data:image/png;base64,"), validate=True)
            (pathlib.Path(folder) / f"{len(images)}.png").write_bytes(bytes_)
            images.append({key: element.get(key) for key in ("width", "height", "alt")})
    json.dump({
        "text": shown(root.find("body")),
        "tables": {table.get("id"): [[shown(cell) for cell in row] for row in table.iter("tr")] for table in root.iter("table")},
        "lists": {e.get("id"): [shown(item) for item in e.iter("li")] for e in root.iter("div") if e.get("id")},
        "elements": collections.Counter(e.tag for e in elements),
        "outside": outside,
        "images": images,
        "title": root.findtext("head/title"),
        "all": re.sub(r"base64,[A-Za-z0-9+/=]*", "", content),
    }, sys.stdout)


if __name__ == "__main__":
    main(*sys.argv[1:])
