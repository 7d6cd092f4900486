"""What of CMake's files decides the code that a compiler makes. A version, a name or a warning does not: figures do not age by it."""

import json
import re

# Of the whole project; other rooms count with all that their CMakeLists.txt says.
FILES = ["CMakeLists.txt", "CMakePresets.json", "bench/CMakeLists.txt", "src/ist/CMakeLists.txt", "src/platform.cmake"]
COMMAND = re.compile(r'^\s*(\w+)\s*\(((?:[^()"]|"(?:\\.|[^"\\])*"|\((?:[^()]|\([^()]*\))*\))*)\)', re.M)
COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|#[^\n]*')
WORD = re.compile(r'(?:[^\s"]|"(?:\\.|[^"\\])*")+')
SETTERS = re.compile(r"(add|target)_(compile|link)_(options|definitions|features)|set_(source_files|target)_properties")
# Options of a compiler that leave the code as it is: warnings, names of folders, the compiler's own memory, and exceptions from
# sanitizers, under which no figure is measured.
IDLE = re.compile(r"-W|-f\w+-prefix-map=|-fno-sanitize=|--param=ggc-")
SCOPES = {"INTERFACE", "PRIVATE", "PUBLIC"}


def of(name, text, presets):
    """Returns that part of the text of one of FILES, for what the presets build."""
    if name.endswith(".json"):
        known = {preset["name"]: preset for preset in json.loads(text)["configurePresets"]}
        return [_settings(known, preset) for preset in presets]
    return _statements(text)


def _settings(known, name):
    """What a preset sets, with what it inherits."""
    preset, merged = known.get(name, {}), {}
    parents = preset.get("inherits", [])
    for parent in reversed([parents] if isinstance(parents, str) else parents):
        merged.update(_settings(known, parent))
    merged.update(preset.get("cacheVariables", {}), **{key: preset[key] for key in ("environment", "toolchainFile") if key in preset})
    return merged


def _statements(text):
    """Each command that sets options of the compiler or of the linker, with the conditions that it stands under."""
    conditions, found = [], []
    for command, arguments in COMMAND.findall(COMMENT.sub(lambda match: match.group(1) or "", text)):
        words = WORD.findall(arguments)
        if command == "if":
            conditions.append([words])
        elif command == "elseif":
            conditions[-1] = [*conditions[-1], words]
        elif command == "else":
            conditions[-1] = [*conditions[-1], "else"]
        elif command == "endif":
            conditions.pop()
        elif command == "option" and words[0].startswith("IST_WITH_") or command == "set" and words[0].startswith("CMAKE_"):
            found.append((list(conditions), command, words[0], words[-1] if command == "option" else words[1:]))
        elif SETTERS.fullmatch(command):
            kept = [word for word in words if not IDLE.match(word)]
            if kept == words or set(kept[1:]) - SCOPES:
                found.append((list(conditions), command, kept))
    return found
