"""The documents of an install tree, and how it is removed again."""

import os
import pathlib
import re
import subprocess

from checks import require, run

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent


def files_below(folder):
    return {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_symlink() or not file.is_dir()}


class Installed:
    build = prefix = None

    def Documents(self):
        """All are there, each link leads to a file, and the scenes are sound."""
        documents = self.prefix / "share/doc/ist"
        pages = ["README.md", "CHANGELOG.md", *(f"docs/{page.name}" for page in (SOURCE / "docs").glob("*.md"))]
        shown = 0
        for name in pages:
            page = documents / name
            text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)  # C++ has brackets too
            for target in re.findall(r"\]\(([^()\s]+)\)", text):
                if target.startswith(("http", "#")):
                    continue
                file = page.parent / target.split("#")[0]
                require(file.is_file(), f"{page} links to {target}, which is not there")
                shown += file.suffix in (".png", ".svg")
            require("tests/data/scenes" not in text, f"{page} names a folder of the sources")
        require(shown >= 2, f"{shown} pictures are shown")
        whole = (SOURCE / "README.md").read_text()
        require(len((documents / "README.md").read_text()) > 0.97 * len(whole), "README has lost some of its text")
        examples = {name for name in files_below(documents) if name.startswith("examples/")}
        own = SOURCE / "examples"
        expected = {f"examples/{file.relative_to(own)}" for file in own.rglob("*") if file.is_file() and file.suffix != ".pyc"}
        expected |= {f"examples/scenes/{file.name}" for file in (SOURCE / "tests/data/scenes").iterdir()}
        require(examples == expected and len(expected) >= 7, f"the examples are {examples}")
        for scene in ("press", "slide"):
            run(self.prefix / "bin/ist", "run", "--check", documents / f"examples/scenes/{scene}.toml")

    def uninstall(self, environment=None):
        return subprocess.run(["cmake", "--build", self.build, "--target", "uninstall"], capture_output=True, text=True,
                              env=environment, check=False)

    def Uninstall(self):
        """It removes what was installed, and nothing else, also below a DESTDIR."""
        prefix = self.fresh("uninstall")
        strangers = {"include/ist/of_others.h", "lib/libother.so", "share/doc/ist/.of_others", "share/man/man1/other.1"}
        for name in strangers:
            (prefix / name).parent.mkdir(parents=True, exist_ok=True)
            (prefix / name).write_text("")
        run("cmake", "--install", self.build, "--prefix", prefix)
        count = len(files_below(prefix)) - len(strangers)
        require(count > 70, f"{count} files are installed")
        (prefix / "bin/ist").unlink()
        ran = self.uninstall()
        require(ran.returncode == 0 and f"Removed {count - 1} files" in ran.stdout, ran.stdout + ran.stderr)
        require(f"Was not there: {prefix}/bin/ist\n" in ran.stdout, ran.stdout)
        require(files_below(prefix) == strangers, f"left are {files_below(prefix)}")
        again = self.uninstall()
        require(again.returncode != 0 and "Nothing is installed from this build" in again.stdout + again.stderr, again.stdout)

        below = self.fresh("uninstall_below")
        environment = {**os.environ, "DESTDIR": str(below)}
        run("cmake", "--install", self.build, "--prefix", "/usr", env=environment)
        require(len(files_below(below)) == count, f"below DESTDIR are {len(files_below(below))} files")
        ran = self.uninstall(environment)
        require(ran.returncode == 0 and f"Removed {count} files" in ran.stdout, ran.stdout + ran.stderr)
        left = [str(path) for path in below.rglob("*") if not path.is_dir() or "ist" in path.name.split("-")[0]]
        require(not left, f"left are {left}")
