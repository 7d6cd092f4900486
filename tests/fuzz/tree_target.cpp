// A tree file: as it is, and once more with its size and its checksum put right, without which
// nothing behind them would ever be looked at. What the second one came to is the outcome.

#include "fuzz/fuzz_target.h"
#include "fuzz/measure_checks.h"
#include "fuzz/query_checks.h"
#include "ist/base/error.h"
#include "support/tree_file.h"

namespace ist::test {
namespace {

Eigen::Isometry3d turn_and_shift(double by) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix().topLeftCorner<3, 3>() << 0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6;
  pose.matrix().topRightCorner<3, 1>().setConstant(by);
  return pose;
}

// A tree without voxels answers questions about triangles.
void check_triangles(const SphereTree& tree) {
  Query query(tree, tree);
  MeasureChecks measures(tree, tree, QueryChecks::Trees::kRead);
  for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d::Identity(), turn_and_shift(0),
                                        turn_and_shift(0.7 * tree.bounding_radius())}) {
    require(query.intersects(pose).status == QueryStatus::kDone, "a rigid pose is none");
    require(query.distance(pose, 0).status == QueryStatus::kDone, "a rigid pose has no distance");
    require(query.leaf_pairs(pose, {}).status == QueryStatus::kNoVoxels,
            "leaf pairs of no voxels were searched");
    measures.at(pose);
  }
}

std::string outcome(const std::string& bytes) {
  std::optional<SphereTree> tree;
  try {
    tree.emplace(tree_of_bytes(bytes));
  } catch (const Error& error) {
    return to_string(error.code());
  }
  require(file_of(*tree) == bytes, "a tree is not saved as it was read");
  if (!tree->has_voxels()) {
    check_triangles(*tree);
    return "fine";
  }
  QueryChecks checks(*tree, *tree, QueryChecks::Trees::kRead);
  std::optional<MeasureChecks> measures;
  if (tree->triangles() != nullptr) measures.emplace(*tree, *tree, QueryChecks::Trees::kRead);
  const double s = tree->voxel_size();
  for (const Eigen::Isometry3d& pose :
       {Eigen::Isometry3d::Identity(), turn_and_shift(0), turn_and_shift(0.7 * s)}) {
    require(checks.at(pose).has_value(), "a rigid pose is none");
    if (measures) measures->at(pose);
  }
  return "fine";
}

}  // namespace

std::string fuzz_tree(std::string_view bytes) {
  std::string file(bytes);
  const std::string as_it_is = outcome(file);
  if (file.size() < TreeFile::kBody) return as_it_is;
  seal(file);
  return outcome(file);
}

}  // namespace ist::test
