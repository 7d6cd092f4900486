#!/usr/bin/env python3
"""Writes what mirrors the C headers, so that a struct or a function is written once, in its header:

  c_mirrors.py python FILE   the structs, numbers and prototypes of the Python package
  c_mirrors.py layout FILE   a C file that compares them with the compiler's
  c_mirrors.py calls FILE    tables of C++: every function with each pointer NULL, and with each handle replaced
"""

import pathlib
import re
import sys

FOLDER = pathlib.Path(__file__).resolve().parent / "include/ist/capi"
HEADERS = ["ist_status.h", "ist_c.h", "ist_measure.h", "ist_models.h", "ist_servo.h", "ist_sweep.h", "ist_world.h"]
# Each type of C has its bytes, and its names in ctypes and numpy.
TYPES = {
    "double": (8, "c_double", "f8"),
    "float": (4, "c_float", "f4"),
    "int16_t": (2, "c_int16", "i2"),
    "int32_t": (4, "c_int32", "i4"),
    "ist_status": (4, "c_int32", "i4"),
    "uint32_t": (4, "c_uint32", "u4"),
    "int64_t": (8, "c_int64", "i8"),
    "uint64_t": (8, "c_uint64", "u8"),
    "size_t": (8, "c_size_t", "u8"),
    "char": (1, "c_char", ""),
}
ALSO_ARRAYS = ["ist_contact_sums"]  # structs with a size, and Python has arrays of them too
DECLARATION = re.compile(r"(?:const )?(\w+)(\**) ?(\w+)(?:\[(\d+)\])?$")


class Member:
    """A member of a struct, or an argument of a function."""

    def __init__(self, text, doc=""):
        found = DECLARATION.match(text)
        if not found:
            raise SystemExit(f"c_mirrors: {text!r} is no declaration that this script knows")
        self.type, self.stars, self.name = found[1], len(found[2]), found[3]
        self.count = int(found[4] or 1)
        self.pointer = self.stars > 0
        self.is_array = found[4] is not None
        self.bytes = self.align = 8 if self.pointer else TYPES[self.type][0] if self.type in TYPES else 0


def names_to_members(text):
    """The members of `double lower, upper[3]`, each with the type."""
    head, *rest = [part.strip() for part in text.split(",")]
    base = re.match(r"(?:const )?\w+\**", head)[0]
    return [Member(head), *(Member(f"{base} {name}") for name in rest)]


class Struct:
    """A struct with its members and their places."""

    def __init__(self, name, body, known):
        self.name, self.members, self.reports = name, [], []
        for text in filter(None, (" ".join(part.split()) for part in body.split(";"))):
            function = re.match(r"(\w+) \(\*(\w+)\)\((.*)\)$", text)
            if function:
                self.reports.append((function[2], [function[1], *(part.split()[0] for part in function[3].split(", "))]))
                member = Member(f"void* {function[2]}")
                member.type = "function"
                self.members.append(member)
            else:
                self.members += names_to_members(text)
        self.sized = self.members[0].name == "struct_size"
        place = 0
        for member in self.members:
            if member.type in known and not member.pointer:
                member.bytes, member.align = known[member.type].bytes, known[member.type].align
            if place % member.align:
                raise SystemExit(f"c_mirrors: {name}.{member.name} begins at byte {place}: put a reserved member before it")
            member.place, place = place, place + member.bytes * member.count
        self.bytes, self.align = place, max(member.align for member in self.members)
        if place % self.align:
            raise SystemExit(f"c_mirrors: {name} has {place} bytes: put a reserved member at its end")


class Function:
    """A function with its arguments. `optional`: those that its comment says may be NULL."""

    def __init__(self, comment, result, name, arguments):
        self.name, self.result = name, result
        self.arguments = [] if arguments == "void" else [Member(part.strip()) for part in arguments.split(",")]
        comment = " ".join(comment.replace("*", " ").split())
        self.optional = {word for names in re.findall(r"((?:`\w+`(?:, and |, | and )?)+) may be NULL", comment)
                         for word in re.findall(r"`(\w+)`", names)}


def read():
    """The structs, handles, numbers and functions of all headers."""
    text = "\n".join((FOLDER / name).read_text(encoding="utf-8") for name in HEADERS)
    plain = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    handles = re.findall(r"typedef struct (\w+) \1;", plain)
    numbers = {name: int(number, 0) for name, number in re.findall(r"#define (IST_\w+) (\w+?)u?\b", plain) if number[0].isdigit()}
    for body in re.findall(r"\benum \{(.*?)\}", plain, re.DOTALL):
        numbers.update((name, int(number)) for name, number in re.findall(r"(\w+) = (\d+)", body))
    plain = re.sub(r"\[(IST_\w+)\]", lambda found: f"[{numbers[found[1]]}]", plain)
    structs = {}
    for body, name in re.findall(r"typedef struct [\w ]+\{(.*?)\} (\w+);", plain, re.DOTALL):
        structs[name] = Struct(name, body, structs)
    functions = [Function(*found) for found in re.findall(
        r"/\*\*((?:[^*]|\*(?!/))*)\*/\nIST_C_API ([\w ]+?\*?) ?(ist_\w+)\(([^)]*)\) IST_NOEXCEPT;", text)]
    if len(functions) != text.count("\nIST_C_API "):
        raise SystemExit("c_mirrors: a function has no comment right before it, or is written in another way")
    return structs, handles, numbers, functions


def short(name):
    return name.removeprefix("ist_")


def camel(name):
    return "".join(word.capitalize() for word in short(name).split("_"))


