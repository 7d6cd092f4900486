"""Reads the code of README and docs: fenced blocks, and the notes that stand before them.

A note is an HTML comment that begins with `snippet:`. It says of the next block

    file NAME          that it is a file, which is written before what follows runs;
    not run, REASON    that it is not run;
    output varies, REASON    that what it prints is not compared.

Two notes hold code of their own, which no reader needs to see: `setup`, a script that runs first, and `before`, C++ that
stands before the page's fragments.
"""

import dataclasses
import re

FENCE = re.compile(r"^ *```(\S*)\s*$")
NOTE = re.compile(r"^<!-- snippet: ")


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


def read(text):
    """The blocks of a page, in order."""
    page = Page([])
    lines = text.splitlines()
    note, at = "", 0
    while at < len(lines):
        if NOTE.match(lines[at]):
            begin = at
            while not lines[at].rstrip().endswith("-->"):
                at += 1
            comment = "\n".join(lines[begin:at + 1])
            said = NOTE.sub("", comment).rsplit("-->", 1)[0].strip()
            word, _, code = said.partition("\n")
            if word in ("setup", "before"):
                setattr(page, word, code + "\n")
            else:
                note = said
        elif fence := FENCE.match(lines[at]):
            begin = at
            at += 1
            while not FENCE.match(lines[at]):
                at += 1
            page.blocks.append(Block(fence[1], "\n".join(lines[begin + 1:at]) + "\n", begin + 1, note))
            note = ""
        elif lines[at].strip() and note:
            raise ValueError(f"line {at + 1}: a note stands before no block: {note}")
        at += 1
    return page
