"""Writes the notices of all that others wrote and a release has in it, and of the shared libraries that it loads: name, version,
licence, where it is used, and the text of the licence. Fails where something is used that third_party.toml does not know.

Nobody lists uses by hand: headers come from the files that the compiler says it read, archives from the linker, shared libraries
from the files themselves, scripts of the page from the bundler, and parts of the site from the files that they are copies of.

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
    """Debian's package of each file, without its architecture; the file itself where no package has it."""
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
    """All that the compiler has read for a build by ninja."""
    lines = output("ninja", "-C", build, "-t", "deps").splitlines()
    return {str((build / line.strip()).resolve()) for line in lines if line.startswith("    ")}


def link_command(build, target):
    commands = output("ninja", "-C", build, "-t", "commands", target).splitlines()
    found = [re.sub(r"^: && | && .*$", "", line) for line in commands if line.startswith(": && ") and " -o " in line]
    if not found:
        raise SystemExit(f"third_party: nothing links {target} in {build}")
    return shlex.split(found[-1])


def archives(build, target, result):
    """The archives and objects that the linker takes for a target; it links it once more, into a file of no use."""
    words = link_command(build, target)
    words[words.index("-o") + 1] = str(result)
    said = output(*words, "-Wl,--trace", cwd=build)
    names = re.findall(r"^\(?(/[^()\n]+\.[ao])\b", said, re.MULTILINE)
    return {str(pathlib.Path(name).resolve()) for name in names}


def loaded(binary):
    """The shared libraries that a file names, and that the loader therefore looks for."""
    names = re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-dW", binary))
    return {str(pathlib.Path(output("cc", f"-print-file-name={name}").strip()).resolve()) for name in names}


def copies(site, theme):
    """The files of a theme that a site has copies of, by its content; and those of the site that nobody is known for."""
    known = {hashlib.sha256(file.read_bytes()).digest(): str(file.resolve()) for file in theme.rglob("*") if file.is_file()}
    found, unknown = set(), set()
    for file in site.rglob("*"):
        if file.is_file() and file.stat().st_size and file.suffix in (".js", ".css", ".woff", ".woff2", ".ttf", ".eot", ".ico"):
            copied = known.get(hashlib.sha256(file.read_bytes()).digest())
            (found if copied else unknown).add(copied or str(file))
    return found, unknown


class Uses(collections.defaultdict):
    """For each owner, what is released with it, and in which ways."""

    def __init__(self, project):
        super().__init__(lambda: collections.defaultdict(set))
        self.project = str(project) + "/"

    def add(self, released, way, files, by=owners):
        for owner in by({file for file in files if not file.startswith(self.project)}).values():
            self[owner][released].add(way)


def in_packages(uses, build):
    uses.add("Debian packages", COMPILED, headers(build))
    for target in ("ist_cli", "ist_shared", "ist_loop_shared", "ist_hardware_shared"):
        uses.add("Debian packages", LINKED, archives(build, target, build / "again"))
    for binary in (build / "ist", *(build / "src/package").glob("*.so")):
        uses.add("Debian packages", LOADED, loaded(binary))


def in_wheel(uses, build):
    uses.add("wheel", COMPILED, headers(build))
    uses.add("wheel", LINKED, archives(build, "ist_loop_shared", build / "again"))
    uses.add("wheel", LOADED, loaded(build / "src/package/libist_loop.so.0"))


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
    own = ("search/search_index.json",)
    unknown = {file for file in unknown if not file.startswith(str(reference)) and not file.endswith(own)}
    uses.add("site", COPIED, found)
    for file in unknown:
        uses[file]["site"].add(COPIED)


def entry_of(owner, entries):
    """The entry that an owner belongs to, or nothing; one that names it goes before one whose pattern fits."""
    for entry in entries:
        if owner in entry["owners"]:
            return entry
    for entry in entries:
        if any(fnmatch.fnmatchcase(owner, pattern) for pattern in entry["owners"] if "*" in pattern):
            return entry
    return None


def by_entry(uses, entries):
    """For each entry that is used its owners, and what is released with it in which ways."""
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
    files = [pathlib.Path(name) for name in entry.get("texts", [])]
    for owner in () if files else own:
        files.append(modules / owner[4:] / "LICENSE" if owner.startswith("npm:") else pathlib.Path("/usr/share/doc", owner, "copyright"))
    texts = []
    for file in files:
        if not file.is_file():
            raise SystemExit(f"third_party: {file}, the licence of {entry['name']}, is missing")
        text = file.read_text(errors="replace").strip()
        if text not in texts:
            texts.append(text)
    return texts


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
    in_packages(uses, build / "release")
    in_wheel(uses, build / "python")
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
