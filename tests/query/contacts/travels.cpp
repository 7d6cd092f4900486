#include "query/contacts/travels.h"

#include <cmath>

#include "support/shapes.h"

namespace ist::test {

using Eigen::Vector3d;

std::vector<TravelBodies> all_bodies() {
  const TriangleMesh ball = icosphere(3, 2), block = box({-2, -2, -1}, {2, 2, 1}),
                     cube = box({-1, -1, -1}, {1, 1, 1});
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ(),
                 slope = Vector3d(3, -1, 2) / std::sqrt(14.0);
  const Vector3d none = Vector3d::Zero();
  Random random(11);
  const Eigen::Matrix3d turn = random.rotation();
  std::vector<TravelBodies> bodies;
  // A ball of voxels of 0.5 mm; from apart through the first contact, on, along a face and turning.
  bodies.push_back({"balls", tree_of(ball, 8), tree_of(ball, 8), {}});
  bodies.back().ways = {{"first contact", pose_of(turn, {0.3, 0.2, 4.6}), -z, none, 9000},
                        {"sliding", pose_of(turn, {0.3, 0.2, 3.7}), x, none, 6000},
                        {"turning", pose_of(turn, {0.3, 0.2, 3.7}), none, slope, 3000}};
  bodies.push_back({"boxes", tree_of(block, 8), tree_of(cube, 4), {}});
  bodies.back().ways = {// Faces in the grid's planes, and across them.
                        {"first contact", shift({0.3, 0.2, 2.9}), -z, none, 12000},
                        {"along a face", shift({0.3, 0.2, 2.0}), x, none, 8000},
                        {"tilting", shift({0.3, 0.2, 1.9}), none, x, 3000},
                        {"sloping", shift({1.3, 1.2, 2.4}), -slope, slope, 6000}};
  bodies.push_back({"coarse in fine", tree_of(ball, 10), tree_of(cube, 2), {}});
  bodies.back().ways = {{"first contact", pose_of(turn, {0.3, 0.2, 3.9}), -z, none, 8000},
                        {"turning", pose_of(turn, {0.3, 0.2, 3.0}), none, slope, 3000}};
  bodies.push_back({"fine in coarse", tree_of(cube, 2), tree_of(ball, 10), {}});
  bodies.back().ways = {{"first contact", pose_of(turn, {0.3, 0.2, 3.9}), -z, none, 8000}};
  return bodies;
}

}  // namespace ist::test
