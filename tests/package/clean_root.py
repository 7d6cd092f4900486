"""A folder with Debian packages unpacked in it, and with the libraries that they depend on."""

import pathlib
import re
import subprocess
import sys


def output(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout


def names_in(depends):
    """Package names in a Depends field; the first of alternatives."""
    return [re.split(r"[ (:|]", entry.strip())[0] for entry in depends.split(",") if entry.strip()]


class CleanRoot:
    def __init__(self, path, packages):
        self.path, self.files = path, {}
        path.mkdir()
        for package in packages:
            name = output("dpkg-deb", "-f", package, "Package").strip()
            self.files[name] = package
            output("dpkg-deb", "-x", package, path)
        self.libraries = next(path.glob("usr/lib/**/libist.so.0")).parent
        # Of this architecture: a machine may have the libraries of another beside its own.
        architecture = output("dpkg", "--print-architecture").strip()
        form = "${Package}\t${Architecture}\t${binary:Package}\t${Pre-Depends}, ${Depends}\n"
        lines = [line.split("\t") for line in output("dpkg-query", "-W", "-f", form).splitlines()]
        native = [line for line in lines if line[1] in (architecture, "all")]
        self.installed = {name: names_in(depends) for name, _, _, depends in native}
        self.full_names = {name: full for name, _, full, _ in native}

    def field(self, package, name):
        return output("dpkg-deb", "-f", self.files[package], name).strip()

    def shared_files(self):
        """Files that more than one of the packages holds."""
        seen, twice = set(), set()
        for package in self.files.values():
            for line in output("dpkg-deb", "-c", package).splitlines():
                name = line.split()[5]
                (twice if name in seen and not name.endswith("/") else seen).add(name)
        return twice

    def closure(self, package):
        """What comes with a package: the installed ones that it depends on, directly or not."""
        found, todo = set(), names_in(self.field(package, "Depends"))
        while todo:
            name = todo.pop()
            if name not in found and name in self.installed:
                found.add(name)
                todo += self.installed[name]
        return found

    def loader(self, package, program):
        """The words before a program that runs it with the libraries which a package brings and depends on.
        Ends the test where it would load any other."""
        folder = self.path / "libraries" / package
        folder.mkdir(parents=True)
        for name in output("dpkg-query", "-L", *sorted(self.full_names[name] for name in self.closure(package))).splitlines():
            file = pathlib.Path(name)
            if re.search(r"\.so(\.\d+)*$", name) and re.fullmatch(r"(/usr)?/lib(/[\w-]+-linux-gnu)?", str(file.parent)):
                (folder / file.name).unlink(missing_ok=True)
                (folder / file.name).symlink_to(file)
        loader = next(folder.glob("ld-linux*.so.*"))
        command = [loader, "--inhibit-cache", "--library-path", f"{self.libraries}:{folder}"]
        loaded = output(*command[:-2], "--list", *command[-2:], program)
        strangers = [line for line in loaded.splitlines() if "=>" in line and str(self.path) not in line]
        if strangers or "=>" not in loaded:
            sys.exit(f"{package} does not depend on what it needs:\n" + "\n".join(strangers or [loaded]))
        return command
