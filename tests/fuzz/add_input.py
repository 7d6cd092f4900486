"""Adds inputs to the corpus of a fuzz target, tests/fuzz/corpus/TARGET.zip. Every run of fuzz_test replays them.

    python3 tests/fuzz/add_input.py TARGET OUTCOME.WHAT FILE [OUTCOME.WHAT FILE…]

OUTCOME is the word that the target must return for the input, for example `fine` or `mesh-empty`. An input that has the
same name already is replaced. Equal inputs make equal zip files: names are sorted, and times are fixed. A new target gets
a new zip file. Exit code 2 if a name is no OUTCOME.WHAT or a file cannot be read."""

import pathlib
import re
import sys
import zipfile

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus"
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*\.[a-z0-9]+(-[a-z0-9]+)*")


def read(path):
    """The inputs of a zip file by name, none if there is no file."""
    if not path.exists():
        return {}
    with zipfile.ZipFile(path) as inputs:
        return {name: inputs.read(name) for name in inputs.namelist()}


def write(path, inputs):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for name in sorted(inputs):
            entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            entry.create_system = 3  # Unix, whose permissions follow
            entry.external_attr = 0o644 << 16
            out.writestr(entry, inputs[name], zipfile.ZIP_DEFLATED, 9)


def main(arguments):
    if len(arguments) < 3 or len(arguments) % 2 == 0:
        return __doc__
    target, added = arguments[0], dict(zip(arguments[1::2], arguments[2::2]))
    for name in [target + ".zip", *added]:
        if not NAME.fullmatch(name):
            return f"add_input: {name}: a name is OUTCOME.WHAT, of small letters, digits and hyphens"
    try:
        inputs = {name: pathlib.Path(file).read_bytes() for name, file in added.items()}
    except OSError as error:
        return f"add_input: {error.filename}: {error.strerror}"
    path = CORPUS / f"{target}.zip"
    write(path, read(path) | inputs)
    return 0


if __name__ == "__main__":
    said = main(sys.argv[1:])
    if said:
        print(said, file=sys.stderr)
    sys.exit(2 if said else 0)
