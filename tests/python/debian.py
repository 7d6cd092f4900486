"""The package python3-ist, in a root that holds what it depends on, and installed and removed there by dpkg."""

from checks import need, require, run
from clean_root import CleanRoot
from environments import PYTHON, clean_environment, modules

PLACE = "usr/lib/python3/dist-packages"


class DebianPackage:
    def dpkg(self, root, *words):
        """As far from this machine as dpkg allows: scripts run with DPKG_ROOT, and dependencies are not asked for."""
        run("dpkg", f"--root={root}", f"--log={root}/log", "--force-not-root", "--force-bad-path", "--force-script-chrootless",
            "--force-depends", *words)

    def Debian(self):
        need("dpkg", "dpkg-deb", "dpkg-query", "py3compile")
        packages = sorted((self.build / "tests/package/debian/packages").glob("*.deb"))
        folder = self.fresh("debian")
        root = CleanRoot(folder / "root", packages)
        version = root.field("libist0", "Version")
        depends = root.field("python3-ist", "Depends")
        require(depends == f"libist0 (= {version}), python3 (>= 3.9), python3-numpy (>= 1:1.21)", f"it depends on {depends}")
        require(root.field("python3-ist", "Architecture") == "all", "it is of one architecture")
        require({"python3", "python3-numpy"} <= root.closure("python3-ist"), "it brings no Python, or no numpy")
        file = root.files["python3-ist"]
        content = sorted(line.split()[5] for line in run("dpkg-deb", "-c", file).splitlines() if not line.endswith("/"))
        info = [f"ist-{version}.dist-info/{name}" for name in ("INSTALLER", "METADATA")]
        expected = sorted([*(f"./{PLACE}/{name}" for name in [*modules(), *info]),
                           *(f"./usr/share/doc/python3-ist/{name}" for name in ("changelog.gz", "copyright"))])
        require(content == expected, f"it holds {content}")

        environment = {"PYTHONPATH": f"{root.path}/{PLACE}", "LD_LIBRARY_PATH": str(root.libraries)}
        answers = self.answers(PYTHON, root.libraries / "libist_loop.so.0", **environment)
        require(answers == self.expected(), f"it answers\n{answers}")
        said = run(PYTHON, "-B", "-c", "import importlib.metadata as m; print(m.version('ist'))", env=clean_environment(**environment))
        require(said.strip() == version, f"its metadata say {said}")

        own = folder / "installed"
        for name in ("info", "updates", "triggers"):
            (own / "var/lib/dpkg" / name).mkdir(parents=True)
        (own / "var/lib/dpkg/status").touch()
        self.dpkg(own, "--install", root.files["libist0"], file)
        compiled = sorted((own / PLACE / "ist/__pycache__").glob("*.pyc"))
        require(len(compiled) >= 3, f"byte code is {compiled}")
        libraries = own / root.libraries.relative_to(root.path)
        run(PYTHON, "-O", "-c", "import ist",  # writes other byte code
            env=clean_environment(PYTHONPATH=own / PLACE, LD_LIBRARY_PATH=libraries))
        self.dpkg(own, "--remove", "python3-ist")
        left = [str(path) for path in own.rglob("*") if path.is_relative_to(own / "usr/lib/python3") or "python3-ist" in path.name]
        require(not left, f"its removal leaves {left}")
