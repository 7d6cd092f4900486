"""Runs the class of docs/chai3d.md in the hand of a scripted device (chai3d/turns.cpp): with own declarations of CHAI3D (stubs/),
under two compilers; or, with --itself, with the built source tree of CHAI3D 3.3 that IST_CHAI3D names. No package of Debian 12
has CHAI3D, so where IST_CHAI3D is not set that is said and the exit code is 77, also with IST_REQUIRE_ALL=1."""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

import pages
from snippets import OTHER_COMPILER, SKIPPED, STUBS, WARNINGS

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE.parent.parent / "examples/probe.toml"


def run(*command, **options):
    """Prints what a command prints, and ends the test where it fails."""
    ran = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)
    print(ran.stdout, end="", flush=True)
    if ran.returncode != 0:
        sys.exit(f"chai3d_tool: failed with {ran.returncode}: {' '.join(map(str, command))}")
    return ran.stdout


def tool_of(page):
    """The text of the page's one class."""
    blocks = [block.text for block in pages.read(page.read_text()).blocks if "class IstTool" in block.text]
    if len(blocks) != 1:
        sys.exit(f"chai3d_tool: {page.name} shows {len(blocks)} times how to write the tool")
    return blocks[0]


def with_declarations(folder, prefix, libraries, compilers):
    """The same numbers by each compiler."""
    printed = set()
    for compiler in compilers:
        binary = folder / f"turns.{pathlib.Path(compiler).name}"
        run(compiler, "-std=c++20", "-O1", *WARNINGS, f"-I{folder}", f"-I{prefix}/include", f"-I{STUBS}", HERE / "chai3d/turns.cpp",
            "-o", binary, f"-L{libraries}", "-list_loop", "-list")
        printed.add(run(binary, SCENE, env=dict(os.environ, LD_LIBRARY_PATH=str(libraries))))
    if len(printed) != 1:
        sys.exit("chai3d_tool: the compilers' programs print different numbers")


def with_chai3d(folder, prefix, libraries, compiler):
    run("cmake", "-Wno-dev", "-S", HERE / "chai3d", "-B", folder / "itself", "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_COMPILER={compiler}",
        f"-DIST_TOOL_FOLDER={folder}", f"-DIST_INCLUDE_FOLDER={prefix}/include", f"-DIST_LIBRARY_FOLDER={libraries}")
    run("cmake", "--build", folder / "itself")
    run(folder / "itself/turns", SCENE, env=dict(os.environ, LD_LIBRARY_PATH=str(libraries)))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--prefix", type=pathlib.Path, required=True)
    parser.add_argument("--compiler", required=True)
    parser.add_argument("--itself", action="store_true")
    arguments = parser.parse_args()
    if arguments.itself and not os.environ.get("IST_CHAI3D"):
        print("chai3d_tool: skipped: IST_CHAI3D is not set; it names a built source tree of CHAI3D 3.3")
        return SKIPPED
    if not arguments.itself and shutil.which(OTHER_COMPILER) is None:
        print(f"chai3d_tool: {OTHER_COMPILER} is not installed: scripts/setup.sh --package does that", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else SKIPPED
    folder = arguments.work / ("chai3d_itself" if arguments.itself else "chai3d_tool")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "ist_tool.h").write_text(f"#pragma once\n{tool_of(arguments.page)}")
    libraries = next(arguments.prefix.rglob("pkgconfig/ist.pc")).parent.parent
    if arguments.itself:
        with_chai3d(folder, arguments.prefix, libraries, arguments.compiler)
    else:
        with_declarations(folder, arguments.prefix, libraries, (arguments.compiler, OTHER_COMPILER))
    return 0


if __name__ == "__main__":
    sys.exit(main())
