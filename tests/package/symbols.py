"""Compares the exports of the shared libraries with exported_symbols.txt, which is reviewed like code. It leaves out
what libist exports for libist_loop alone.

    python3 symbols.py LIBRARY...             fails if a name came, went, or must not be exported
    python3 symbols.py LIBRARY... --update    writes the list, if each name may be exported"""

import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent / "src"
LIST = HERE / "exported_symbols.txt"
# Tables and names of classes, which C++ makes by itself.
OF_CLASS = r"(?:vtable|typeinfo|typeinfo name) for "
STRANGERS = re.compile(rf"^(?:{OF_CLASS})?(?:\w+ )*(hwy|tbb|oneapi|assimp|Assimp|fmt|Eigen|nlohmann|toml|std|__gnu_cxx)::")


def exported(libraries):
    """Names, each with its version: IST_C_0 for C, IST_0.1 for C++."""
    lines = subprocess.run(["nm", "-DC", "--defined-only", *libraries], capture_output=True, text=True,
                           check=True).stdout.splitlines()
    names = dict(line.split(maxsplit=2)[2].partition("@@")[::2] for line in lines if line.count(" ") > 1)
    return {name: version for name, version in sorted(names.items()) if not re.fullmatch(r"IST_[\w.]+", name)}


def marked(mark, text):
    """The classes and functions that the header's text declares after a mark."""
    return {*re.findall(rf"\b(?:class|struct) {mark} (\w+)", text), *re.findall(rf"\b{mark} [\w:<>,*&\s]*?(\w+)\(", text)}


def declared():
    """Names after IST_API in public headers, after IST_C_API in those of C, and after IST_LOOP_API in all headers."""
    headers = [SOURCE / name for name in re.findall(r"^ist/\S+", (SOURCE / "package/public_headers.txt").read_text(), re.M)]
    headers += SOURCE.glob("*/include/**/*.h")
    text = re.sub(r"//[^\n]*", "", "".join(header.read_text() for header in headers))
    c = set(re.findall(r"\bIST_C_API\b[^;(]*?\b(ist_\w+)\s*\(", text))
    internal = "".join(header.read_text() for room in ("ist", "c") for header in (SOURCE / room).rglob("*.h"))
    return marked("IST_API", text), c, marked("IST_LOOP_API", internal)


def owner(name):
    """The class or function of namespace ist that a symbol belongs to, and its member, or None."""
    return re.match(rf"(?:{OF_CLASS})?ist::(?:(?:detail|capi)::)?(\w+)(?:::(\w+))?", name)


def is_internal(name, cpp, internal):
    """Whether libist exports a symbol for libist_loop alone."""
    own = owner(name)
    return own is not None and own[1] not in cpp and (own[1] in internal or own[2] in internal)


def flaw(name, version, cpp, c):
    """What is wrong with a name that is exported, or None."""
    if STRANGERS.match(name):
        return "is another library's"
    if version.startswith("IST_C_") != name.startswith("ist_"):
        return "has a version of the other language"
    if re.fullmatch(r"ist_\w+", name):
        return None if name in c else "is declared by no public C header"
    own = owner(name)
    if own is None:
        return "is not the project's"
    return None if own[1] in cpp else "is declared by no public header"


def main(*arguments):
    libraries = [word for word in arguments if word != "--update"]
    cpp, c, internal = declared()
    names = {name: version for name, version in exported(libraries).items() if not is_internal(name, cpp, internal)}
    flaws = [f"{name} {wrong}" for name in names if (wrong := flaw(name, names[name], cpp, c))]
    flaws += [f"{name} is declared in a public C header, and not exported" for name in sorted(c - set(names))]
    if not names or flaws:
        print("\n".join(["symbols: the libraries export what they must not:"] + flaws[:20]), file=sys.stderr)
        print(f"symbols: {len(flaws)} of {len(names)} names", file=sys.stderr)
        return 1
    if "--update" in arguments:
        LIST.write_text("\n".join(names) + "\n")
        print(f"{LIST} is written")
        return 0
    kept = LIST.read_text().splitlines()
    changes = [f"+ {name}" for name in names if name not in kept] + [f"- {name}" for name in kept if name not in names]
    if changes:
        print("\n".join(changes), file=sys.stderr)
        print("symbols: exported names changed. If that is meant, python3 tests/package/symbols.py LIBRARY... --update writes the "
              "list. If a name went, C++ needs a new minor version, and C a new SONAME", file=sys.stderr)
        return 1
    print(f"{len(names)} names, {len(c)} of them C functions")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
