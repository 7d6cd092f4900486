#include "loop/haptics/bodies/tool_contact_query.h"

#include <algorithm>
#include <cmath>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query_state.h"

namespace ist {
namespace {

// Of ContactRates.
constexpr double kRounding = 0x1p-16;

QueryOptions of_query(const ToolContactOptions& options) {
  return {.policy = options.policy,
          .workers = options.workers,
          .period = options.period,
          .front_pairs = options.front_pairs};
}

ManifoldOptions of_manifold(const ToolContactOptions& options) {
  return {.points = ToolContacts::kMost, .margin = options.margin, .reach = options.reach};
}

}  // namespace

Eigen::Isometry3d BodyFrames::query_pose(const Placement& tool) const noexcept {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Matrix3d to_fixed = fixed.rotation.transpose();
  const Eigen::Matrix3d held = tool.rotation * held_turn;
  pose.linear() = to_fixed * held;
  pose.translation() =
      to_fixed * ((tool.translation - fixed.translation) / unit - held * tool_origin);
  return pose;
}

Eigen::Vector3d BodyFrames::to_scene(const Eigen::Vector3d& point) const noexcept {
  return fixed.rotation * (unit * point) + fixed.translation;
}

ToolContactQuery::ToolContactQuery(const SphereTree& fixed, const SphereTree& held,
                                   const BodyFrames& frames, const ToolContactOptions& options)
    : frames_(frames),
      area_(fixed.voxel_size() * held.voxel_size()),
      full_area_(options.full_area * area_),
      size_(0.5 * (fixed.voxel_size() + held.voxel_size())),
      fixed_radius_(fixed.bounding_radius()),
      held_origin_(held.origin()),
      query_(fixed, held, of_query(options)),
      margin_(options.margin * size_),
      manifold_(fixed, held, options.policy, of_manifold(options)) {}

std::size_t ToolContactQuery::bytes_for(const SphereTree& fixed, const SphereTree& held,
                                        const ToolContactOptions& options) {
  return detail::QueryState::bytes_for(fixed, held, of_query(options)) +
         detail::ContactReducer::bytes_for(fixed, held, of_manifold(options));
}

QueryResult ToolContactQuery::find(const Placement& tool, const Budget& budget,
                                   ToolContacts& contacts, std::size_t number) noexcept {
  const Eigen::Isometry3d pose = frames_.query_pose(tool);
  QueryResult result = query_.contacts(pose, manifold_, budget);
  if (result.status != QueryStatus::kDone || !result.complete) return result;
  contacts.begin_pair(number);
  add_to(contacts, tool);
  return result;
}

void ToolContactQuery::add_to(ToolContacts& contacts, const Placement& tool) const noexcept {
  const ContactSums& sums = manifold_.sums();
  const double fraction = 1 / std::max(sums.weight, full_area_);
  contacts.count += sums.weight / area_;

  const Eigen::Matrix3d& turn = frames_.fixed.rotation;
  const Eigen::Vector3d arm = frames_.to_scene(sums.about) - tool.translation;
  const Eigen::Vector3d force = turn * ((fraction * frames_.unit) * sums.spring.force);
  contacts.spring.head<3>() += force;
  contacts.spring.tail<3>() +=
      turn * ((fraction * frames_.unit * frames_.unit) * sums.spring.torque) + arm.cross(force);
  add_rates(contacts.rates, fraction);

  for (const Contact& point : manifold_.points()) {
    contacts.add({frames_.to_scene(point.position) - tool.translation, turn * point.normal,
                  frames_.unit * std::max(0.0, point.depth + margin_), fraction * point.weight});
  }
}

// Divides the manifold's rates of a leaf pair by the area that shares the stiffness. That area
// changes too. A torque turns about the tool's origin.
void ToolContactQuery::add_rates(SpringRates& rates, double fraction) const noexcept {
  const ContactRates& of_pair = manifold_.rates();
  const double from_origin = std::sqrt((held_origin_ - frames_.tool_origin).squaredNorm());
  const double lever = from_origin + of_pair.lever;
  const double greatest = 3 * size_;  // depth of a spring
  const double force = of_pair.spring_force + greatest * of_pair.weight;
  const double pairs = fraction * static_cast<double>(manifold_.sums().pairs);
  rates.force += pairs * force;
  rates.torque += pairs * frames_.unit * (lever * force + 1.5 * greatest * area_);
  rates.lever = std::max(rates.lever, frames_.unit * lever);
  // Torques are rounded about the fixed frame's origin, which may be farther than the tool's.
  const double reach = fixed_radius_ + of_pair.lever;
  const double rounding = kRounding * reach * (1 + 2 * reach / lever);
  rates.rounding = std::max(rates.rounding, frames_.unit * rounding);
}

}  // namespace ist
