#include "support/exact_query.h"

#include <algorithm>
#include <string>

#include "ist/tree/saved_spheres.h"
#include "ist/tree/tree_parts.h"
#include "support/rigid_pose.h"

namespace ist::test {
namespace {

Eigen::Vector3d rounded(const ExactPoint& a) { return {a[0].get_d(), a[1].get_d(), a[2].get_d()}; }

// The codes of the leaves, ascending, from the root down by the occupancy masks alone.
std::vector<std::uint64_t> leaf_codes(const LinearOctree& octree) {
  std::vector<std::uint64_t> codes{0};
  for (int level = octree.depth(); level > 0; --level) {
    std::vector<std::uint64_t> children;
    for (std::uint32_t node = 0; node < codes.size(); ++node) {
      for (unsigned octant = 0; octant < 8; ++octant) {
        if ((octree.mask(level, node) >> octant & 1) != 0) {
          children.push_back(8 * codes[node] + octant);
        }
      }
    }
    codes = std::move(children);
  }
  return codes;
}

}  // namespace

ExactBody::ExactBody(const TriangleMesh& mesh, const SphereTree& tree)
    : tree_(tree), voxel_size_(tree.voxel_size()) {
  const Lattice& lattice = voxels_of(tree).lattice;
  const mpq_class root_centre(lattice.root_centre());
  for (std::size_t i = 0; i < 3; ++i) {
    origin_[i] = mpq_class(lattice.corner[i]) + root_centre * voxel_size_;
  }
  for (const std::uint64_t code : leaf_codes(voxels_of(tree).octree)) {
    const ExactBox cube = node_cube(lattice, 0, code);
    Leaf& leaf = leaves_.emplace_back();
    leaf.cube_centre = mpq_class(1, 2) * (cube.low + cube.high) - origin_;
    leaf.rounded_centre = rounded(leaf.cube_centre);
    farthest_ = std::max(farthest_, leaf.rounded_centre.norm() + lattice.voxel_size);
  }
  if (!tree.has(SpherePolicy::kTight)) return;
  unpack_bounds();
  const double reach = 0.5 * lattice.voxel_size + 1e-9 * lattice.edge(lattice.depth);
  for (const Triangle& t : mesh.triangles) {
    ExactPolygon triangle;
    Eigen::AlignedBox3d box;
    for (const std::uint32_t v : t) {
      const Eigen::Vector3d& vertex = mesh.vertices[v];
      triangle.push_back(exact(vertex) - origin_);
      box.extend(rounded(triangle.back()));
    }
    for (Leaf& leaf : leaves_) {
      const Eigen::Vector3d& c = leaf.rounded_centre;
      if (((box.min() - c).array() > reach).any() || ((c - box.max()).array() > reach).any()) {
        continue;
      }
      const ExactBox cube = grown({leaf.cube_centre, leaf.cube_centre}, voxel_size_ / 2);
      Polygon polygon{clip(triangle, cube), {}};
      if (polygon.corners.empty()) continue;
      for (const ExactPoint& p : polygon.corners) polygon.rounded.push_back(rounded(p));
      leaf.polygons.push_back(std::move(polygon));
    }
  }
}

// From the description of the blocks.
void ExactBody::unpack_bounds() {
  const std::vector<std::uint64_t> codes = leaf_codes(voxels_of(tree_).octree);
  const mpq_class unit = voxel_size_ / 32768, slab_unit = voxel_size_ / 256;
  std::size_t parent = 0;
  int slot = 0;
  for (std::size_t leaf = 0; leaf < codes.size(); ++leaf, ++slot) {
    if (leaf > 0 && codes[leaf] >> 3 != codes[leaf - 1] >> 3) {
      ++parent;
      slot = 0;
    }
    Bound& bound = leaves_[leaf].bound;
    const PackedBall ball = voxels_of(tree_).balls(0)[parent][slot];
    bound.centre = leaves_[leaf].cube_centre;  // of the parent's cube: half an edge away, or none
    for (std::size_t i = 0; i < 3 && tree_.depth() > 0; ++i) {
      bound.centre[i] += ((codes[leaf] >> i & 1) != 0 ? -1 : 1) * voxel_size_ / 2;
    }
    bound.centre =
        bound.centre + unit * ExactPoint{{mpq_class(ball.x), mpq_class(ball.y), mpq_class(ball.z)}};
    bound.radius = ball.r * unit;
    bound.rounded_centre = rounded(bound.centre);
    if (!tree_.has(SpherePolicy::kSlab)) continue;
    const PackedSlab slab = voxels_of(tree_).slabs(0)[parent][slot];
    bound.normal = mpq_class(1, 128) *
                   ExactPoint{{mpq_class(slab.nx), mpq_class(slab.ny), mpq_class(slab.nz)}};
    bound.offset = slab.offset * slab_unit;
    bound.half = slab.half * slab_unit;
  }
}

ExactPair::ExactPair(const ExactBody& fixed, const ExactBody& moving, const Eigen::Isometry3d& pose)
    : fixed_(fixed), moving_(moving) {
  const Eigen::Isometry3d rigid = rigid_pose(pose);
  rounded_rotation_ = rigid.linear();
  std::array<ExactPoint, 3> edges;  // of the moving cubes, by columns
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    translation_[i] = mpq_class(rigid.translation()[row]) - fixed.origin_[i];
    for (std::size_t j = 0; j < 3; ++j) {
      rotation_[i][j] = mpq_class(rounded_rotation_(row, static_cast<Eigen::Index>(j)));
      translation_[i] += rotation_[i][j] * moving.origin_[j];
      edges[j][i] = rotation_[i][j];
    }
  }
  rounded_translation_ = rounded(translation_);
  margin_ =
      1e-12 * (fixed.farthest_ + moving.farthest_ + rounded_translation_.cwiseAbs().maxCoeff());

