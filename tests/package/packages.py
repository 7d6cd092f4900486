"""Builds and runs programs of someone else's against all that a user may have of the library: see
CMakeLists.txt, which makes a test of each function here whose name begins with a capital."""

import argparse
import datetime
import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys

from checks import ends, need, require, run
from clean_root import CleanRoot
from installed import Installed, files_below
from pages import Pages

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
# What a user's project may ask of a compiler, without a word from our headers.
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wmissing-field-initializers", "-Werror"]
OTHER_COMPILER = "clang++-14"


def installed_headers():
    """Below include/: those of the library, and those of the circuit's model."""
    listed = (SOURCE / "src/package/public_headers.txt").read_text().splitlines()
    ours = [line for line in listed if line.startswith("ist/")]
    below = {library: SOURCE / "src" / library / "include" for library in ("c", "loop", "models", "hardware")}
    others = {library: sorted(str(file.relative_to(folder)) for file in folder.rglob("*.h")) for library, folder in below.items()}
    return ours + others["c"] + others["loop"] + others["models"], others["hardware"]


def layout(binary):
    """What the code in a binary takes for sizes and places: see layout.h."""
    section = binary.with_suffix(".layout")
    run("objcopy", "-O", "binary", "--only-section=ist_layout", binary, section)
    numbers = section.read_bytes()
    require(len(numbers) > 0, f"{binary} has no section ist_layout")
    return numbers


