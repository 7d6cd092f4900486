"""Which triangle of a mesh is seen at each sample of a picture."""
import numpy as np

TILES = 1 << 20  # samples that are looked at together


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


class DepthBuffer:
    """The triangle nearest to the eye at each sample, or -1, and the weights of its corners there.

    Points are in samples: to the right, up, and towards the eye. Triangles that look away are not drawn, so bodies
    must be closed and wound outwards.
    """

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.depth = np.full(width * height, -np.inf)
        self.triangle = np.full(width * height, -1)
        self.weights = np.zeros((width * height, 3))

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
        place, depth, weights = (y * self.width + x)[hit], depth[hit], weights[hit]
        triangles = np.broadcast_to(triangles[:, None], hit.shape)[hit]
        order = np.argsort(depth, kind="stable")  # of two at one sample the nearer is written last
        order = order[depth[order] > self.depth[place[order]]]
        place = place[order]
        self.depth[place], self.triangle[place], self.weights[place] = depth[order], triangles[order], weights[order]
