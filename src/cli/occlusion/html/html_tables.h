#pragma once

#include <string>

#include "cli/occlusion/bite.h"

namespace ist::cli {

/// The tables of a report, as HTML. Distances are in micrometres, areas in mm², places in mesh
/// units and fixed coordinates; indices are those of the regions, from 0.

/// Both bodies: names, hashes, counts, what is certain of them.
[[nodiscard]] std::string body_table(const Bite& bite);
/// The pose, row by row, so that its numbers come back exactly.
[[nodiscard]] std::string pose_table(const Bite& bite);
/// Whether the bodies touch, how far they are apart and how deep in each other; by triangles alone,
/// so without the contact points, which are as coarse as voxels.
[[nodiscard]] std::string findings_table(const Bite& bite);
/// The areas at the limits of the preset, and what overlaps.
[[nodiscard]] std::string area_table(const Bite& bite);
/// The shares by side, and by front and back.
[[nodiscard]] std::string share_table(const Bite& bite);
/// The teeth; empty where no body has labels.
[[nodiscard]] std::string tooth_table(const Bite& bite);
/// The contact regions that have a partner, and apart from them those that have none.
[[nodiscard]] std::string region_tables(const Bite& bite);

}  // namespace ist::cli
