"""Whose files are in what a build of a release made, or are loaded by it. Nothing is listed by hand: headers come from what the
compiler says that it read, archives from what the linker says, shared libraries from the files themselves, scripts of the
page from the bundler, and parts of the site from the files that they are copies of."""

import collections
import hashlib
import json
import pathlib
import re
import shlex
import subprocess

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
    for target in ("ist_cli", "ist_shared", "ist_hardware_shared"):
        uses.add("Debian packages", LINKED, archives(build, target, build / "again"))
    for binary in (build / "ist", *(build / "src/package").glob("*.so")):
        uses.add("Debian packages", LOADED, loaded(binary))


def in_wheel(uses, build):
    uses.add("wheel", COMPILED, headers(build))
    uses.add("wheel", LINKED, archives(build, "ist_shared", build / "again"))
    uses.add("wheel", LOADED, loaded(build / "src/package/libist.so.0"))


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
