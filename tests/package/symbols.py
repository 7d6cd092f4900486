"""Holds what the shared library exports against exported_symbols.txt, which is reviewed like code.

    python3 symbols.py LIBRARY             fails where a name came, went, or may not get out
    python3 symbols.py LIBRARY --update    keeps what it exports now; never what may not get out"""

import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent / "src"
LIST = HERE / "exported_symbols.txt"
PUBLIC = SOURCE / "package/public_headers.txt"
# Tables and names of classes, which C++ makes by itself.
OF_CLASS = r"(?:vtable|typeinfo|typeinfo name) for "
STRANGERS = re.compile(rf"^(?:{OF_CLASS})?(?:\w+ )*(hwy|tbb|oneapi|assimp|Assimp|fmt|Eigen|nlohmann|toml|std|__gnu_cxx)::")


def exported(library):
    """Names, each with its version: IST_C_0 for C, IST_0.1 for C++."""
    lines = subprocess.run(["nm", "-DC", "--defined-only", library], capture_output=True, text=True,
                           check=True).stdout.splitlines()
    names = dict(line.split(maxsplit=2)[2].partition("@@")[::2] for line in lines)
    return {name: version for name, version in sorted(names.items()) if not re.fullmatch(r"IST_[\w.]+", name)}


def declared():
    """Names after IST_API in public headers, and after IST_C_API in those of the C interface."""
    cpp, c = set(), set()
    for header in re.findall(r"^ist/\S+", PUBLIC.read_text(), re.MULTILINE):
        text = re.sub(r"//[^\n]*", "", (SOURCE / header).read_text())
        cpp.update(re.findall(r"\b(?:class|struct) IST_API (\w+)", text))
        cpp.update(re.findall(r"\bIST_API [\w:<>,*&\s]*?(\w+)\(", text))
        c.update(re.findall(r"\bIST_C_API\b[^;(]*?\b(ist_\w+)\s*\(", text))
    return cpp, c


def flaw(name, version, cpp, c):
    """What is wrong with a name that is exported, or nothing."""
    if STRANGERS.match(name):
        return "is another library's"
    if version.startswith("IST_C_") != name.startswith("ist_"):
        return "has a version of the other language"
    if re.fullmatch(r"ist_\w+", name):
        return None if name in c else "is declared by no public C header"
    own = re.match(rf"(?:{OF_CLASS})?ist::(?:detail::)?(\w+)", name)
    if own is None:
        return "is not the project's"
    return None if own[1] in cpp else "is declared by no public header"


def main(library, *rest):
    names = exported(library)
    cpp, c = declared()
    flaws = [f"{name} {wrong}" for name in names if (wrong := flaw(name, names[name], cpp, c))]
    flaws += [f"{name} is declared in a public C header, and not exported" for name in sorted(c - set(names))]
    if not names or flaws:
        print("\n".join(["symbols: the library exports what it must not:"] + flaws[:20]), file=sys.stderr)
        print(f"symbols: {len(flaws)} of {len(names)} names", file=sys.stderr)
        return 1
    if "--update" in rest:
        LIST.write_text("\n".join(names) + "\n")
        print(f"{LIST} is written")
        return 0
    kept = LIST.read_text().splitlines()
    changes = [f"+ {name}" for name in names if name not in kept] + [f"- {name}" for name in kept if name not in names]
    if changes:
        print("\n".join(changes), file=sys.stderr)
        print("symbols: exported names changed. If that is meant, python3 tests/package/symbols.py LIBRARY --update keeps them: "
              "where one went, C++ needs a new minor version, and C a new SONAME", file=sys.stderr)
        return 1
    print(f"{len(names)} names, {len(c)} of them C functions")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
