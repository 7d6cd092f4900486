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
      points_(bodies.fixed, bodies.moving, bodies.policy) {}

void ContactWriter::write(std::size_t index, const Eigen::Isometry3d& pose,
                          std::span<const Contact> contacts, bool complete) {
  // As the query does: the pose that is answered for is the rigid one nearest to what was given.
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  for (const Contact& contact : contacts) {
    const Eigen::Vector3d fixed = bodies_.fixed.lattice().origin() + fixed_[contact.fixed].centre;
    const Eigen::Vector3d moving =
        rigid * (bodies_.moving.lattice().origin() + moving_[contact.moving].centre);
    add(nlohmann::ordered_json{
        {"index", index}, {"fixed_centre", triple(fixed)}, {"moving_centre", triple(moving)}}
            .dump());
  }
  if (complete && points_.begin(pose)) {
    points_.take(contacts);
    points_.finish();
    for (const ContactPoint& point : points_.points()) {
      add(nlohmann::ordered_json{{"index", index},
                                 {"position", triple(point.position)},
                                 {"normal", triple(point.normal)},
                                 {"depth", point.depth},
                                 {"weight", point.weight}}
              .dump());
    }
  }
  flush();
}

void ContactWriter::add(const std::string& line) {
  lines_ += line;
  lines_ += '\n';
  if (lines_.size() > (1 << 20)) flush();
}

void ContactWriter::flush() {
  file_.write(lines_.data(), lines_.size());
  lines_.clear();
}

}  // namespace ist::cli