  std::vector<ExactPoint> directions;
  for (std::size_t i = 0; i < 3; ++i) {
    directions.push_back(unit(i));
    directions.push_back(cross(edges[i], edges[(i + 1) % 3]));
    for (const ExactPoint& edge : edges) directions.push_back(cross(unit(i), edge));
  }
  for (const ExactPoint& direction : directions) {
    Axis& axis = axes_.emplace_back(Axis{direction, 0});
    for (std::size_t i = 0; i < 3; ++i) {
      axis.reach += abs(direction[i]) * fixed.voxel_size_ / 2 +
                    abs(dot(direction, edges[i])) * moving.voxel_size_ / 2;
    }
  }

  const auto move = [this](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return rounded_rotation_ * p + rounded_translation_;
  };
  for (const ExactBody::Leaf& leaf : moving.leaves_) {
    moved_centres_.push_back(move(leaf.rounded_centre));
    auto& polygons = moved_polygons_.emplace_back();
    for (const ExactBody::Polygon& polygon : leaf.polygons) {
      auto& corners = polygons.emplace_back();
      for (const Eigen::Vector3d& p : polygon.rounded) corners.push_back(move(p));
    }
  }
}

ExactPoint ExactPair::in_fixed_frame(const ExactPoint& point) const {
  ExactPoint moved;
  for (std::size_t i = 0; i < 3; ++i) moved[i] = dot(rotation_[i], point) + translation_[i];
  return moved;
}

bool ExactPair::geometry_meets(SpherePolicy policy, std::uint32_t fixed_leaf,
                               std::uint32_t moving_leaf) const {
  return is_implicit(policy) ? cubes_meet(fixed_leaf, moving_leaf)
                             : triangles_meet(fixed_leaf, moving_leaf);
}

