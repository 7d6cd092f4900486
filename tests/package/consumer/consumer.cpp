// A program of someone else's: what it asks for has an answer that it counts by itself. Prints what
// it found, the same for everyone.
#include <ist/ist.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../layout.h"

namespace {

constexpr int kCells = 6;  // along an edge of the box

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "consumer: %s\n", what);
  std::exit(1);
}

ist::SphereTree box(bool exact) {
  const Eigen::Vector3d size = Eigen::Vector3d::Constant(kCells);
  return ist::build_tree(ist::make_box(Eigen::Vector3d::Zero(), size),
                         {.voxel_size = 1, .keep_triangles = exact});
}

// Counts the voxels of two such boxes, the second one moved by whole voxels along x, whose
// circumspheres overlap: their centres are no farther apart than √3. Only voxels of the surface
// count.
int overlapping(int shift) {
  std::vector<Eigen::Vector3i> cells;
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const Eigen::Vector3i cell(i % kCells, i / kCells % kCells, i / (kCells * kCells));
    if (cell.minCoeff() == 0 || cell.maxCoeff() == kCells - 1) cells.push_back(cell);
  }
  int count = 0;
  for (const Eigen::Vector3i& a : cells) {
    for (const Eigen::Vector3i& b : cells) {
      count += (a - b - Eigen::Vector3i(shift, 0, 0)).squaredNorm() <= 3 ? 1 : 0;
    }
  }
  return count;
}

void count_leaf_pairs(const ist::SphereTree& fixed, const ist::SphereTree& moving) {
  ist::Query fast(fixed, moving, {.policy = ist::SpherePolicy::kSimple});
  ist::ReferenceQuery published(fixed, moving, ist::SpherePolicy::kSimple);
  std::vector<ist::LeafPair> pairs(10'000), others(10'000);
  for (const int shift : {0, 3, kCells, kCells + 1, kCells + 2}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = shift;
    const auto expected = static_cast<std::uint64_t>(overlapping(shift));
    const ist::QueryResult result = fast.leaf_pairs(pose, pairs);
    require(result.complete && result.leaf_pairs == expected, "the fast query has another count");
    require(published.leaf_pairs(pose, others).leaf_pairs == expected,
            "the published query has another");
    require(std::equal(pairs.begin(), pairs.begin() + static_cast<long>(expected), others.begin()),
            "the two queries name other leaf pairs");
    std::printf("shift %d: %ju leaf pairs, %ju tests, %a apart at most\n", shift,
                std::uintmax_t{result.leaf_pairs}, std::uintmax_t{result.sphere_tests},
                result.resolution);
  }
  require(fast.leaf_pairs(Eigen::Isometry3d::Identity(), pairs, {.tests = 100}).sphere_tests <= 100,
          "the budget is exceeded");
}

// A push along x, and a distance that is known.
void ask_more(const ist::SphereTree& fixed, const ist::SphereTree& moving) {
  std::vector<ist::Query> queries;  // a query moves
  queries.emplace_back(fixed, moving);
  ist::Query& query = queries.front();
  ist::ContactManifold manifold(fixed, moving, query.policy(), {.points = 8});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = kCells - 0.25;
  require(query.contacts(pose, manifold).leaf_pairs > 0, "no contacts");
  const ist::Wrench wrench = manifold.wrench(2.0);
  require(wrench.force.x() > 0 && !manifold.points().empty(), "the push is not outward");
  require(query.intersects(pose).answer == ist::Answer::kYes,
          "boxes that overlap do not intersect");
  for (const double number : wrench.force) std::printf("%a ", number);
  pose.translation().x() = kCells + 2.5;
  const ist::DistanceResult found = query.distance(pose, 1e-3);
  require(found.complete && found.distance.lower <= 2.5 && 2.5 <= found.distance.upper,
          "the distance is not in its interval");
  require(query.intersects(pose).answer == ist::Answer::kNo, "boxes that are apart intersect");
  std::printf("\ndistance %a to %a, target %s\n", found.distance.lower, found.distance.upper,
              query.target());
}

// An error that the library throws is caught by its type and its code.
void catch_error() {
  try {
    static_cast<void>(ist::read_tree("no/such/file.ist"));
  } catch (const ist::Error& error) {
    require(error.code() == ist::ErrorCode::kFileUnreadable, "another error");
    std::printf("caught %s\n", ist::to_string(error.code()));
    return;
  }
  require(false, "no error was thrown");
}

}  // namespace

int main(int argc, char** argv) {
  require(argc == 2, "usage: consumer FILE, a tree to write and read");
  const ist::SphereTree made = box(true);
  const std::uint64_t bytes = ist::write_tree(made, argv[1]);
  const ist::SphereTree read = ist::read_tree(argv[1]);
  std::printf("a tree of %u leaves, %ju bytes\n", read.leaf_count(), std::uintmax_t{bytes});
  count_leaf_pairs(made, read);
  ask_more(read, made);
  catch_error();
}
