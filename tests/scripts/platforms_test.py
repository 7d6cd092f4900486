"""What CMake says where a platform, a compiler or an emulator cannot be used, or nobody could be named by the packages: one sentence with the remedy,
before anything is built."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).parents[2]
COMPILER = ["-DCMAKE_CXX_COMPILER=g++"]


class Refusals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def refused(self, *options, path=None):
        """The first message that CMake ends with; it may go on with its own."""
        environment = {name: value for name, value in os.environ.items() if name not in ("CXX", "CXXFLAGS")}
        environment |= {"PATH": path} if path else {}
        cmake = shutil.which("cmake")
        done = subprocess.run([cmake, "-S", SOURCE, "-B", self.folder / "build", *options], env=environment,
                              capture_output=True, text=True, timeout=300)
        self.assertNotEqual(done.returncode, 0, done.stdout)
        return " ".join(done.stderr.partition("Call Stack")[0].split())

    def path_without(self, *missing):
        """A folder of links to all programs but some."""
        folder = self.folder / "bin"
        folder.mkdir()
        for place in reversed(os.environ["PATH"].split(":")):
            for program in pathlib.Path(place).glob("*"):
                link = folder / program.name
                link.unlink(missing_ok=True)
                link.symlink_to(program)
        for name in missing:
            (folder / name).unlink(missing_ok=True)
        return str(folder)

    def test_another_processor(self):
        said = self.refused(*COMPILER, "-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=riscv64")
        self.assertIn("IST runs on x86-64 and ARM64 Linux and in WebAssembly (scripts/toolchains), and was asked to "
                      "build for riscv64 Linux", said)

    def test_another_system(self):
        said = self.refused(*COMPILER, "-DCMAKE_SYSTEM_NAME=FreeBSD", "-DCMAKE_SYSTEM_PROCESSOR=x86_64")
        self.assertIn("was asked to build for x86_64 FreeBSD", said)

    def test_pointers_of_32_bits(self):
        said = self.refused(*COMPILER, "-DCMAKE_CXX_COMPILER_FORCED=1", "-DCMAKE_SIZEOF_VOID_P=4")
        self.assertIn("was asked to build for x86_64 Linux with pointers of 4 bytes (8 are needed)", said)

    def test_tests_on_another_processor(self):
        said = self.refused(*COMPILER, "-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=aarch64", "-DIST_TESTS=ON")
        self.assertIn("The tests run on x86-64, and CMAKE_SYSTEM_PROCESSOR is aarch64: set IST_TESTS=OFF and IST_GOLDEN=ON", said)

    def test_an_old_compiler(self):
        said = self.refused(*COMPILER, "-DCMAKE_CXX_COMPILER_FORCED=1", "-DCMAKE_SIZEOF_VOID_P=8",
                            "-DCMAKE_CXX_COMPILER_ID_RUN=1", "-DCMAKE_CXX_COMPILER_ID=GNU", "-DCMAKE_CXX_COMPILER_VERSION=11.4.0")
        self.assertIn("compiled by g++ from 12 or clang++ from 14 on, and CMAKE_CXX_COMPILER is GNU 11.4.0", said)

    def test_a_missing_compiler(self):
        said = self.refused("-DCMAKE_CXX_COMPILER=clang++-99")
        self.assertIn("clang++-99 is missing: install it, or run scripts/setup.sh --cross", said)

    def test_a_missing_emulator(self):
        programs = {"qemu-aarch64", "aarch64-linux-gnu-g++"}
        for program in programs:
            with self.subTest(program):
                self.setUp()
                path = self.path_without(*programs)
                for other in programs - {program}:
                    (pathlib.Path(path) / other).symlink_to("/bin/true")
                said = self.refused("--toolchain", SOURCE / "scripts/toolchains/arm64.cmake", path=path)
                self.assertIn(f"{program} is missing: run scripts/setup.sh --cross", said)

    def test_missing_node(self):
        said = self.refused("--toolchain", SOURCE / "scripts/toolchains/wasm.cmake", "-DIST_WITH_TBB=OFF",
                            "-DIST_WITH_ZLIB=OFF", path=self.path_without("node", "nodejs"))
        self.assertIn("Emscripten or node is missing: run scripts/setup.sh --cross", said)

    def test_threads_in_webassembly(self):
        if not shutil.which("em++"):
            if os.environ.get("IST_REQUIRE_ALL") == "1":
                self.fail("IST_REQUIRE_ALL is set, and Emscripten is missing: run scripts/setup.sh --cross")
            self.skipTest("Emscripten is missing: run scripts/setup.sh --cross")
        said = self.refused("--toolchain", SOURCE / "scripts/toolchains/wasm.cmake")
        self.assertIn("WebAssembly has neither threads nor zlib here: set IST_WITH_TBB=OFF", said)

    def test_tbb_in_a_portable_library(self):
        said = self.refused(*COMPILER, "-DIST_PORTABLE=ON")
        self.assertIn("A portable library has threads of its own, and no oneTBB: set IST_WITH_TBB=OFF", said)

    def test_a_maintainer_without_an_address(self):
        for maintainer in ("Ada Example", "ada@example.org", "Ada <ada>", 'Ada "A" Example <ada@example.org>'):
            with self.subTest(maintainer):
                said = self.refused(*COMPILER, f"-DIST_MAINTAINER={maintainer}")
                self.assertIn(f'IST_MAINTAINER is "{maintainer}": give a name and an address, as in Ada Example <ada@example.org>', said)

    def test_a_page_without_an_address(self):
        said = self.refused(*COMPILER, "-DIST_HOMEPAGE=example.org")
        self.assertIn('IST_HOMEPAGE is "example.org": give an address that begins with https://', said)


if __name__ == "__main__":
    unittest.main()
