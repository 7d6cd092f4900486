#include "cli/contact_writer.h"

#include <nlohmann/json.hpp>

#include "ist/base/pose.h"
#include "ist/tree/saved_spheres.h"

namespace ist::cli {
namespace {

nlohmann::ordered_json triple(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

ContactWriter::ContactWriter(const std::filesystem::path& file, const Bodies& bodies)
    : file_(file),
      bodies_(bodies),
      fixed_(level_spheres(bodies.fixed, bodies.policy, 0)),
      moving_(level_spheres(bodies.moving, bodies.policy, 0)),
      query_(bodies.fixed, bodies.moving, {.policy = bodies.policy}),
      points_(bodies.fixed, bodies.moving, bodies.policy) {}

void ContactWriter::write(std::size_t index, const Eigen::Isometry3d& pose,
                          std::span<const LeafPair> leaf_pairs, bool complete) {
  const auto add = [this](const nlohmann::ordered_json& line) {
    lines_ += line.dump();
    lines_ += '\n';
    if (lines_.size() > (1 << 20)) flush();
  };
  // The rigid pose nearest to the given one, which the query answers for.
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  for (const LeafPair& pair : leaf_pairs) {
    const Eigen::Vector3d fixed = bodies_.fixed.origin() + fixed_[pair.fixed].centre;
    const Eigen::Vector3d moving = rigid * (bodies_.moving.origin() + moving_[pair.moving].centre);
    add({{"index", index},
         {"kind", "leaf pair"},
         {"fixed_centre", triple(fixed)},
         {"moving_centre", triple(moving)}});
  }
  if (complete) {
    static_cast<void>(query_.contacts(pose, points_));
    for (const Contact& point : points_.points()) {
      add({{"index", index},
           {"kind", "contact"},
           {"position", triple(point.position)},
           {"normal", triple(point.normal)},
           {"depth", point.depth},
           {"weight", point.weight}});
    }
  }
  flush();
}

void ContactWriter::flush() {
  file_.write(lines_.data(), lines_.size());
  lines_.clear();
}

}  // namespace ist::cli
