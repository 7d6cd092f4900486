#include "support/exact_query.h"

#include <algorithm>
#include <string>

#include "ist/base/pose.h"
#include "ist/tree/saved_spheres.h"
#include "ist/voxel/morton.h"

namespace ist::test {
namespace {

// The points x with normal · x <= offset.
struct HalfSpace {
  ExactPoint normal;
  mpq_class offset;
};

ExactPoint exact(double x, double y, double z) {
  return {mpq_class(x), mpq_class(y), mpq_class(z)};
}

ExactPoint minus(const ExactPoint& a, const ExactPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

ExactPoint negative(const ExactPoint& a) { return {-a[0], -a[1], -a[2]}; }

mpq_class dot(const ExactPoint& a, const ExactPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

ExactPoint cross(const ExactPoint& a, const ExactPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const ExactPoint& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

ExactPoint unit(std::size_t axis) {
  ExactPoint direction;
  direction[axis] = 1;
  return direction;
}

Eigen::Vector3d rounded(const ExactPoint& a) { return {a[0].get_d(), a[1].get_d(), a[2].get_d()}; }

// Sutherland and Hodgman's clipping. In rational numbers it is exact, and holds for segments and
// points as well.
ExactPolygon cut(const ExactPolygon& polygon, const HalfSpace& half) {
  std::vector<mpq_class> beyond;
  for (const ExactPoint& p : polygon) beyond.emplace_back(dot(half.normal, p) - half.offset);
  ExactPolygon kept;
  for (std::size_t to = 0; to < polygon.size(); ++to) {
    const std::size_t from = (to == 0 ? polygon.size() : to) - 1;
    if (sgn(beyond[from]) * sgn(beyond[to]) < 0) {
      const mpq_class part = beyond[from] / (beyond[from] - beyond[to]);
      ExactPoint& crossing = kept.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        crossing[i] = polygon[from][i] + part * (polygon[to][i] - polygon[from][i]);
      }
    }
    if (sgn(beyond[to]) <= 0) kept.push_back(polygon[to]);
  }
  return kept;
}

void add_equal(std::vector<HalfSpace>& halves, const ExactPoint& normal, const ExactPoint& at) {
  const mpq_class offset = dot(normal, at);
  halves.push_back({normal, offset});
  halves.push_back({negative(normal), -offset});
}

// A polygon as the intersection of half spaces.
std::vector<HalfSpace> half_spaces(const ExactPolygon& polygon) {
  std::vector<HalfSpace> halves;
  const ExactPoint& first = polygon.front();
  ExactPoint normal, along;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const ExactPoint side = minus(polygon[i], first);
    if (is_zero(along)) along = side;
    const ExactPoint area = cross(minus(polygon[i - 1], first), side);
    for (std::size_t k = 0; k < 3; ++k) normal[k] += area[k];
  }
  if (!is_zero(normal)) {
    add_equal(halves, normal, first);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const ExactPoint& p = polygon[i];
      const ExactPoint outward = cross(minus(polygon[(i + 1) % polygon.size()], p), normal);
      halves.push_back({outward, dot(outward, p)});
    }
    return halves;
  }
  if (is_zero(along)) {
    for (std::size_t axis = 0; axis < 3; ++axis) add_equal(halves, unit(axis), first);
    return halves;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) add_equal(halves, cross(along, unit(axis)), first);
  mpq_class low = dot(along, first), high = low;
  for (const ExactPoint& p : polygon) {
    low = std::min<mpq_class>(low, dot(along, p));
    high = std::max<mpq_class>(high, dot(along, p));
  }
  halves.push_back({along, high});
  halves.push_back({negative(along), -low});
  return halves;
}

}  // namespace

bool polygons_meet(const ExactPolygon& a, const ExactPolygon& b) {
  if (a.empty() || b.empty()) return false;
  ExactPolygon left = a;
  for (const HalfSpace& half : half_spaces(b)) {
    left = cut(left, half);
    if (left.empty()) return false;
  }
  return true;
}

ExactPolygon clipped(ExactPolygon polygon, const ExactPoint& low, const ExactPoint& high) {
  for (std::size_t axis = 0; axis < 3 && !polygon.empty(); ++axis) {
    polygon = cut(polygon, {unit(axis), high[axis]});
    polygon = cut(polygon, {negative(unit(axis)), -low[axis]});
  }
  return polygon;
}

ExactBody::ExactBody(const TriangleMesh& mesh, const SphereTree& tree)
    : tree_(tree), voxel_size_(tree.lattice().voxel_size) {
  const Lattice& lattice = tree.lattice();
  const mpq_class root_centre(lattice.root_centre());
  for (std::size_t i = 0; i < 3; ++i) {
    origin_[i] = mpq_class(lattice.corner[i]) + root_centre * voxel_size_;
  }
  for (const std::uint64_t code : tree.octree().codes(0)) {
    const Cell cell = morton_decode(code);
    Leaf& leaf = leaves_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      leaf.cube_centre[i] = (mpq_class(cell[i] + 0.5) - root_centre) * voxel_size_;
    }
    leaf.rounded_centre = rounded(leaf.cube_centre);
  }
  if (!tree.has(SpherePolicy::kTight)) return;
  const double reach = 0.5 * lattice.voxel_size + 1e-9 * lattice.edge(lattice.depth);
  for (const Triangle& t : mesh.triangles) {
    ExactPolygon triangle;
    Eigen::AlignedBox3d box;
    for (const std::uint32_t v : t) {
      const Eigen::Vector3d& vertex = mesh.vertices[v];
      triangle.push_back(minus(exact(vertex[0], vertex[1], vertex[2]), origin_));
      box.extend(rounded(triangle.back()));
    }
    for (Leaf& leaf : leaves_) {
      const Eigen::Vector3d& c = leaf.rounded_centre;
      if (((box.min() - c).array() > reach).any() || ((c - box.max()).array() > reach).any()) {
        continue;
      }
      ExactPoint low, high;
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = leaf.cube_centre[i] - voxel_size_ / 2;
        high[i] = leaf.cube_centre[i] + voxel_size_ / 2;
      }
      Polygon polygon{clipped(triangle, low, high), {}};
      if (polygon.corners.empty()) continue;
      for (const ExactPoint& p : polygon.corners) polygon.rounded.push_back(rounded(p));
      leaf.polygons.push_back(std::move(polygon));
    }
  }
}

