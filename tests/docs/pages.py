"""Reads the code of README and docs: fenced blocks, and the notes that stand before them.

A note is an HTML comment that begins with `snippet:`. It says of the next block

    file NAME          that it is a file, which is written before what follows runs;
    not run, REASON    that it is not run;
    compiled, REASON    that it is compiled and not run, with the headers of stubs/ for libraries that are not there;
    output varies, REASON    that what it prints is not compared.

Two notes hold code of their own, which no reader needs to see: `setup`, a script that runs first, and `before`, C++ that
stands before the page's fragments. What a page could mean otherwise than it is read here is an error, a PageError.
"""

import dataclasses
import re

FENCE = re.compile(r"^ *```([^`\s]*)\s*$")
NOTE = re.compile(r"^<!-- snippet: ")
NOTES = re.compile(r"file \S+|(?:not run|compiled|output varies), \S.*", re.S)


class PageError(Exception):
    """A page that cannot be read: where, and why."""

    def __init__(self, line, why):
        super().__init__(f"line {line}: {why}")


@dataclasses.dataclass
class Block:
    language: str
    text: str
    line: int  # of the fence, counted from 1
    note: str = ""

    def says(self, word):
        return self.note.startswith(word)


@dataclasses.dataclass
class Page:
    blocks: list
    setup: str = ""
    before: str = ""


def end_of(lines, begin, is_end, number, what):
    """The first line from `begin` on that is an end of what begins in line `number`."""
    for at in range(begin, len(lines)):
        if is_end(lines[at]):
            return at
    raise PageError(number, f"this {what} has no end")


def read(text):
    """The blocks of a page, in order."""
    page = Page([])
    lines = text.splitlines()
    note, at = "", 0
    while at < len(lines):
        line, number = lines[at], at + 1
        if note and line.strip() and not FENCE.match(line):
            raise PageError(number, f"no block follows the note: {note}")
        if NOTE.match(line):
            begin, at = at, end_of(lines, at, lambda each: each.rstrip().endswith("-->"), number, "note")
            said = NOTE.sub("", "\n".join(lines[begin:at + 1])).rsplit("-->", 1)[0].strip()
            word, _, code = said.partition("\n")
            if word in ("setup", "before"):
                setattr(page, word, code + "\n")
            elif NOTES.fullmatch(said):
                note = said
            else:
                raise PageError(number, f"this note is not known, or gives no reason: {said}")
        elif "```" in line or "~~~" in line:
            fence = FENCE.match(line)
            if not fence:
                raise PageError(number, f"a block begins with ``` and at most one word, alone in its line: {line.strip()}")
            at = end_of(lines, at + 1, FENCE.match, number, "block")
            if FENCE.match(lines[at])[1]:
                raise PageError(number, "this block has no end before the next one begins")
            page.blocks.append(Block(fence[1], "\n".join(lines[number:at]) + "\n", number, note))
            note = ""
        at += 1
    if note:
        raise PageError(len(lines), f"no block follows the note: {note}")
    return page