bool ExactPair::cubes_meet(std::uint32_t fixed_leaf, std::uint32_t moving_leaf) const {
  const double edges = fixed_.tree_.voxel_size() + moving_.tree_.voxel_size();
  const double distance =
      (fixed_.leaves_[fixed_leaf].rounded_centre - moved_centres_[moving_leaf]).norm();
  if (distance > 0.8661 * edges + margin_) return false;  // circumspheres
  if (distance < 0.4999 * edges - margin_) return true;   // inscribed spheres
  const ExactPoint apart = fixed_.leaves_[fixed_leaf].cube_centre -
                           in_fixed_frame(moving_.leaves_[moving_leaf].cube_centre);
  return std::none_of(axes_.begin(), axes_.end(), [&apart](const Axis& axis) {
    return abs(dot(axis.direction, apart)) > axis.reach;
  });
}

// Whether some plane has the polygons on two sides, clearly.
bool ExactPair::polygons_apart(const ExactBody::Polygon& fixed,
                               std::span<const Eigen::Vector3d> moving) const {
  using Vector = Eigen::Vector3d;
  const std::span<const Vector> a = fixed.rounded, b = moving;
  const auto middle = [](std::span<const Vector> corners) -> Vector {
    Vector sum = Vector::Zero();
    for (const Vector& p : corners) sum += p;
    return sum / static_cast<double>(corners.size());
  };
  const auto normal = [](std::span<const Vector> corners) -> Vector {
    Vector sum = Vector::Zero();
    for (std::size_t i = 2; i < corners.size(); ++i) {
      sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
    }
    return sum;
  };
  for (const Vector& direction : {Vector(middle(b) - middle(a)), normal(a), normal(b),
                                  Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)}) {
    const double length = direction.norm();
    if (!(length > 0)) continue;
    Eigen::AlignedBox<double, 1> on_a, on_b;
    for (const Vector& p : a) on_a.extend(Eigen::Matrix<double, 1, 1>(direction.dot(p) / length));
    for (const Vector& p : b) on_b.extend(Eigen::Matrix<double, 1, 1>(direction.dot(p) / length));
    if (on_b.min()[0] - on_a.max()[0] > margin_ || on_a.min()[0] - on_b.max()[0] > margin_) {
      return true;
    }
  }
  return false;
}

bool ExactPair::triangles_meet(std::uint32_t fixed_leaf, std::uint32_t moving_leaf) const {
  const double edges = fixed_.tree_.voxel_size() + moving_.tree_.voxel_size();
  const double distance =
      (fixed_.leaves_[fixed_leaf].rounded_centre - moved_centres_[moving_leaf]).norm();
  if (distance > 0.8661 * edges + margin_) return false;  // not even the cubes meet
  const auto& polygons = moving_.leaves_[moving_leaf].polygons;
  for (std::size_t m = 0; m < polygons.size(); ++m) {
    ExactPolygon moved;  // made when it is needed
    for (const ExactBody::Polygon& polygon : fixed_.leaves_[fixed_leaf].polygons) {
      if (polygons_apart(polygon, moved_polygons_[moving_leaf][m])) continue;
      if (moved.empty()) {
        for (const ExactPoint& p : polygons[m].corners) moved.push_back(in_fixed_frame(p));
      }
      if (polygons_meet(polygon.corners, moved)) return true;
    }
  }
  return false;
}

bool ExactPair::bounds_meet(SpherePolicy policy, std::uint32_t fixed_leaf,
                            std::uint32_t moving_leaf, double pad) const {
  const ExactBody::Leaf& a = fixed_.leaves_[fixed_leaf];
  const ExactBody::Leaf& b = moving_.leaves_[moving_leaf];
  if (is_implicit(policy)) {
    const double edges = fixed_.tree_.voxel_size() + moving_.tree_.voxel_size();
    const double apart =
        (a.rounded_centre - moved_centres_[moving_leaf]).norm() - (0.5 * kSqrt3 * edges + pad);
    if (apart > margin_ || apart < -margin_) return apart < 0;
    // d <= √3/2 e + pad, by squares: d² - 3/4 e² - pad² <= √3 e pad.
    const ExactPoint between = a.cube_centre - in_fixed_frame(b.cube_centre);
    const mpq_class e = fixed_.voxel_size_ + moving_.voxel_size_, p(pad);
    const mpq_class left = dot(between, between) - mpq_class(3, 4) * e * e - p * p;
    const mpq_class left2 = left * left, right2 = 3 * e * e * p * p;
    return sgn(p) >= 0 ? sgn(left) <= 0 || left2 <= right2 : sgn(left) <= 0 && left2 >= right2;
  }
  const ExactBody::Bound &s = a.bound, &t = b.bound;
  const Eigen::Vector3d apart =
      (rounded_rotation_ * t.rounded_centre + rounded_translation_) - s.rounded_centre;
  const double wide = apart.norm() - (s.radius.get_d() + t.radius.get_d() + pad);
  if (wide > margin_) return false;
  if (wide >= -margin_) {
    const ExactPoint exactly = in_fixed_frame(t.centre) - s.centre;
    const mpq_class sum = s.radius + t.radius + mpq_class(pad);
    if (sgn(sum) < 0 || square(exactly) > sum * sum) return false;
  }
  return policy != SpherePolicy::kSlab || slabs_met(s, t, apart, pad);
}