ExactPair::ExactPair(const ExactBody& fixed, const ExactBody& moving, const Eigen::Isometry3d& pose)
    : fixed_(fixed), moving_(moving) {
  const Eigen::Isometry3d rigid = project_to_rigid(pose).value();
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
  margin_ = 1e-12 * (fixed.tree_.reach() + moving.tree_.reach() +
                     rounded_translation_.cwiseAbs().maxCoeff());

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
  const double edges = fixed_.tree_.lattice().voxel_size + moving_.tree_.lattice().voxel_size;
  const double distance =
      (fixed_.leaves_[fixed_leaf].rounded_centre - moved_centres_[moving_leaf]).norm();
  if (distance > 0.8661 * edges + margin_) return false;  // circumspheres
  if (distance < 0.4999 * edges - margin_) return true;   // inscribed spheres
  const ExactPoint apart = minus(fixed_.leaves_[fixed_leaf].cube_centre,
                                 in_fixed_frame(moving_.leaves_[moving_leaf].cube_centre));
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
  const double edges = fixed_.tree_.lattice().voxel_size + moving_.tree_.lattice().voxel_size;
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
    const double edges = fixed_.tree_.lattice().voxel_size + moving_.tree_.lattice().voxel_size;
    const double apart =
        (a.rounded_centre - moved_centres_[moving_leaf]).norm() - (0.5 * kSqrt3 * edges + pad);
    if (apart > margin_ || apart < -margin_) return apart < 0;
    // d <= √3/2 e + pad, by squares: d² - 3/4 e² - pad² <= √3 e pad.
    const ExactPoint between = minus(a.cube_centre, in_fixed_frame(b.cube_centre));
    const mpq_class e = fixed_.voxel_size_ + moving_.voxel_size_, p(pad);
    const mpq_class left = dot(between, between) - mpq_class(3, 4) * e * e - p * p;
    const mpq_class left2 = left * left, right2 = 3 * e * e * p * p;
    return sgn(p) >= 0 ? sgn(left) <= 0 || left2 <= right2 : sgn(left) <= 0 && left2 >= right2;
  }
  const Sphere& s = fixed_.tree_.tight(0)[fixed_leaf];
  const Sphere& t = moving_.tree_.tight(0)[moving_leaf];
  const Eigen::Vector3d moved =
      rounded_rotation_ * Eigen::Vector3d(t.x, t.y, t.z) + rounded_translation_;
  const double reach = double{s.r} + double{t.r} + pad;
  const double apart = (Eigen::Vector3d(s.x, s.y, s.z) - moved).norm() - reach;
  if (apart > margin_ || apart < -margin_) return apart < 0;
  const ExactPoint between = minus(exact(s.x, s.y, s.z), in_fixed_frame(exact(t.x, t.y, t.z)));
  const mpq_class sum = mpq_class(s.r) + mpq_class(t.r) + mpq_class(pad);
  return sgn(sum) >= 0 && dot(between, between) <= sum * sum;
}

::testing::AssertionResult keeps_promise(const ExactPair& pair, SpherePolicy policy,
                                         std::span<const Contact> contacts, double pad) {
  const auto says = [policy](const char* what, std::uint32_t f, std::uint32_t m) {
    return ::testing::AssertionFailure() << to_string(policy) << ": the pair of fixed leaf " << f
                                         << " and moving leaf " << m << " " << what;
  };
  std::size_t next = 0;
  for (std::uint32_t f = 0; f < pair.fixed().leaf_count(); ++f) {
    for (std::uint32_t m = 0; m < pair.moving().leaf_count(); ++m) {
      if (next < contacts.size() && contacts[next] == Contact{f, m}) {
        ++next;
        if (!pair.bounds_meet(policy, f, m, pad)) {
          return says("is in the answer, but its bounds are apart", f, m);
        }
      } else if (pair.geometry_meets(policy, f, m)) {
        return says("is not in the answer at its place, but its geometry meets", f, m);
      }
    }
  }
  if (next < contacts.size()) {
    return says("is in the answer out of order, twice, or without being there",
                contacts[next].fixed, contacts[next].moving);
  }
  return ::testing::AssertionSuccess();
}

}  // namespace ist::test
