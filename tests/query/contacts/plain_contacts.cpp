#include "query/contacts/plain_contacts.h"

#include <algorithm>
#include <cmath>

#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"

namespace ist::test {

using Eigen::Vector3d;

PlainContacts::PlainContacts(const SphereTree& fixed, const SphereTree& moving, SpherePolicy policy,
                             const ManifoldOptions& options)
    : fixed_(leaves_of(fixed, policy)),
      moving_(leaves_of(moving, policy)),
      about_(fixed.origin()),
      slabs_(policy == SpherePolicy::kSlab),
      size_(0.5 * (fixed.voxel_size() + moving.voxel_size())),
      area_(fixed.voxel_size() * moving.voxel_size()),
      farthest_(std::sqrt(3.0) * size_),
      least_(-options.margin * size_),
      fade_(options.margin < 2 ? size_ / 4 : 0),
      reach_(options.reach * size_) {}

std::vector<PlainContacts::Leaf> PlainContacts::leaves_of(const SphereTree& tree,
                                                          SpherePolicy policy) {
  std::vector<Leaf> leaves;
  const SavedSpheres spheres = save_spheres(tree, policy);
  for (const Ball& ball : spheres[0]) {
    const Vector3d centre = tree.origin() + ball.centre;
    leaves.push_back({centre, centre, Vector3d::Zero(), Vector3d::Zero(), ball.radius, 0, 0});
    const PackedNormal normal = voxels_of(tree).normals[leaves.size() - 1];
    leaves.back().normal = normal.coherence() * normal.direction();
  }
  if (policy != SpherePolicy::kSlab) return leaves;
  auto leaf = leaves.begin();
  for (std::uint32_t parent = 0; leaf != leaves.end(); ++parent) {
    for (int slot = 0; slot < voxels_of(tree).octree.child_count(1, parent); ++slot, ++leaf) {
      const Slab slab = voxels_of(tree).saved_slab(0, parent, slot);
      leaf->slab_normal = slab.normal;
      leaf->offset = slab.offset;
      leaf->half = slab.half;
      const double length = slab.normal.norm();
      if (length > 0) leaf->point += slab.offset / length * (slab.normal / length);
    }
  }
  return leaves;
}

PlainPair PlainContacts::at(const LeafPair& pair, const Eigen::Isometry3d& pose) const {
  const Leaf &a = fixed_[pair.fixed], &b = moving_[pair.moving];
  const Vector3d between = pose * b.centre - a.centre;
  const double reach = a.radius + b.radius + reach_;
  double share = std::min(1.0, (reach * reach - between.squaredNorm()) / (farthest_ * farthest_));
  if (slabs_) {
    const Vector3d turned = pose.linear() * b.slab_normal;
    const double into_a =
        a.half + b.radius + reach_ - std::abs(a.slab_normal.dot(between) - a.offset);
    const double into_b = b.half + a.radius + reach_ - std::abs(turned.dot(-between) - b.offset);
    share *= std::clamp(std::min(into_a, into_b) / (size_ / 2), 0.0, 1.0);
  }
  const Vector3d mean = (a.normal - pose.linear() * b.normal) / 2;
  PlainPair result{pair, 0, 0, mean.norm(), Vector3d::Zero(), Vector3d::Zero()};
  if (!(mean.norm() > 0)) return result;
  const Vector3d point = pose * b.point;
  result.normal = mean.normalized();
  result.depth = std::clamp(result.normal.dot(a.point - point), least_, size_);
  result.position = (a.point + point) / 2;
  const double fade = fade_ > 0 ? std::min(1.0, (result.depth - least_) / fade_) : 1;
  result.weight = area_ * std::max(0.0, share) * mean.norm() * fade;
  return result;
}

std::vector<PlainPair> PlainContacts::of(std::span<const LeafPair> pairs,
                                         const Eigen::Isometry3d& pose) const {
  std::vector<PlainPair> found;
  for (const LeafPair& pair : pairs) {
    const PlainPair with = at(pair, pose);
    if (with.weight > 0) found.push_back(with);
  }
  return found;
}

std::vector<PlainPair> PlainContacts::all(const Eigen::Isometry3d& pose) const {
  std::vector<LeafPair> pairs;
  for (std::uint32_t f = 0; f < fixed_.size(); ++f) {
    for (std::uint32_t m = 0; m < moving_.size(); ++m) pairs.push_back({f, m});
  }
  return of(pairs, pose);
}

ContactSums PlainContacts::sums(const std::vector<PlainPair>& pairs) const {
  ContactSums sums;
  sums.about = about_;
  for (const PlainPair& pair : pairs) {
    const Vector3d force = pair.weight * pair.normal, arm = pair.position - about_;
    const double stretched = pair.depth - least_;
    ++sums.pairs;
    sums.weight += pair.weight;
    sums.pressure.force += force;
    sums.pressure.torque += arm.cross(force);
    sums.spring.force += stretched * force;
    sums.spring.torque += stretched * arm.cross(force);
  }
  return sums;
}

std::map<std::uint32_t, Contact> plain_points(const std::vector<PlainPair>& pairs) {
  std::map<std::uint32_t, Contact> points;
  for (const PlainPair& pair : pairs) {
    Contact& point =
        points.try_emplace(pair.leaves.fixed, Contact{Vector3d::Zero(), Vector3d::Zero(), 0, 0})
            .first->second;
    point.position += pair.weight * pair.position;
    point.normal += pair.weight * pair.normal;
    point.depth += pair.weight * pair.depth;
    point.weight += pair.weight;
  }
  for (auto& [leaf, point] : points) {
    point.position /= point.weight;
    point.normal.normalize();
    point.depth /= point.weight;
  }
  return points;
}

}  // namespace ist::test