def ctype(member, structs):
    """The type of a member of a struct in ctypes."""
    if member.type == "function":
        return member.name.upper()
    if member.pointer and member.type == "char":
        return "c_char_p"
    if member.pointer:
        sized = member.type in structs and structs[member.type].sized
        return f"POINTER({camel(member.type)})" if sized else "c_void_p"
    if member.type in structs:  # as words, which numpy reads by the struct's dtype
        return f"c_uint64 * {member.bytes * member.count // 8}"
    return TYPES[member.type][1] + (f" * {member.count}" if member.is_array else "")


def argument_type(argument):
    if argument.pointer or argument.is_array:
        return "c_char_p" if argument.type == "char" else "c_void_p"
    return TYPES[argument.type][1]


def python(structs, handles, numbers, functions):
    yield '"""The structs, numbers and functions of the C headers. src/c/c_mirrors.py wrote this file."""\n'
    yield "import ctypes"
    yield "from ctypes import POINTER, c_char, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint32, c_uint64, c_void_p\n"
    yield "import numpy as np\n"
    yield from (f"{name} = {number}" for name, number in numbers.items())
    yield '\n\nclass Sized(ctypes.Structure):\n    """A struct that begins with its size."""\n'
    yield "    def __init__(self, **members):"
    yield "        super().__init__(struct_size=ctypes.sizeof(type(self)), **members)\n"
    for struct in structs.values():
        if struct.sized:
            for name, types in struct.reports:
                yield "\n{} = ctypes.CFUNCTYPE({})\n".format(
                    name.upper(), ", ".join("c_void_p" if "*" in kind else TYPES[kind][1] for kind in types))
            yield f"\nclass {camel(struct.name)}(Sized):\n    _fields_ = ["
            for member in struct.members:
                name = "from_" if member.name == "from" else member.name
                yield f'        ("{name}", {ctype(member, structs)}),'
            yield "    ]\n"
        if not struct.sized or struct.name in ALSO_ARRAYS:
            yield f"\n{short(struct.name).upper()} = np.dtype(\n    ["
            for member in struct.members:
                size = f", {member.count}" if member.is_array else ""
                yield f'        ("{member.name}", "{TYPES[member.type][2]}"{size}),'
            yield "    ]\n)\n"
    yield "\n# Addresses are passed as numbers: ctypes converts these fastest.\nPROTOTYPES = {"
    for function in functions:
        result = "c_char_p" if "*" in function.result else TYPES[function.result][1]
        yield f'    "{function.name}": ({result}, [{", ".join(map(argument_type, function.arguments))}]),'
    yield "}"


def layout(structs, handles, numbers, functions):
    yield "/* The places and numbers that c_mirrors.py counted, compared with the compiler's. */"
    yield from (f'#include "ist/capi/{header}"' for header in HEADERS)
    for name, (size, _, _) in TYPES.items():
        yield f'_Static_assert(sizeof({name}) == {size}, "{name} has another size");'
    for struct in structs.values():
        yield f'_Static_assert(sizeof({struct.name}) == {struct.bytes}, "{struct.name} has another size");'
        for member in struct.members:
            yield (f'_Static_assert(offsetof({struct.name}, {member.name}) == {member.place}, '
                   f'"{struct.name}.{member.name} is elsewhere");')
    for name, number in numbers.items():
        yield f'_Static_assert({name} == {number}, "{name} has another number");'


def calls(structs, handles, numbers, functions):
    # In a call each argument but one is sound: `s` has handles and a path, some<T>() has memory, and lengths are 1.

    def sound(function, at):
        argument = function.arguments[at]
        follows = function.arguments[at + 1].type if at + 1 < len(function.arguments) else ""
        if argument.pointer or argument.is_array:
            if argument.type in handles and argument.stars == 1:
                return f"s.{short(argument.type)}"
            is_optional = argument.name in function.optional or argument.type in ("ist_budget", "ist_progress")
            if is_optional and follows != "size_t":
                return "nullptr"
            if argument.type == "char":
                return "s.path"
            return f"some<{'unsigned char' if argument.type == 'void' else argument.type + '*' * (argument.stars - 1)}>()"
        return "1" if argument.type in ("double", "size_t") and argument.name != "index" else "0"

    def call(function, at, value):
        arguments = [value if i == at else sound(function, i) for i in range(len(function.arguments))]
        return f"return {function.name}({', '.join(arguments)});"

    asked = [function for function in functions if function.result == "ist_status"]
    yield "// c_mirrors.py wrote this file.\nconst NullCall kNullCalls[] = {"
    for function in asked:
        for at, argument in enumerate(function.arguments):
            value = sound(function, at)
            if (argument.pointer or argument.is_array) and value != "nullptr" and value != f"s.{short(argument.type)}":
                yield (f'    {{"{function.name}", "{argument.name}",\n'
                       f'     []([[maybe_unused]] const Sound& s) {{ {call(function, at, "nullptr")} }}}},')
    yield "};\nconst HandleCall kHandleCalls[] = {"
    for function in asked:
        for at, argument in enumerate(function.arguments):
            if argument.type in handles and argument.stars == 1:
                value = f"static_cast<{argument.type}*>(h)"
                yield (f'    {{"{function.name}", "{argument.name}", "{short(argument.type)}",\n'
                       f'     []([[maybe_unused]] const Sound& s, void* h) {{ {call(function, at, value)} }}}},')
    yield "};"


def main(kind, file):
    """Writes the file unless it is there with this content."""
    text = "\n".join({"python": python, "layout": layout, "calls": calls}[kind](*read())) + "\n"
    file = pathlib.Path(file)
    if file.is_file() and file.read_text(encoding="utf-8") == text:
        return
    new = file.with_name(f"{file.name}.new")
    new.write_text(text, encoding="utf-8")
    new.replace(file)


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("python", "layout", "calls"):
        sys.exit(__doc__)
    main(*sys.argv[1:])
