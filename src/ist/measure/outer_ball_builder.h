#pragma once

#include <cstdint>

#include "ist/base/progress.h"
#include "ist/tree/outer_balls.h"
#include "ist/tree/sphere_tree.h"

namespace ist {

/// Makes the outer balls of a body from its triangles.
///
/// Seeds are points of triangles, at most one for each main direction of a normal in each cube of
/// half a cell. A ball touches the surface at a seed and lies on its outer side: it begins with a
/// radius of eight cells and shrinks until it is empty. Each cell within three cells along the
/// normal keeps the ball with the least bound for a piece of half a cell. Cells that no ball
/// reaches take the best ball of a neighbour, or look for a ball of their own. A centre whose side
/// is unknown gets no ball.
///
/// The edge of a cell is 1.5 √(mean area of a triangle), and at most 1/32 of the body's longest
/// edge. It grows until the field has at most 28 bytes a triangle, or 1 MiB if that is more.
///
/// The same bits for any number of threads and on every instruction set. Throws kMemoryLimit if no
/// cells fit `max_memory`, and kCancelled. Cost: 9 to 18 µs a triangle, shared by all cores.
/// Precondition: the tree has triangles.
[[nodiscard]] OuterBalls make_outer_balls(const SphereTree& tree, std::uint64_t max_memory,
                                          Progress* progress);

}  // namespace ist