class Packages(Installed, Pages):
    def __init__(self, arguments):
        self.build, self.work = arguments.build, arguments.work
        self.compiler, self.library = arguments.compiler, arguments.library
        self.library_layout = arguments.layout
        self.prefix = self.work / "prefix"
        cache = (self.build / "CMakeCache.txt").read_text()
        self.libraries = re.search(r"^CMAKE_INSTALL_LIBDIR:PATH=(.*)$", cache, re.M)[1]  # relative to a prefix

    def fresh(self, name):
        folder = self.work / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def check_consumer(self, program, before=()):
        """Runs it, and holds its view of the classes against the library's."""
        require(layout(program) == layout(self.library_layout), f"{program} sees other classes than the library")
        printed = run(*before, program, program.with_suffix(".ist"))
        require("caught file-unreadable" in printed, f"{program} printed:\n{printed}")
        return printed

    def compile_consumer(self, folder, headers, environment, compiler=None):
        """By what pkg-config says alone; nothing but Eigen is included besides the headers in one place."""
        flags = [run("pkg-config", *words, "ist_loop", env=environment).split()
                 for words in (["--cflags"], ["--libs"])]
        program, names = folder / "consumer", folder / "consumer.d"
        run(compiler or self.compiler, "-std=c++20", *WARNINGS, *flags[0], "-MD", "-MF", names, HERE / "consumer/consumer.cpp",
            "-o", program, *flags[1])
        included = names.read_text().replace("\\\n", " ").split()
        ours = [name for name in included if "/ist/" in name]
        require(ours and all(name.startswith(str(headers)) for name in ours), f"not from {headers}: {ours}")
        # clang counts a header that the standard library asks for by __has_include; whoever includes it gets more.
        included = [name for name in included if name != "/usr/include/tbb/tbb.h"]
        others = [name for name in included if re.match(r"/usr/include/(oneapi|tbb|assimp|fmt|hwy|gmp|xxh|toml|zlib|nlohmann)", name)]
        require(not others, f"a public header includes what is private to the library: {others}")
        return program

    def Install(self):
        """An install tree of what is built, whole and without more."""
        shutil.rmtree(self.prefix, ignore_errors=True)
        run("cmake", "--install", self.build, "--prefix", self.prefix)
        files = files_below(self.prefix)
        headers = {f"include/{header}" for part in installed_headers() for header in part}
        require({file for file in files if file.startswith("include/")} == headers, "other headers than are listed")
        rest = sorted(re.sub(r"0\.\d+\.\d+$", "V", file) for file in files - headers)
        config = ["ist-config-version.cmake", "ist-config.cmake"]
        expected = ["bin/ist", *(f"{self.libraries}/{name}" for name in (
                        *(f"cmake/ist/{name}" for name in config), "libist.so", "libist.so.0", "libist.so.V",
                        "libist_hardware.so", "libist_hardware.so.0", "libist_hardware.so.V",
                        "libist_loop.so", "libist_loop.so.0", "libist_loop.so.V", "pkgconfig/ist.pc", "pkgconfig/ist_loop.pc")),
                    "libexec/ist/ist-import",
                    "share/bash-completion/completions/ist",
                    *(f"share/doc/{name}/copyright" for name in ("ist-import", "ist", "libist-dev", "libist0"))]
        # The page, where scripts/viewer.sh made it.
        expected += ["share/ist/page.html"] if (SOURCE / "build/viewer/ist.html").exists() else []
        # The build type names the targets' files; Documents and ManPages have the others.
        apart = r"ist_targets(-\w+)?\.cmake$|^share/man/man1/|^share/doc/ist/(?!copyright)"
        rest = [file for file in rest if not re.search(apart, file)]
        require(rest == expected, f"installed are {rest}")
        dynamic = run("readelf", "-dW", self.prefix / self.libraries / "libist.so")
        require("[libist.so.0]" in dynamic and "BIND_NOW" in dynamic, f"no SONAME, or bound late:\n{dynamic}")
        require("RUNPATH" not in dynamic, f"it looks for others where it was built:\n{dynamic}")

    def FindPackage(self):
        """CMake's find_package, also by code that is compiled for AVX2 and for AVX-512. The library is not."""
        folder = self.fresh("find_package")
        run("cmake", "-G", "Ninja", "-S", HERE / "consumer", "-B", folder, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={self.compiler}")
        run("cmake", "--build", folder)
        printed = self.check_consumer(folder / "consumer")
        run(folder / "hardware")
        run(folder / "query")
        needed = re.findall(r"NEEDED.*\[(libist.*?)\.so", run("readelf", "-dW", folder / "query"))
        require(needed == ["libist"], f"a program of queries needs {needed}")
        other = self.fresh("find_package_other_compiler")
        need(OTHER_COMPILER)
        run("cmake", "-G", "Ninja", "-S", HERE / "consumer", "-B", other, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={OTHER_COMPILER}")
        run("cmake", "--build", other, "--target", "consumer", "hardware")
        require(self.check_consumer(other / "consumer") == printed, f"by {OTHER_COMPILER} it has other answers")
        for name in ("avx2", "avx512f"):
            wide = folder / f"consumer_{name}"
            if name in pathlib.Path("/proc/cpuinfo").read_text().split():
                require(self.check_consumer(wide) == printed, f"compiled for {name}, it has other answers")
            else:
                require(layout(wide) == layout(self.library_layout), f"compiled for {name}, it sees other classes")
                print(f"this processor has no {name}: the program for it was compared, and not run")

    def PkgConfig(self):
        need("pkg-config")
        folder = self.fresh("pkg_config")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(self.prefix / self.libraries / "pkgconfig")}
        program = self.compile_consumer(folder, self.prefix, environment)
        self.check_consumer(program, ["env", f"LD_LIBRARY_PATH={self.prefix}/{self.libraries}"])
        need(OTHER_COMPILER)
        program = self.compile_consumer(folder, self.prefix, environment, OTHER_COMPILER)
        self.check_consumer(program, ["env", f"LD_LIBRARY_PATH={self.prefix}/{self.libraries}"])
        flags = run("pkg-config", "--cflags", "--libs", "ist_loop", env=environment).split()
        run("cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", HERE / "consumer/consumer.c", *flags,
            "-o", folder / "consumer_c")
        run("env", f"LD_LIBRARY_PATH={self.prefix}/{self.libraries}", folder / "consumer_c")

    def Debian(self):
        """The packages, in a root that holds what they depend on and nothing else."""
        need("pkg-config", "dpkg-deb", "dpkg-query", "dpkg-shlibdeps", "file", "help2man")
        folder = self.fresh("debian")
        run("cpack", "--config", self.build / "CPackConfig.cmake", "-B", folder / "packages")
        root = CleanRoot(folder / "root", (folder / "packages").glob("*.deb"))
        version = root.field("libist0", "Version")
        cache = (self.build / "CMakeCache.txt").read_text()
        seconds = int(run("cmake", "-P", SOURCE / "src/package/commit.cmake"))
        committed = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%d %H:%M")
        architecture = run("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()
        require(self.libraries == f"lib/{architecture}" and root.libraries == root.path / "usr" / self.libraries,
                f"libraries are in {root.libraries}: take CMAKE_INSTALL_LIBDIR out of CMakeCache.txt if it is of an older tree")
        require(root.field("libist-dev", "Depends") == f"libist0 (= {version}), libeigen3-dev (>= 3.4)",
                f"libist-dev depends on {root.field('libist-dev', 'Depends')}")
        contact = re.search(r"^IST_MAINTAINER:STRING=(.*)$", cache, re.M)[1] or "IST developers <noreply@ist.example>"
        homepage = re.search(r"^IST_HOMEPAGE:STRING=(.*)$", cache, re.M)[1]
        for name, package in root.files.items():
            require(root.field(name, "Maintainer") == contact, f"the maintainer of {name} is {root.field(name, 'Maintainer')}")
            require(root.field(name, "Homepage") == homepage, f"the page of {name} is {root.field(name, 'Homepage')}")
            times = {" ".join(line.split()[3:5]) for line in run("dpkg-deb", "-c", package, env={**os.environ, "TZ": "UTC"}).splitlines()}
            require(times == {committed}, f"{name} has files of {times}, and the commit is of {committed}")
        require("libist0" not in root.field("ist", "Depends"), "the command holds the library, and depends on it")
        require(not root.shared_files(), f"in two packages: {root.shared_files()}")
        environment = {**os.environ, "PKG_CONFIG_LIBDIR": f"{root.path}/usr/{self.libraries}/pkgconfig:/usr/share/pkgconfig"}
        program = self.compile_consumer(folder, root.path, environment)
        self.check_consumer(program, root.loader("libist0", program))
        command = root.path / "usr/bin/ist"
        said = run(*root.loader("ist", command), command, "--version")
        require(said == run(self.build / "ist", "--version"), f"ist --version says {said}")
        require(re.match(rf"ist {re.escape(version)}\ncommit ([0-9a-f]{{8}}\+?|unknown)\n", said), f"ist --version says {said}")
        page = gzip.decompress((root.path / "usr/share/man/man1/ist-collide.1.gz").read_bytes()).decode()
        require(f'"ist {version}"' in page, f"the manual page begins with {page.splitlines()[0]}")

    def Lintian(self):
        """Debian's checker has nothing to say of the packages, but for what src/package/lintian argues."""
        need("lintian", "dpkg-deb", "dpkg-query", "dpkg-shlibdeps", "file", "pkg-config", "help2man")
        packages = sorted((self.work / "debian/packages").glob("*.deb"))
        require(len(packages) == 5, f"the packages are {packages}")
        said = run("lintian", "--allow-root", "--tag-display-limit", "0", "--display-info", "--pedantic", "--fail-on",
                   "none", *packages)
        # A build with assertions calls libc where others do not.
        tags = [line for line in said.splitlines() if not line.startswith("N:") and "unused-override" not in line]
        require(not tags, "lintian says:\n" + "\n".join(tags))

    def Subdirectory(self):
        """FetchContent from the sources, in a project that has settings of its own. With IST_COMPILE_ALL=1 all is
        compiled anew, which takes minutes; else what has been compiled by the same commands is taken."""
        compile_all = os.environ.get("IST_COMPILE_ALL") == "1"
        folder = self.fresh("subdirectory")
        cache = (self.build / "CMakeCache.txt").read_text()
        same = [f"-D{name}={re.search(rf'^{name}:[A-Z]+=(.*)$', cache, re.MULTILINE)[1]}"
                for name in ("CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER", "IST_ASSERTS", "IST_UNITY")]
        if re.search(r"^CMAKE_DISABLE_PRECOMPILE_HEADERS:[A-Z]+=ON$", cache, re.MULTILINE):
            same.append("-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON")
        if not compile_all:
            same.append(f"-DCMAKE_CXX_COMPILER_LAUNCHER=python3;{HERE}/reuse.py;{self.build};{folder}/_deps/ist-build")
        run("cmake", "-G", "Ninja", "-S", HERE / "consumer", "-B", folder, f"-DIST_SOURCE={SOURCE}", *same)
        run("cmake", "--build", folder)
        self.check_consumer(folder / "consumer")
        if not compile_all:
            print("compiled anew:", *(folder / "_deps/ist-build/compiled").read_text().split())

    def Headers(self):
        """The headers are closed under includes, and what they define can be linked."""
        folder = self.fresh("headers")
        ours, model = installed_headers()
        require(len(ours) <= 38, f"{len(ours)} headers are installed: 38 are the most")
        text = {header: (self.prefix / "include" / header).read_text() for header in ours + model}
        for header in text:
            for other in re.findall(r'#include "([^"]+)"', text[header]):
                require(other in text, f"{header} includes {other}, which is not installed")
        classes = [name for header in text for name in re.findall(r"^(?:class|struct) IST_API (\w+)", text[header], re.M)]
        source = folder / "all.cpp"
        lines = [f'#include "{header}"' for header in text]
        lines.append("template <class T> void let_go(T* t) { if constexpr (std::is_destructible_v<T>) delete t; }")
        lines += [f"template void let_go(ist::{name}*);" for name in classes]
        source.write_text("\n".join(lines + ["int main() {}\n"]))
        # Every inline function is compiled. Those of classes that are the library's own need not link.
        run(self.compiler, "-std=c++20", "-fkeep-inline-functions", "-ffunction-sections",
            f"-I{self.prefix}/include", "-isystem", "/usr/include/eigen3", "-c", source, "-o", folder / "all.o")
        names = [line.split(maxsplit=1)[1] for line in run("nm", "--defined-only", folder / "all.o").splitlines()]
        shown = run("c++filt", input="\n".join(names)).splitlines()
        roots = []
        for name, plain in zip(names, shown):
            owner = re.match(r"[WV] (?:void let_go<)?ist::(\w+)", plain)
            if owner:
                roots.append(name.split()[1])
        require(len(roots) > 60, f"only {len(roots)} inline functions")
        (folder / "roots").write_text("".join(f"-Wl,-u,{name}\n" for name in roots))
        run(self.compiler, folder / "all.o", f"@{folder}/roots", "-Wl,--gc-sections", "-o", folder / "all",
            f"-L{self.prefix}/{self.libraries}", "-list_hardware", "-list_loop", "-list")
        print(f"{len(roots)} inline functions link")

    def Refused(self):
        """With C++17, or with poses that are not aligned, an error says what is needed."""
        folder = self.fresh("refused")
        flags = [f"-I{self.prefix}/include", "-isystem", "/usr/include/eigen3", "-fsyntax-only"]
        need(OTHER_COMPILER)

        def compiles(compiler, text, standard="c++20"):
            source = folder / "refused.cpp"
            source.write_text(text)
            ran = subprocess.run([compiler, f"-std={standard}", *flags, source], capture_output=True, text=True, check=False)
            return ran.returncode == 0, ran.stderr

        for compiler in (self.compiler, OTHER_COMPILER):
            for header in ("ist/ist.h", "ist/measure.h", "ist/haptics.h", "ist/scene.h"):
                fine, said = compiles(compiler, f"#include <{header}>\n", "c++17")
                errors = [line for line in said.splitlines() if re.search(r"\berror:", line)]
                require(not fine and len(errors) == 1 and "C++20" in errors[0], f"{compiler}, C++17, {header}:\n{said}")
            fine, said = compiles(compiler, "#define EIGEN_DONT_ALIGN\n#include <ist/ist.h>\n")
            require(not fine and "remove EIGEN_DONT_ALIGN" in said, f"{compiler}, poses that are not aligned:\n{said}")
        lines = run(self.compiler, "-std=c++20", *flags[:-1], "-M", "-x", "c++", self.prefix / "include/ist/ist.h")
        ours = {name for name in lines.replace("\\\n", " ").split() if "/include/ist/" in name}
        count = sum(len(pathlib.Path(name).read_text().splitlines()) for name in ours)
        require(count < 1600, f"ist/ist.h pulls in {count} lines")
        print(f"ist/ist.h pulls in {len(ours)} headers, {count} lines")

    def Example(self):
        """The installed examples, as their CMakeLists.txt says to build them."""
        folder = self.fresh("examples")
        examples = self.prefix / "share/doc/ist/examples"
        run("cmake", "-G", "Ninja", "-S", examples, "-B", folder, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            f"-DCMAKE_CXX_COMPILER={self.compiler}")
        run("cmake", "--build", folder)
        expected = SOURCE / "tests/examples/expected"
        for name, text in (("hello", "hello"), ("hello_c", "hello"), ("world", "world")):
            printed = run(folder / name)
            require(printed == (expected / f"{text}.txt").read_text(), f"{name} printed:\n{printed}")
        printed = run(folder / "loop", examples / "probe.toml").splitlines()
        forces = [float(line.split()[0]) for line in printed[:-1]]
        require(len(forces) == 10 and printed[-1] == "1000 ticks, 0 missed", f"it printed {printed}")
        # 2 mm above the block, at 4 mm/s: it touches in the middle, and then pushes more and more.
        require(max(map(abs, forces[:4])) < 0.01, f"a force where nothing touches: {forces}")
        require(all(a < b for a, b in zip(forces[5:], forces[6:])) and forces[5] > 0.1, f"no push: {forces}")
        sources = [file for file in examples.iterdir() if file.suffix in (".c", ".cpp", ".py")]
        require(len(sources) == 5, f"the examples are {sources}")
        for file in sources:
            lines = len(file.read_text().splitlines())
            require(lines <= 70, f"{file.name}, an example, has {lines} lines")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("test")
    for name in ("build", "work", "library", "layout"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", required=True)
    arguments = parser.parse_args()
    return ends(getattr(Packages(arguments), arguments.test))


if __name__ == "__main__":
    sys.exit(main())
