"""Writes the notices of the libraries of others in a release, and of the shared libraries that it loads: name, version, licence, uses, and the text
of the licence. Fails if a release uses a library that third_party.toml does not know.

The script finds the uses itself. The compiler tells the headers, the linker the archives, and the bundler the scripts of the page. Files name the
shared libraries that they load. A part of the site is known by its copy.

    third_party.py FILE       of what build.sh has built in build/"""

import collections
import fnmatch
import hashlib
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COMMON = pathlib.Path("/usr/share/common-licenses")
COMPILED, LINKED, LOADED, COPIED = "compiled in", "linked in", "loaded", "copied"


def output(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True, **options).stdout


def owners(files):
    """Returns Debian's package of each file, without its architecture, or the file itself if no package has it."""
    asked = {}  # the name that is asked for, and the file that is meant: dpkg knows some by /lib, which is /usr/lib
    for file in files:
        asked[file] = file
        if file.startswith("/usr/lib"):
            asked[file.removeprefix("/usr")] = file
    found = {file: file for file in files}
    if asked:
        said = subprocess.run(["dpkg", "-S", *sorted(asked)], capture_output=True, text=True, check=False).stdout
        for line in said.splitlines():
            packages, _, name = line.rpartition(": ")
            if name in asked and not line.startswith("diversion by"):
                found[asked[name]] = packages.split(",")[0].split(":")[0]
    return found


def headers(build):
    """Returns the files that the compiler has read for a build by ninja."""
    lines = output("ninja", "-C", build, "-t", "deps").splitlines()
    return {str((build / line.strip()).resolve()) for line in lines if line.startswith("    ")}


def archives(build, target, result):
    """Returns the archives and objects that the linker takes for a target. It links the target once more, into a file of no use."""
    commands = output("ninja", "-C", build, "-t", "commands", target).splitlines()
    found = [re.sub(r"^: && | && .*$", "", line) for line in commands if line.startswith(": && ") and " -o " in line]
    if not found:
        raise SystemExit(f"third_party: nothing links {target} in {build}")
    words = shlex.split(found[-1])
    words[words.index("-o") + 1] = str(result)
    said = output(*words, "-Wl,--trace", cwd=build)
    names = re.findall(r"^\(?(/[^()\n]+\.[ao])\b", said, re.MULTILINE)
    return {str(pathlib.Path(name).resolve()) for name in names}


def loaded(binary):
    """The shared libraries that a file names, and that the loader therefore looks for."""
    names = re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-dW", binary))
    return {str(pathlib.Path(output("cc", f"-print-file-name={name}").strip()).resolve()) for name in names}


def copies(site, theme):
    """Returns the files of a theme that a site has copies of, and the other files of the site. Their content decides."""
    known = {hashlib.sha256(file.read_bytes()).digest(): str(file.resolve()) for file in theme.rglob("*") if file.is_file()}
    found, unknown = set(), set()
    for file in site.rglob("*"):
        if file.is_file() and file.stat().st_size and file.suffix in (".js", ".css", ".woff", ".woff2", ".ttf", ".eot", ".ico"):
            copied = known.get(hashlib.sha256(file.read_bytes()).digest())
            (found if copied else unknown).add(copied or str(file))
    return found, unknown


class Uses(collections.defaultdict):
    """By owner, the released parts that use it, and the ways of their uses."""

    def __init__(self, project):
        super().__init__(lambda: collections.defaultdict(set))
        self.project = str(project) + "/"

    def add(self, released, way, files, by=owners):
        for owner in by({file for file in files if not file.startswith(self.project)}).values():
            self[owner][released].add(way)


def in_binaries(uses, released, build, targets, binaries):
    uses.add(released, COMPILED, headers(build))
    for target in targets:
        uses.add(released, LINKED, archives(build, target, build / "again"))
    for binary in binaries:
        uses.add(released, LOADED, loaded(binary))


def in_page(uses, build, bundled):
    # Emscripten's files are each other people's: they count as they are.
    def each(files):
        return {file: file if "/emscripten/" in file else owner for file, owner in owners(files).items()}

    uses.add("page", COMPILED, headers(build), each)
    uses.add("page", LINKED, archives(build, "ist_page_engine", build / "again.js"), each)
    for name in json.loads(bundled.read_text()):
        uses[f"npm:{name}"]["page"].add(COPIED)


def in_site(uses, site, theme):
    reference = site / "reference"
    if reference.exists():
        uses["doxygen"]["site"].add(COPIED)
    found, unknown = copies(site, theme)
    uses.add("site", COPIED, found)
    for file in unknown:
        if not file.startswith(str(reference)):
            uses[file]["site"].add(COPIED)


