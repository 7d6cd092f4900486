"""Runs the add-on in Blender, and reads back the colours that it gave.

    blender_itself.py LIBIST

LIBIST is the shared library. Where there is no blender, that is said, and the exit code is 77; with IST_REQUIRE_ALL=1 it
is 1. scripts/test.sh --long runs this.
"""

import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def main(library):
    if shutil.which("blender") is None:
        print("blender_itself: skipped: blender is not installed: apt-get install blender", file=sys.stderr)
        return 1 if os.environ.get("IST_REQUIRE_ALL") == "1" else 77
    ran = subprocess.run(["blender", "-b", "--factory-startup", "-noaudio", "--python-exit-code", "1", "--python", HERE / "in_blender.py"],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, timeout=600,
                         env=dict(os.environ, IST_LIBRARY=str(pathlib.Path(library).resolve())))
    print(ran.stdout, end="")
    if ran.returncode == 0 and "in_blender: all held" in ran.stdout:
        return 0
    print(f"blender_itself: blender ended with {ran.returncode}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
