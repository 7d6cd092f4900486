"""The command, its two jaws, and their trees: what the pictures of docs/how-it-works.md are drawn from."""
import json
import subprocess

import numpy as np

from pictures.ply import positions, read_ply

VOXEL_SIZE = 0.8
POLICIES = ("simple", "table", "tight", "slab")
NAMES = ("upper", "lower")  # the fixed jaw, and the moving one


class Command:
    """Runs `ist` in a folder of its own, in which it makes the built-in jaws."""

    def __init__(self, ist, folder):
        self.ist, self.folder = ist, folder
        self.lines("demo", "--keep", folder, "--voxel-size", 8)

    def lines(self, *arguments):
        """Returns the lines that the command prints."""
        run = subprocess.run([self.ist, *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True)
        return run.stdout.splitlines()

    def answer(self, *arguments):
        """Returns the last object of a subcommand's --json."""
        return json.loads(self.lines(*arguments, "--json")[-1])

    def mesh(self, name):
        return self.folder / f"{name}_jaw.stl"

    def tree(self, name, *options, voxel_size=VOXEL_SIZE):
        """Builds a jaw's tree once, and returns its file."""
        file = self.folder / "-".join([name, str(voxel_size), *(word.strip("-") for word in options)])
        file = file.with_name(file.name + ".ist")
        if not file.exists():
            self.lines("build", self.mesh(name), "-o", file, "--voxel-size", voxel_size, *options)
        return file

    def spheres(self, tree, policy, level):
        """Returns the spheres of a level in the octree's order, a row each: the centre and the radius."""
        file = self.folder / "spheres.ply"
        self.lines("export", tree, "--what", "spheres", "--spheres", policy, "--level", level, "-o", file)
        points, _ = read_ply(file)
        return np.column_stack([positions(points), points["radius"].astype(float)])