def entry_of(owner, entries):
    """Returns the entry of an owner, or None. An entry with its name goes before an entry with a pattern."""
    named = (entry for entry in entries if owner in entry["owners"])
    fitting = (entry for entry in entries if any(fnmatch.fnmatchcase(owner, each) for each in entry["owners"] if "*" in each))
    return next(named, None) or next(fitting, None)


def by_entry(uses, entries):
    """Returns the used entries, with their owners, and the released parts with the ways of their uses."""
    unknown = sorted(owner for owner in uses if entry_of(owner, entries) is None)
    if unknown:
        raise SystemExit("third_party: used, and without an entry in third_party.toml: " + ", ".join(unknown))
    found = {}
    for entry in entries:
        own = sorted((owner for owner in uses if entry_of(owner, entries) is entry), key=lambda owner: ("/" in owner, owner))
        places = {}
        for owner in own:
            for released, ways in uses[owner].items():
                places.setdefault(released, set()).update(ways)
        if own:
            found[entry["name"]] = (entry, own, places)
    return found


def version_of(entry, own, modules):
    name = entry.get("version", own[0])
    if name.startswith("npm:"):
        return re.search(r'"version": "([^"]+)"', (modules / name[4:] / "package.json").read_text())[1]
    debian = output("dpkg-query", "-W", "-f", "${source:Upstream-Version}\n", name).split()[0]  # one of several architectures
    return re.split(r"[+~]|\.?dfsg", debian.split("+really")[-1])[0]


def texts_of(entry, own, modules):
    files = [pathlib.Path(name) for name in entry.get("texts", [])] or [
        modules / owner[4:] / "LICENSE" if owner.startswith("npm:") else pathlib.Path("/usr/share/doc", owner, "copyright") for owner in own]
    for file in files:
        if not file.is_file():
            raise SystemExit(f"third_party: {file}, the licence of {entry['name']}, is missing")
    return list(dict.fromkeys(file.read_text(errors="replace").strip() for file in files))


def notices(found, modules, version):
    """The whole text: a list, each library's licence, and at the end the licences that several of them refer to."""
    lines = [f"IST {version} is under the licence in LICENSE. What others wrote, and where it is in this release:", ""]
    bodies = []
    for name in sorted(found, key=str.lower):
        entry, own, places = found[name]
        used_in = "; ".join(f"{released} ({', '.join(sorted(ways))})" for released, ways in sorted(places.items()))
        lines.append(f"{name} {version_of(entry, own, modules)}\n    licence: {entry['licence']}\n    used: {used_in}")
        bodies.append("\n\n".join([f"{'=' * 100}\n{name}\n{'=' * 100}", *texts_of(entry, own, modules)]))
    said = "\n".join(bodies)
    for name in sorted(set(re.findall(r"/usr/share/common-licenses/([\w-]+(?:\.\d+)*)", said))):
        bodies.append(f"{'=' * 100}\n{COMMON / name}, to which texts above refer\n{'=' * 100}\n\n{(COMMON / name).read_text().strip()}")
    return "\n".join(lines) + "\n\n" + "\n\n".join(bodies) + "\n"


def check_page(found, said):
    """The page carries its own notices, `said`: each library in it is named there, by the name before the first comma."""
    missing = [name for name, (_, _, places) in found.items() if "page" in places and name.split(",")[0] not in said]
    if missing:
        raise SystemExit(f"third_party: in the page, and not named in src/viewer/notices.txt: {'; '.join(missing)}")


def main(target):
    build = ROOT / "build"
    modules = build / "viewer/packages/node_modules"
    uses = Uses(ROOT)
    release, wheel = build / "release", build / "python"
    in_binaries(uses, "Debian packages", release, ("ist_cli", "ist_shared", "ist_loop_shared", "ist_hardware_shared"),
                [release / "ist", *(release / "src/package").glob("*.so")])
    in_binaries(uses, "wheel", wheel, ["ist_loop_shared"], [wheel / "src/package/libist_loop.so.0"])
    in_page(uses, build / "wasm", build / "viewer/bundled.json")
    in_site(uses, build / "docs/site", pathlib.Path("/usr/lib/python3/dist-packages/mkdocs"))
    entries = tomllib.loads((pathlib.Path(__file__).parent / "third_party.toml").read_text())["library"]
    found = by_entry(uses, entries)
    viewer = ROOT / "src/viewer"
    check_page(found, (viewer / "notices.txt").read_text() + (viewer / "bundle.mjs").read_text())
    version = re.search(r"project\(ist VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    pathlib.Path(target).write_text(notices(found, modules, version))
    print(f"third_party: {len(found)} libraries of others: {', '.join(sorted(found, key=str.lower))}")


if __name__ == "__main__":
    main(sys.argv[1])
