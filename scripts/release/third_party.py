"""Writes the notices of all that others wrote and a release has in it, and of the shared libraries that it loads: name, version,
licence, where it is used, and the text of the licence. Fails where something is used that third_party.toml does not know.

    third_party.py FILE       of what build.sh has built in build/"""

import fnmatch
import pathlib
import re
import sys
import tomllib

import used

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COMMON = pathlib.Path("/usr/share/common-licenses")


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
    debian = used.output("dpkg-query", "-W", "-f", "${source:Upstream-Version}\n", name).split()[0]  # one of several architectures
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
    uses = used.Uses(ROOT)
    used.in_packages(uses, build / "release")
    used.in_wheel(uses, build / "python")
    used.in_page(uses, build / "wasm", build / "viewer/bundled.json")
    used.in_site(uses, build / "docs/site", pathlib.Path("/usr/lib/python3/dist-packages/mkdocs"))
    entries = tomllib.loads((pathlib.Path(__file__).parent / "third_party.toml").read_text())["library"]
    found = by_entry(uses, entries)
    viewer = ROOT / "src/viewer"
    check_page(found, (viewer / "notices.txt").read_text() + (viewer / "bundle.mjs").read_text())
    version = re.search(r"project\(ist VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    pathlib.Path(target).write_text(notices(found, modules, version))
    print(f"third_party: {len(found)} libraries of others: {', '.join(sorted(found, key=str.lower))}")


if __name__ == "__main__":
    main(sys.argv[1])
