#pragma once

#include <string>

#include "answers/occlusion/bite.h"

namespace ist::cli {

/// The tables of a report, as HTML. Headings name the units. Places are in mesh units and fixed
/// coordinates.

/// Both bodies: names, hashes, counts, what is certain of them.
[[nodiscard]] std::string body_table(const answers::Bite& bite);
/// The pose, row by row, so that its numbers come back exactly.
[[nodiscard]] std::string pose_table(const answers::Bite& bite);
/// Whether the bodies touch, how far they are apart and how deep in each other; by triangles alone,
/// so without the contact points, which are as coarse as voxels.
[[nodiscard]] std::string findings_table(const answers::Bite& bite);
/// The areas at the limits of the preset, and how much overlaps how deep.
[[nodiscard]] std::string area_table(const answers::Bite& bite);
/// The shares by side, and by front and back. Without contacts, a sentence says so.
[[nodiscard]] std::string share_table(const answers::Bite& bite);
/// The teeth; empty where no body has labels.
[[nodiscard]] std::string tooth_table(const answers::Bite& bite);
/// The contacts on both bodies, then the contacts on one body alone. Without contacts, a sentence
/// says so.
[[nodiscard]] std::string contact_tables(const answers::Bite& bite);

/// Returns both distance maps as figures of HTML, and their legend: pictures of 900 × 700 pixels
/// within it, on which the contact regions are numbered, a bar shows the scale, and the edges have
/// the names of the sides that lie there. Cost: some 0.1 s a body of 250,000 triangles.
[[nodiscard]] std::string bite_figures(const answers::Bite& bite);

}  // namespace ist::cli
