"""Modules that find no library, or one that does not fit: an ImportError says so, and names the remedy."""

import zipfile

from checks import need, require, run
from environments import PYTHON, tries

# Each stands for a library, with the words that the error must have.
OTHERS = {
    "an older one": ("unsigned ist_abi_version(void) { return 0; }", ["version 0", "of one version"]),
    "one that lacks functions": ("unsigned ist_abi_version(void) { return 1000; }", ["ist_", "of one version"]),
    "another one": ("int other(void) { return 0; }", ["ist_abi_version", "of one version"]),
}


class WithoutLibrary:
    def refused(self, folder, **environment):
        """The last line of `import ist` with the modules of a folder."""
        ran = tries(PYTHON, "-B", "-c", "import ist", PYTHONPATH=folder, **environment)
        said = (ran.stderr.strip().splitlines() or ["nothing"])[-1]
        require(ran.returncode == 1 and said.startswith("ImportError: ist: "), f"import ist says {ran.stdout}{ran.stderr}")
        return said

    def Remedies(self):
        need("cc")
        folder = self.fresh("remedies")
        with zipfile.ZipFile(self.one("*.whl")) as wheel:
            wheel.extractall(folder)
        library = folder / "ist/libist_loop.so.0"
        run(PYTHON, "-B", "-c", "import ist", env={"PYTHONPATH": str(folder)})  # it does work before
        library.unlink()
        cases = {"none": (self.refused(folder), ["libist_loop.so.0", "libist0", "wheel", "IST_LIBRARY"])}
        missing = folder / "missing.so"
        cases["a missing file"] = self.refused(folder, IST_LIBRARY=missing), [str(missing), "IST_LIBRARY"]
        missing.write_text("no library\n")
        cases["a text"] = self.refused(folder, IST_LIBRARY=missing), [str(missing), "IST_LIBRARY"]
        for name, (source, words) in OTHERS.items():
            run("cc", "-shared", "-fPIC", "-x", "c", "-", "-o", library, "-Wl,-soname,libist_loop.so.0", input=source)
            cases[name] = self.refused(folder), [str(library), *words]
        for name, (said, words) in cases.items():
            lacks = [word for word in words if word not in said]
            require(not lacks, f"with {name} for a library the error lacks {lacks}: {said}")