// Whether each ball comes within `pad` of the other's slab; `apart` is from fixed to moving centre.
bool ExactPair::slabs_met(const ExactBody::Bound& fixed, const ExactBody::Bound& moving,
                          const Eigen::Vector3d& apart, double pad) const {
  const auto beyond = [&](const ExactBody::Bound& slab, const Eigen::Vector3d& normal,
                          const ExactBody::Bound& ball) {
    const double height = normal.dot(apart) - (&slab == &fixed ? 1 : -1) * slab.offset.get_d();
    return std::abs(height) - (slab.half.get_d() + ball.radius.get_d() + pad);
  };
  const double farthest =
      std::max(beyond(fixed, rounded(fixed.normal), moving),
               beyond(moving, rounded_rotation_ * rounded(moving.normal), fixed));
  if (farthest > margin_ || farthest < -margin_) return farthest < 0;
  const ExactPoint exactly = in_fixed_frame(moving.centre) - fixed.centre;
  const ExactPoint turned = in_fixed_frame(moving.normal) - translation_;
  return abs(dot(fixed.normal, exactly) - fixed.offset) <=
             fixed.half + moving.radius + mpq_class(pad) &&
         abs(dot(turned, exactly) + moving.offset) <= moving.half + fixed.radius + mpq_class(pad);
}

bool must_be_found(const ExactPair& pair, SpherePolicy policy, std::uint32_t fixed_leaf,
                   std::uint32_t moving_leaf, bool nested, double margin) {
  return nested ? pair.bounds_meet(policy, fixed_leaf, moving_leaf, margin)
                : pair.geometry_meets(policy, fixed_leaf, moving_leaf);
}

::testing::AssertionResult keeps_guarantee(const ExactPair& pair, SpherePolicy policy,
                                           std::span<const LeafPair> leaf_pairs, double pad,
                                           bool nested, double margin) {
  const auto says = [policy](const char* what, std::uint32_t f, std::uint32_t m) {
    return ::testing::AssertionFailure() << to_string(policy) << ": the pair of fixed leaf " << f
                                         << " and moving leaf " << m << " " << what;
  };
  std::size_t next = 0;
  for (std::uint32_t f = 0; f < pair.fixed().leaf_count(); ++f) {
    for (std::uint32_t m = 0; m < pair.moving().leaf_count(); ++m) {
      if (next < leaf_pairs.size() && leaf_pairs[next] == LeafPair{f, m}) {
        ++next;
        if (!pair.bounds_meet(policy, f, m, pad)) {
          return says("is in the answer, but its bounds are apart", f, m);
        }
      } else if (must_be_found(pair, policy, f, m, nested, margin)) {
        return says("is not in the answer at its place, but must be found", f, m);
      }
    }
  }
  if (next < leaf_pairs.size()) {
    return says("is in the answer out of order, twice, or without being there",
                leaf_pairs[next].fixed, leaf_pairs[next].moving);
  }
  return ::testing::AssertionSuccess();
}

}  // namespace ist::test
