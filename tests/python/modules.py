"""The files of the package, as wheels, sdists and the Debian package have them."""

import pathlib

SOURCE = pathlib.Path(__file__).resolve().parents[2]
# Others' code in the library that a wheel holds, and the project's: each has a licence there.
PARTS = ["Eigen", "Highway", "IST", "fmt", "nlohmann-json", "toml++", "xxHash", "zlib"]
LICENCES = [f"licences/{part}.txt" for part in PARTS]


def modules():
    folder = SOURCE / "src/python"
    return sorted(str(file.relative_to(folder)) for file in (folder / "ist").rglob("*")
                  if file.suffix in (".py", ".pyi") or file.name == "py.typed")
