// A program of someone else's: what it asks for has an answer that it counts by itself. Prints what
// it found, the same for everyone.
#include <ist/base/error.h>
#include <ist/mesh/shape_model.h>
#include <ist/query/collision_query.h>
#include <ist/query/reference.h>
#include <ist/tree/tree_builder.h>
#include <ist/tree/tree_io.h>

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
  ist::BuildOptions options;
  options.voxel_size = 1;
  options.keep_triangles = exact;
  const Eigen::Vector3d size = Eigen::Vector3d::Constant(kCells);
  return ist::build_tree(ist::make_box(Eigen::Vector3d::Zero(), size), options);
}

// Voxels of two such boxes, the second one moved by whole voxels along x, whose circumspheres
// touch: centres no farther apart than √3. The voxels of a box are those of its surface.
int touching(int shift) {
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

void count_contacts(const ist::SphereTree& fixed, const ist::SphereTree& moving) {
  ist::CollisionQuery fast(fixed, moving, {.policy = ist::SpherePolicy::kSimple, .target = {}});
  ist::ReferenceQuery published(fixed, moving, ist::SpherePolicy::kSimple);
  std::vector<ist::Contact> contacts(10'000), others(10'000);
  for (const int shift : {0, 3, kCells, kCells + 1, kCells + 2}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = shift;
    const auto expected = static_cast<std::uint64_t>(touching(shift));
    const ist::QueryResult result = fast.collide(pose, contacts);
    require(result.complete && result.contacts == expected, "the fast query has another count");
    require(published.collide(pose, others).contacts == expected,
            "the published query has another");
    require(std::equal(contacts.begin(), contacts.begin() + static_cast<long>(expected),
                       others.begin()),
            "the two queries name other contacts");
    std::printf("shift %d: %ju contacts, %ju tests\n", shift, std::uintmax_t{result.contacts},
                std::uintmax_t{result.sphere_tests});
  }
}

// A push along x, and a gap that is known.
void ask_more(const ist::SphereTree& fixed, const ist::SphereTree& moving) {
  ist::CollisionQuery query(fixed, moving);
  ist::ContactPoints points(fixed, moving, query.policy());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = kCells - 0.25;
  require(query.contact_points(pose, points).contacts > 0, "no contact points");
  require(points.sums().spring.force.x() > 0, "the push is not outward");
  for (const double number : points.sums().spring.force) std::printf("%a ", number);
  pose.translation().x() = kCells + 2.5;
  const ist::GapInterval gap = query.gap(pose, 1e-3).gap;
  require(gap.lower <= 2.5 && 2.5 <= gap.upper, "the gap is not in its interval");
  std::printf("\ngap %a to %a, target %s\n", gap.lower, gap.upper, query.target());
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
  std::printf("a tree of %u leaves, %ju bytes\n", read.octree().leaf_count(),
              std::uintmax_t{bytes});
  count_contacts(made, read);
  ask_more(read, made);
  catch_error();
}
