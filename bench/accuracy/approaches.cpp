#include "accuracy/approaches.h"

#include <stdexcept>

#include "ist/query/query.h"
#include "query/query_cases.h"
#include "support/bodies.h"
#include "support/effort.h"

namespace ist::bench {
namespace {

Query& exact_query() {
  constexpr double kVoxelSize = 0.4;  // the size of triangles, at which exact answers are fastest
  static Query query(triangle_trees(kVoxelSize).first, triangle_trees(kVoxelSize).second);
  return query;
}

// Small turns need no sine: a quaternion of any length will do.
Eigen::Matrix3d small_turn(test::Random& random) {
  const Eigen::Vector3d half = random.point(-kHalfTurn, kHalfTurn);
  return Eigen::Quaterniond(1, half[0], half[1], half[2]).normalized().toRotationMatrix();
}

Eigen::Vector3d centre(const TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& v : mesh.vertices) sum += v;
  return sum / static_cast<double>(mesh.vertices.size());
}

std::vector<Approach> make_approaches() {
  std::vector<Approach> ways;
  test::Random random(7);
  const Eigen::Vector3d about = centre(lower_jaw());
  const int count = quick() ? 3 : 12;
  for (int tries = 0; static_cast<int>(ways.size()) < count; ++tries) {
    if (tries == 10 * count) throw std::runtime_error("the jaws do not come up to each other");
    Approach way;
    const Eigen::Matrix3d turn = small_turn(random);
    way.direction =
        Eigen::Vector3d(random.uniform(-kBeside, kBeside), random.uniform(-kBeside, kBeside), 1)
            .normalized();
    way.turned = Eigen::Isometry3d::Identity();
    way.turned.linear() = turn;
    // At t = kWayBegin it would be where it is stored.
    way.turned.translation() = about - turn * about - kWayBegin * way.direction;
    if (exact_gap(way.pose(0)) < kApart) continue;
    way.pair = first_touch(0, 2 * kWayBegin, kStep, 1e-6,
                           [&](double t) { return exact_touch(way.pose(t)); });
    if (way.pair < 0) continue;  // it passed by
    ways.push_back(way);
  }
  return ways;
}

}  // namespace

double exact_gap(const Eigen::Isometry3d& pose) {
  const DistanceInterval gap = exact_query().distance(pose, 1e-6).distance;
  return gap.lower + (gap.upper - gap.lower) / 2;
}

bool exact_touch(const Eigen::Isometry3d& pose) {
  return exact_query().intersects(pose).answer == ist::Answer::kYes;
}

std::span<const Approach> approaches() {
  static const std::vector<Approach> made = make_approaches();
  return made;
}

}  // namespace ist::bench
