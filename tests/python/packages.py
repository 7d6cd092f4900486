"""Makes the wheel and the sdist, and holds them and the package python3-ist against what they are for: see CMakeLists.txt, which
makes a test of each function here whose name begins with a capital."""

import argparse
import os
import pathlib
import re
import shutil
import sys
import tarfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
sys.path.insert(0, str(SOURCE / "tests/package"))
from checks import Missing, ends, need, require, run  # noqa: E402  after its folder is known
from debian import DebianPackage  # noqa: E402
from environments import LICENCES, PYTHON, clean_environment, modules, tries  # noqa: E402
from remedies import WithoutLibrary  # noqa: E402


def need_modules(*names):
    for module in names:
        if tries(PYTHON, "-c", f"import {module}").returncode != 0:
            raise Missing(f"{PYTHON} has no {module}: scripts/setup.sh --python installs it")


class Packages(WithoutLibrary, DebianPackage):
    def __init__(self, arguments):
        self.work, self.build = arguments.work, arguments.build
        self.compiler, self.unity = arguments.compiler, arguments.unity
        self.made = self.work / "packages"
        self.portable = self.made / "src/package/libist_loop.so.0"
        self.version = re.search(r"project\(ist VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.machine = os.uname().machine

    def fresh(self, name):
        folder = self.work / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def one(self, pattern):
        found = sorted(self.made.glob(pattern))
        require(len(found) == 1, f"{pattern} in {self.made}: {found}")
        return found[0]

    def venv(self, name, *packages, **environment):
        """A Python of its own, with the system's numpy and with packages that pip installs without a network."""
        folder = self.fresh(name)
        run(PYTHON, "-m", "venv", "--system-site-packages", folder)
        run(folder / "bin/pip", "install", "--no-index", "--no-build-isolation", *packages,
            env=clean_environment(**environment))
        return folder

    def installed(self, venv):
        """The files of the package in a Python of its own."""
        site = next(venv.glob("lib/python3*/site-packages"))
        return sorted(str(file.relative_to(site)) for file in site.rglob("*")
                      if re.match(r"ist(-|/|$)", str(file.relative_to(site))) and file.is_file())

    def answers(self, python, library, **environment):
        return run(python, "-B", HERE / "ask.py", library, env=clean_environment(**environment), cwd=self.work)

    def expected(self):
        """The answers of this build's own library, by the modules of the sources."""
        library = pathlib.Path(os.environ["IST_LIBRARY"])
        return self.answers(PYTHON, library, IST_LIBRARY=str(library), PYTHONPATH=str(SOURCE / "src/python"))

    def Make(self):
        """The packages, by the script that makes them for users."""
        need("cmake", "ninja")
        need_modules("build", "setuptools", "wheel", "numpy")
        run(SOURCE / "scripts/python_packages.sh", "--build", self.made, f"-DCMAKE_CXX_COMPILER={self.compiler}",
            f"-DIST_UNITY={self.unity}")

    def Library(self):
        """It needs libc and libm, exports what the other one does, and the pages name the oldest glibc that runs it."""
        need("readelf", "nm")
        dynamic = run("readelf", "-dW", self.portable)
        needed = set(re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic))
        strangers = {name for name in needed if not re.fullmatch(r"libc\.so\.6|libm\.so\.6|ld-linux-.*\.so\.\d", name)}
        require("libc.so.6" in needed and not strangers, f"it needs {needed}")
        require("[libist_loop.so.0]" in dynamic and "BIND_NOW" in dynamic, f"no SONAME, or bound late:\n{dynamic}")
        require("RUNPATH" not in dynamic and "RPATH" not in dynamic, f"it looks for others where it was built:\n{dynamic}")
        run(PYTHON, "-B", SOURCE / "tests/package/symbols.py", self.portable)
        versions = re.findall(r"@GLIBC_([\d.]+)", run("nm", "-D", "--undefined-only", self.portable))
        oldest = ".".join(map(str, max(tuple(map(int, version.split("."))) for version in versions)))
        page = (SOURCE / "docs/building.md").read_text()
        stated = re.findall(r"glibc ([\d.]*\d)", page)
        require(stated == [oldest], f"docs/building.md states glibc {stated}, and the library needs {oldest}")
        print(f"needs {', '.join(sorted(needed))} of glibc {oldest}; {self.portable.stat().st_size} bytes")

    def Wheel(self):
        """One file for every Python of this system, with the modules, the library, the licences and nothing else."""
        wheel = self.one("*.whl")
        require(wheel.name == f"ist-{self.version}-py3-none-linux_{self.machine}.whl", f"it is called {wheel.name}")
        info = f"ist-{self.version}.dist-info"
        with zipfile.ZipFile(wheel) as archive:
            content = {name: archive.read(name) for name in archive.namelist()}
        rest = sorted(name for name in content if not name.startswith(info))
        licences = [f"ist/{name}" for name in LICENCES]
        require(rest == sorted([*modules(), "ist/libist_loop.so.0", *licences]), f"it holds {rest}")
        for name in modules():
            require(content[name] == (SOURCE / "src/python" / name).read_bytes(), f"{name} is another one")
        require(content["ist/libist_loop.so.0"] == self.portable.read_bytes(), "its library is another one")
        for name in licences:
            require(b"opyright" in content[name], f"{name} holds no licence")
        said = content[f"{info}/METADATA"].decode()
        for line in (f"Version: {self.version}", "Requires-Python: >=3.9", "License: BSD-3-Clause", "Requires-Dist: numpy"):
            require(line in said, f"METADATA lacks {line}:\n{said}")
        tag = content[f"{info}/WHEEL"].decode()
        require(f"Tag: py3-none-linux_{self.machine}\n" in tag and "Root-Is-Purelib: false" in tag, tag)
        print(f"{wheel.name}: {wheel.stat().st_size} bytes, {len(content)} files")

    def Venv(self):
        """Installed without a network it answers with the bits of the other library, its page is true, and it goes whole."""
        venv = self.venv("venv", self.one("*.whl"))
        files = self.installed(venv)
        require(set(modules()) < set(files), f"installed are {files}")
        library = next(venv.glob("lib/python3*/site-packages/ist/libist_loop.so.0"))
        here, there = self.answers(venv / "bin/python", library), self.expected()
        require(here == there, f"the wheel answers\n{here}and the library of this build\n{there}")
        ran = tries(venv / "bin/python", "-B", "-m", "doctest", SOURCE / "src/python/README.md")
        require(ran.returncode == 0, f"src/python/README.md:\n{ran.stdout}{ran.stderr}")
        run(venv / "bin/python", "-c", "import ist")  # writes byte code
        run(venv / "bin/pip", "uninstall", "-y", "ist")
        require(not self.installed(venv), f"left are {self.installed(venv)}")

    def Sdist(self):
        """It holds all that the library is built from, and makes a package for a library that is installed. With
        IST_COMPILE_ALL=1 it builds its own, which takes minutes."""
        archive = self.one("*.tar.gz")
        folder = self.fresh("sdist")
        with tarfile.open(archive) as files:
            files.extractall(folder)
        root = folder / f"ist-{self.version}"
        for name in ("pyproject.toml", "setup.py", "README.md", "PKG-INFO", *modules(), *LICENCES):
            require((root / name).is_file(), f"{archive.name} lacks {name}")
        strangers = {file.name for file in (root / "sources/src").iterdir()} & {"cli", "python", "viewer"}
        require(not strangers, f"{archive.name} holds {strangers}, which the library is not built from")
        # What CMake and the compiler have read of the project for the library that lies beside.
        lines = run("ninja", "-C", self.made, "-t", "deps").splitlines()
        reads = {(self.made / line.strip()).resolve() for line in lines if line.startswith("    ")}
        reads |= {SOURCE / name for name in ("CMakePresets.json", "CMakeLists.txt", "src/platform.cmake", "src/package/ist.map.in")}
        reads = {file for file in reads if file.is_relative_to(SOURCE) and not file.is_relative_to(SOURCE / "build")}
        require(len(reads) > 250, f"{len(reads)} files were read")
        for file in reads:
            copy = root / "sources" / file.relative_to(SOURCE)
            require(copy.is_file() and copy.read_bytes() == file.read_bytes(), f"{archive.name} lacks {copy.relative_to(root)}")
        run("cmake", "--preset", "python", "-B", folder / "configured", f"-DCMAKE_CXX_COMPILER={self.compiler}", cwd=root / "sources")

        system = self.venv("sdist_installed", archive, IST_PYTHON_LIBRARY="installed")
        require(not [name for name in self.installed(system) if ".so" in name], f"installed are {self.installed(system)}")
        library = pathlib.Path(os.environ["IST_LIBRARY"])
        answers = self.answers(system / "bin/python", library, LD_LIBRARY_PATH=str(library.parent))
        require(answers == self.expected(), f"by its SONAME it answers\n{answers}")
        if os.environ.get("IST_COMPILE_ALL") == "1":
            own = self.venv("sdist_built", archive, CXX=self.compiler)
            library = next(own.glob("lib/python3*/site-packages/ist/libist_loop.so.0"))
            answers = self.answers(own / "bin/python", library)
            require(answers == self.expected(), f"built from the sdist it answers\n{answers}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("test")
    for name in ("work", "build"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--unity", default="0")
    arguments = parser.parse_args()
    return ends(getattr(Packages(arguments), arguments.test))


if __name__ == "__main__":
    sys.exit(main())
