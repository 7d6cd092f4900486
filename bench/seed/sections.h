#pragma once

#include <vector>

namespace ist::bench {

/// mm in a unit of the article's, where both lower jaws are equally long: as many voxels of one
/// size along the jaw as there.
[[nodiscard]] double published_unit();

/// Each registers its benchmarks.

/// voxels/SIZE, scaled/SIZE in published units, and octree/CELLS.
void add_voxels();
/// levels/POLICY/LEVEL, in voxels of one published unit.
void add_levels();
/// saved/SIZE/POLICY/SOURCE/DISTANCE, and rate/SIZE/ENGINE/POLICY/DISTANCE, where SIZE and DISTANCE
/// are mm, or where SIZE begins with "scaled" published units; and before_contact/SIZE, the
/// DISTANCE right before collision.
void add_rates();

}  // namespace ist::bench
