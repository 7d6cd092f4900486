"""Reads the binary PLY files that `ist` writes."""
import numpy as np

TYPES = {"float": "<f4", "uchar": "u1", "int": "<i4"}


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
