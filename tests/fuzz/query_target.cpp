// A pose for a pair of small trees. Of the first byte, two bits say which pair, the next two by
// which policy, and two more how the rest is read; what is missing of it is 0:
//   'raw'     16 doubles, column-major
//   'turn'    4 doubles, a quaternion of any length, and 3, a translation
//   'lattice' 4 signed bytes, a quaternion, and 3 i16, a translation in 1/256
//   'bent'    the same, then a byte and a double, which one entry of the matrix is changed by

#include <array>
#include <cmath>
#include <cstring>

#include "fuzz/fuzz_target.h"
#include "fuzz/measure_checks.h"
#include "fuzz/query_checks.h"
#include "query/triangles/triangle_tree.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : left_(bytes) {}
  template <typename T>
  T next() {
    T value{};
    const std::size_t got = std::min(sizeof(T), left_.size());
    std::memcpy(&value, left_.data(), got);
    left_.remove_prefix(got);
    return value;
  }

 private:
  std::string_view left_;
};

struct Pair {
  Pair(const TriangleMesh& a, double size_a, const TriangleMesh& b, double size_b)
      : fixed(tree_with_triangles(a, size_a)),
        moving(tree_with_triangles(b, size_b)),
        checks(fixed, moving, QueryChecks::Trees::kBuilt),
        measures(fixed, moving, QueryChecks::Trees::kBuilt) {}
  SphereTree fixed, moving;
  QueryChecks checks;
  MeasureChecks measures;
};

// A ball and a block, a sliver in a block, and a far strip beside a coarse triangle.
Pair& pair(unsigned which) {
  static std::array<Pair, 3> pairs{
      Pair{icosphere(1, 1), 0.5, box({-0.5, -0.75, -1}, {0.5, 0.75, 1}), 0.5},
      Pair{triangle({-1, 0, 0}, {1, 1e-6, 0}, {1, -1e-6, 1e-6}), 0.125, box({0, 0, 0}, {1, 1, 1}),
           0.5},
      Pair{moved(open_strip(2), {1000, 0, -1000}), 0.25,
           triangle({0, 0, 0}, {1, 0, 0}, {0.25, 1, 0.5}), 1}};
  return pairs[which % pairs.size()];
}

Eigen::Isometry3d pose_of(Eigen::Vector4d q, const Eigen::Vector3d& translation) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  q = length > 0 ? Eigen::Vector4d(q / length) : Eigen::Vector4d(0, 0, 0, 1);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix().topLeftCorner<3, 3>() = Eigen::Quaterniond(q).toRotationMatrix();
  pose.matrix().topRightCorner<3, 1>() = translation;
  return pose;
}

Eigen::Isometry3d next_pose(unsigned form, Bytes& bytes) {
  if (form == 0) {
    Eigen::Isometry3d raw;
    for (int i = 0; i < 16; ++i) raw.matrix().data()[i] = bytes.next<double>();
    return raw;
  }
  Eigen::Vector4d q;
  Eigen::Vector3d translation;
  if (form == 1) {
    for (double& x : q) x = bytes.next<double>();
    for (double& x : translation) x = bytes.next<double>();
    return pose_of(q, translation);
  }
  for (double& x : q) x = bytes.next<std::int8_t>();
  for (double& x : translation) x = bytes.next<std::int16_t>() / 256.0;
  Eigen::Isometry3d pose = pose_of(q, translation);
  if (form == 3) {
    const unsigned entry = bytes.next<std::uint8_t>() % 16u;
    pose.matrix().data()[entry] += bytes.next<double>();
  }
  return pose;
}

}  // namespace

std::string fuzz_query(std::string_view text) {
  Bytes bytes(text);
  const unsigned head = bytes.next<std::uint8_t>();
  Pair& asked = pair(head & 3U);
  const Eigen::Isometry3d pose = next_pose(head >> 4 & 3U, bytes);
  const auto intersects = asked.checks.at(pose, head >> 2 & 3U);
  asked.measures.at(pose);
  if (!intersects) return "invalid";
  return *intersects ? "touching" : "apart";
}

}  // namespace ist::test
