"""Spheres and boxes as triangles, outwards: corners of shape (n, 3, 3), float64."""
from oracles import np


def sphere(radius, divisions, centre=(0, 0, 0)):
    """An icosahedron of which each triangle was split into four `divisions` times; its vertices lie on the sphere."""
    g = (1 + 5 ** 0.5) / 2
    points = np.array([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g],
                       [0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]])
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    corners = points[np.array(faces)]
    for _ in range(divisions):
        a, b, c = corners.transpose(1, 0, 2)
        # The sum of two is the same either way round, so neighbours share their middles.
        ab, bc, ca = a + b, b + c, c + a
        corners = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        corners /= np.linalg.norm(corners, axis=2, keepdims=True)
    return corners / np.linalg.norm(corners, axis=2, keepdims=True) * radius + centre


def box(low, high, parts):
    """Each face is a grid of rectangles, `parts` of them along each axis, cut along the diagonal."""
    low, high = np.array(low, float), np.array(high, float)
    out = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        i, j = (k.ravel() for k in np.meshgrid(np.arange(parts[u]), np.arange(parts[v]), indexing="ij"))
        for at in (low[axis], high[axis]):
            def corner(di, dj):
                point = np.empty((len(i), 3))
                point[:, axis] = at
                point[:, u] = low[u] + (high[u] - low[u]) * (i + di) / parts[u]
                point[:, v] = low[v] + (high[v] - low[v]) * (j + dj) / parts[v]
                return point
            a, b, c, d = corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)
            for triangle in ((a, b, c), (a, c, d)):
                out.append(np.stack(triangle if at == high[axis] else triangle[::-1], axis=1))
    return np.concatenate(out)


def sagitta(corners, radius, centre=(0, 0, 0)):
    """Returns by how much the facets of a sphere's mesh come nearer to the centre than its radius, at most."""
    a, b, c = (corners - np.array(centre)).transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    return radius - ((a * normal).sum(1) / np.linalg.norm(normal, axis=1)).min()


def longest_edge(corners):
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max()
