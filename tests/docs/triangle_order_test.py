"""The clusters in the picture of docs/how-it-works.md are the library's.

    triangle_order_test.py PATH/TO/print_triangle_order PATH/TO/ist FOLDER"""

import pathlib
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts/pictures/how"))
from triangle_order import WIDTH, order_of  # noqa: E402


def clusters(order):
    """The triangles of each cluster; their order in it is not drawn."""
    return [frozenset(order[i:i + WIDTH].tolist()) for i in range(0, len(order), WIDTH)]


def main(printer, ist, folder):
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([ist, "demo", "--keep", folder, "--voxel-size", "8"], check=True, stdout=subprocess.DEVNULL)
    mesh = folder / "lower_jaw.stl"
    printed = subprocess.run([printer, mesh], check=True, capture_output=True, text=True).stdout
    library = clusters(np.array(printed.split(), int))
    rows = np.frombuffer(mesh.read_bytes(), np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
    drawn = clusters(order_of(rows["v"].astype(float)))
    same = sum(a == b for a, b in zip(library, drawn))
    print(f"{same} of {len(library)} clusters are the library's")
    return 0 if library and same == len(library) == len(drawn) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3], pathlib.Path(sys.argv[3])))
