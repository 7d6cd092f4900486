"""What a page tells its readers to type, for the doors: its blocks as tests/docs/pages.py reads them.

    page_block.py PAGE block WORDS          the one block that holds WORDS
    page_block.py PAGE file NAME            the block that is the file NAME
    page_block.py PAGE line WORDS           the one line of the blocks that holds WORDS
    page_block.py PAGE compare WORDS FILE   fails unless FILE is what the page shows below the block that holds WORDS

A block or a line that is not there once is an error: then page and door have drifted apart.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
import pages  # noqa: E402
from snippets import is_output  # noqa: E402


def the_one(found, what):
    if len(found) != 1:
        sys.exit(f"page_block: {len(found)} of this page's are {what}, and a door types the one")
    return found[0]


def main(page, verb, words, printed=None):
    blocks = pages.read(pathlib.Path(page).read_text()).blocks
    holders = [i for i, block in enumerate(blocks) if block.language and words in block.text]
    if verb == "block":
        print(blocks[the_one(holders, f"blocks with '{words}'")].text, end="")
    elif verb == "file":
        print(the_one([block.text for block in blocks if block.note == f"file {words}"], f"the file {words}"), end="")
    elif verb == "line":
        lines = [line for i in holders for line in blocks[i].text.splitlines()]
        print(the_one([line for line in lines if words in line], f"lines with '{words}'"))
    elif verb == "compare":
        after = the_one(holders, f"blocks with '{words}'") + 1
        if after == len(blocks) or blocks[after].language:
            sys.exit(f"page_block: {page} shows no output below the block with '{words}'")
        shown, real = blocks[after].text, pathlib.Path(printed).read_text()
        if not is_output(shown, real):
            sys.exit(f"page_block: {page}, line {blocks[after].line}, shows\n{shown}\nand this is printed:\n{real}")
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(*sys.argv[1:])
