"""What pictures are drawn with: the command and the files that it writes, a depth buffer, and small PNG files."""
import io
import json
import pathlib
import subprocess

import matplotlib
import numpy as np
from PIL import Image

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, F401  after the backend is chosen; scripts take it from here

VOXEL_SIZE = 0.8
POLICIES = ("simple", "table", "tight", "slab")
NAMES = ("upper", "lower")  # the fixed jaw, and the moving one
TYPES = {"float": "<f4", "uchar": "u1", "int": "<i4"}  # of PLY files
TILES = 1 << 20  # samples that are looked at together


class Command:
    """Runs `ist` in a folder of its own, and makes the built-in jaws there."""

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


def read_stl(file):
    rows = np.frombuffer(file.read_bytes(), np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
    return rows["v"].astype(float)


def read_ply(file):
    """Returns the vertices, an array with a field for each property, and the faces, corners by row, or None.

    All faces of a file have as many corners as its first.
    """
    header, body = file.read_bytes().split(b"end_header\n", 1)
    counts, vertex = {}, []
    for words in (line.split() for line in header.decode().splitlines()):
        if words[0] == "element":
            counts[words[1]] = int(words[2])
        elif words[0] == "property" and words[1] != "list":
            vertex.append((words[2], TYPES[words[1]]))
    vertices = np.frombuffer(body, np.dtype(vertex), counts["vertex"])
    if "face" not in counts:
        return vertices, None
    corners = body[vertices.nbytes]
    face = np.dtype([("corners", "u1"), ("vertices", "<i4", corners)])
    return vertices, np.frombuffer(body, face, counts["face"], vertices.nbytes)["vertices"]


def positions(vertices):
    """Returns the positions of vertices, a row each."""
    return np.stack([vertices["x"], vertices["y"], vertices["z"]], axis=1).astype(float)


def eye_axes(back):
    """Returns the directions to the right, up and towards an eye that stands upright far away in a direction."""
    back = back / np.linalg.norm(back)
    right = np.cross([0, 0, 1], back)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(back, right), back])


def normals_of(triangles):
    """Returns the normals of triangles, of length 1."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


class DepthBuffer:
    """The number of the triangle or ball nearest to the eye at each sample, or -1, and its depth.

    Points are in samples: to the right, up, and towards the eye. Triangles that look away are not drawn, so bodies must be closed and wound outwards.
    """

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.depth = np.full(width * height, -np.inf)
        self.nearest = np.full(width * height, -1)

    def draw_balls(self, balls):
        """Draws balls, a row each: the centre and the radius."""
        grid = np.arange(self.width * self.height).reshape(self.height, self.width)
        y, x = np.divmod(grid.ravel(), self.width)
        for ball, (right, up, near, radius) in enumerate(balls):
            low, high = np.floor([up - radius, right - radius]).clip(0).astype(int), np.ceil([up + radius, right + radius]).astype(int)
            at = grid[low[0]:high[0], low[1]:high[1]].ravel()
            squared = radius**2 - (x[at] + 0.5 - right) ** 2 - (y[at] + 0.5 - up) ** 2
            depth = near + np.sqrt(squared.clip(0))
            seen = (squared > 0) & (depth > self.depth[at])
            self.depth[at[seen]], self.nearest[at[seen]] = depth[seen], ball

    def draw(self, points, faces):
        corners = points[faces]
        seen = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) > 0
        low = np.floor(corners[..., :2].min(1)).astype(int)
        size = np.ceil(corners[..., :2].max(1)).astype(int) - low
        seen &= ((low + size > 0) & (low < (self.width, self.height))).all(1)
        edge = 1 << np.ceil(np.log2(np.maximum(size.max(1), 1))).astype(int)
        for tile in np.unique(edge[seen]):
            chosen = np.flatnonzero(seen & (edge == tile))
            y, x = np.divmod(np.arange(tile * tile), tile)
            for part in np.array_split(chosen, len(chosen) * tile * tile // TILES + 1):
                self._draw_tiles(part, corners[part], low[part, :1] + x, low[part, 1:] + y)

    def _draw_tiles(self, triangles, corners, x, y):
        a, b, c = (corners[:, None, i, :2] for i in range(3))
        at = np.stack([x, y], axis=-1) + 0.5
        weights = np.stack([cross(b - at, c - at), cross(c - at, a - at), cross(a - at, b - at)], axis=-1)
        weights /= cross(b - a, c - a)[..., None]
        depth = (weights * corners[:, None, :, 2]).sum(-1)
        hit = (weights >= 0).all(-1) & (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
        place, depth = (y * self.width + x)[hit], depth[hit]
        triangles = np.broadcast_to(triangles[:, None], hit.shape)[hit]
        order = np.argsort(depth, kind="stable")  # of two at one sample the nearer is written last
        order = order[depth[order] > self.depth[place[order]]]
        self.depth[place[order]], self.nearest[place[order]] = depth[order], triangles[order]


def save_small_png(figure, file, dpi=100):
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=dpi)
    image = Image.open(drawn).convert("RGB")
    palette = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=3)  # keeps the rare colours
    colours = palette.getpalette()
    for i in range(0, len(colours), 3):
        if min(colours[i : i + 3]) >= 248:
            colours[i : i + 3] = 255, 255, 255  # the ground, which some palettes show nearly white
    palette.putpalette(colours)
    pathlib.Path(file).parent.mkdir(parents=True, exist_ok=True)
    image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(file, optimize=True)
