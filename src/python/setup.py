"""Makes the wheel and the sdist; pyproject.toml says the rest. IST_PYTHON_LIBRARY decides which library a wheel holds:

  (unset)    CMake builds the portable one from the sources, by its preset `python`
  a file     that one
  installed  none: the package asks the loader for libist_loop.so.0, as Debian's package libist0 has it"""

import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # setuptools before 70.1
    from wheel.bdist_wheel import bdist_wheel

HERE = pathlib.Path(__file__).resolve().parent
SONAME = "libist_loop.so.0"
LIBRARY = os.environ.get("IST_PYTHON_LIBRARY", "")
# What the library is built from, and what of it only other things are built from.
SOURCES = ["CMakeLists.txt", "CMakePresets.json", "LICENSE", "simd", "src"]
OTHERS = ["cli", "python", "viewer", "__pycache__"]
# Others' code in the library, and Debian's packages with their licences.
PARTS = {
    "Eigen": "libeigen3-dev",
    "Highway": "libhwy-dev",
    "fmt": "libfmt-dev",
    "nlohmann-json": "nlohmann-json3-dev",
    "toml++": "libtomlplusplus-dev",
    "xxHash": "libxxhash-dev",
    "zlib": "zlib1g-dev",
}


def project():
    """The folder with the library's sources: in an sdist below this one, in a checkout above it."""
    for folder in (HERE / "sources", *HERE.parents):
        if (folder / "CMakePresets.json").is_file() and (folder / "simd").is_dir():
            return folder
    raise SystemExit(f"{HERE} lacks the library's sources: take the sdist, or a checkout of the repository")


def version():
    return re.search(r"(?m)^project\(ist VERSION ([\d.]+)", (project() / "CMakeLists.txt").read_text())[1]


def write_mirror():
    """Writes the module with the structs, numbers and functions of the C headers."""
    subprocess.run([sys.executable, project() / "src/c/c_mirrors.py", "python", HERE / "ist/_c.py"], check=True)


def copy_licences(folder):
    """Writes a text for the project and for each part, from an sdist or from what Debian installed."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(project() / "LICENSE", folder / "IST.txt")
    for part, package in PARTS.items():
        found = [file for file in (HERE / f"licences/{part}.txt", pathlib.Path(f"/usr/share/doc/{package}/copyright"))
                 if file.is_file()]
        if not found:
            raise SystemExit(f"the licence of {part} is missing: install Debian's package {package}, or take the sdist")
        shutil.copy(found[0], folder / f"{part}.txt")


class BuildModules(build_py):
    """The modules, with the library and the licences of what is in it."""

    def run(self):
        super().run()
        if LIBRARY == "installed" or getattr(self, "editable_mode", False):
            return
        package = pathlib.Path(self.build_lib, "ist")
        package.mkdir(parents=True, exist_ok=True)
        shutil.copy(pathlib.Path(LIBRARY) if LIBRARY else self.built(), package / SONAME)
        copy_licences(package / "licences")

    def built(self):
        folder = pathlib.Path(self.get_finalized_command("build").build_temp, "library").resolve()
        subprocess.run(["cmake", "--preset", "python", "-B", folder], cwd=project(), check=True)
        subprocess.run(["cmake", "--build", folder, "--target", "ist_loop_shared"], check=True)
        return folder / "src/package" / SONAME


class Wheel(bdist_wheel):
    """One for every Python: the modules call the library by ctypes."""

    def get_tag(self):
        platform = super().get_tag()[2]
        return "py3", "none", platform


class SourceDistribution(sdist):
    """With all that the library is built from."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        for name in SOURCES:
            source, target = project() / name, pathlib.Path(base_dir, "sources", name)
            target.parent.mkdir(exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, ignore=lambda folder, names: [name for name in names if name in OTHERS])
            else:
                shutil.copy(source, target)
        copy_licences(pathlib.Path(base_dir, "licences"))

    def make_archive(self, base_name, format, root_dir=None, base_dir=None, **owner):  # the names are setuptools'
        """With SOURCE_DATE_EPOCH the same bytes wherever it is made: sorted, of root, and all of that time."""
        if format != "gztar" or "SOURCE_DATE_EPOCH" not in os.environ:
            return super().make_archive(base_name, format, root_dir, base_dir, **owner)
        time, name = int(os.environ["SOURCE_DATE_EPOCH"]), f"{base_name}.tar.gz"

        def plain(entry):
            entry.uid = entry.gid = 0
            entry.uname = entry.gname = "root"
            entry.mtime, entry.mode = time, 0o755 if entry.mode & 0o100 else 0o644
            return entry

        with open(name, "wb") as file, gzip.GzipFile("", "wb", 9, file, mtime=time) as packed, \
                tarfile.open(fileobj=packed, mode="w") as archive:
            for path in sorted([pathlib.Path(base_dir), *pathlib.Path(base_dir).rglob("*")]):
                archive.add(path, recursive=False, filter=plain)
        return name


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return LIBRARY != "installed"


write_mirror()
setup(version=version(), distclass=WithLibrary,
      cmdclass={"build_py": BuildModules, "bdist_wheel": Wheel, "sdist": SourceDistribution})
