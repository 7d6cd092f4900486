"""The order of a mesh's triangles in the library's tree of clusters, by the rule that triangle_clusters.h states."""
import numpy as np

WIDTH = 16


def frame_of(triangles):
    """Returns the middle of the mesh, and the axes along which its corners spread, the widest last."""
    corners = triangles.reshape(-1, 3)
    middle = (corners.min(0) + corners.max(0)) / 2
    axes = np.linalg.eigh(np.cov((corners - middle).T))[1]
    return middle, axes * np.sign(axes[np.abs(axes).argmax(0), range(3)])


def order_of(triangles):
    """Returns the indices of triangles so that any 16, 256, 4096 … from a multiple of that number on are neighbours."""
    middle, axes = frame_of(triangles)
    centres = ((triangles - middle) @ axes).sum(1).astype(np.float32)
    done, ahead = [], [np.arange(len(triangles))]
    while ahead:
        part = ahead.pop()
        if len(part) <= WIDTH:
            done.append(part)
            continue
        size = WIDTH
        while size * WIDTH < len(part):
            size *= WIDTH
        half = size * (-(-len(part) // size) // 2)
        axis = np.ptp(centres[part], axis=0).argmax()
        part = part[np.lexsort((part, centres[part, axis]))]
        ahead += [part[half:], part[:half]]
    return np.concatenate(done)
