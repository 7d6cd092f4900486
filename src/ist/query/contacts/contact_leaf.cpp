#include "ist/query/contacts/contact_leaf.h"

namespace ist {

ContactLeaf read_leaf(const SphereTree& tree, SpherePolicy policy, std::uint32_t leaf,
                      std::uint32_t parent) noexcept {
  const NodeBound bound = read_bound(tree, policy, 0, leaf, parent);
  ContactLeaf result{bound, bound.centre, Eigen::Vector3d::Zero()};
  const double length2 = dot_in_order(bound.normal, bound.normal);
  if (length2 > 0) add_to(result.point, scaled(bound.offset / length2, bound.normal));
  const PackedNormal normal = tree.normals()[leaf];
  result.normal = scaled(normal.coherence(), normal.direction());
  return result;
}

}  // namespace ist
