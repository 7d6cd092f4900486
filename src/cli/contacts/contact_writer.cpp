#include "cli/contacts/contact_writer.h"

#include <cmath>
#include <numbers>

#include "ist/base/pose.h"
#include "ist/tree/saved_spheres.h"

namespace ist::cli {

ContactWriter::ContactWriter(const std::filesystem::path& file, const Bodies& bodies)
    : file_(open_contact_file(file)),
      bodies_(bodies),
      fixed_(level_spheres(bodies.fixed, bodies.policy, 0)),
      moving_(level_spheres(bodies.moving, bodies.policy, 0)),
      query_(bodies.fixed, bodies.moving, {.policy = bodies.policy}),
      points_(bodies.fixed, bodies.moving, bodies.policy) {}

void ContactWriter::write(std::size_t index, const Eigen::Isometry3d& pose,
                          std::span<const LeafPair> leaf_pairs, bool complete) {
  // The rigid pose nearest to the given one, which the query answers for.
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  for (const LeafPair& pair : leaf_pairs) {
    ContactRow row{index, ContactRow::Kind::kLeafPair,
                   bodies_.fixed.origin() + fixed_[pair.fixed].centre, fixed_[pair.fixed].radius};
    row.moving_centre = rigid * (bodies_.moving.origin() + moving_[pair.moving].centre);
    file_->add(row);
  }
  if (!complete) return;
  static_cast<void>(query_.contacts(pose, points_));
  for (const Contact& point : points_.points()) {
    ContactRow row{index, ContactRow::Kind::kContact, point.position,
                   std::sqrt(point.weight / std::numbers::pi)};
    row.normal = point.normal;
    row.depth = point.depth;
    row.weight = point.weight;
    file_->add(row);
  }
}

}  // namespace ist::cli
