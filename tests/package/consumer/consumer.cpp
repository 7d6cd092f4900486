// A program of someone else's: what it asks for has an answer that it counts by itself. Prints what
// it found, the same for everyone.
#include <ist/haptics.h>
#include <ist/ist.h>
#include <ist/measure.h>
#include <ist/models/models.h>
#include <ist/query/reference/reference_query.h>
#include <ist/scene.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
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

// The depth of one box in the other, and the way until they meet.
void measure(const ist::SphereTree& fixed, const ist::SphereTree& moving) {
  ist::Query query(fixed, moving);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = kCells - 0.25;
  const ist::Penetration found = ist::penetration(query, pose, 1e-3);
  require(found.complete && found.lower <= 0.25 && 0.25 <= found.upper,
          "the depth is not in its interval");
  pose.translation().x() = kCells + 2;
  const ist::Motion motion = ist::Motion::between(pose, Eigen::Isometry3d::Identity());
  const ist::FirstContact first = ist::first_contact(query, motion, 1e-3);
  require(first.status == ist::FirstContact::Status::kContact, "boxes pass through each other");
  const Eigen::Isometry3d there = motion.at(first.upper);
  require(there.translation().x() <= kCells && kCells - 0.01 <= there.translation().x(),
          "boxes meet elsewhere");
  const std::optional<Eigen::Isometry3d> back = ist::compose_rigid(there.inverse(), there);
  require(back && (back->matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-12,
          "a motion and its inverse leave a motion");
  ist::World world;
  world.add(fixed);
  world.add(moving, pose);
  require(world.pose_of(0, 1)->matrix() == pose.matrix(), "a world has another pose");
  std::printf("depth %a to %a, contact at %a\n", found.lower, found.upper, first.upper);
}

// A ball above a box, for a hand that lowers it.
ist::BuiltScene scene() {
  using Shape = ist::BuiltInShape;
  ist::Scene scene{.unit = 1e-3};
  scene.fixed[0].source = Shape{.kind = Shape::Kind::kBox, .size = {kCells, kCells, kCells}};
  scene.held[0].source = Shape{.kind = Shape::Kind::kSphere, .radius = 2};
  scene.held[0].translation.z() = kCells / 2 + 2.5;
  for (ist::SceneBody* body : {&scene.fixed[0], &scene.held[0]}) body->voxel_size = 0.5;
  scene.device = ist::NullSettings{{.damping = 2, .angular_damping = 2e-3}};
  scene.springs = ist::SpringsSettings{};
  return ist::build_scene(scene);
}

// The ball is pressed on the box. A recording of its ticks gives the same forces once more.
void press() {
  constexpr std::size_t kTicks = 100;
  const ist::BuiltScene built = scene();
  ist::TickRing<ist::TickRecord> ring(kTicks);
  ist::Placement hand = *built.device->read();
  for (std::uint64_t tick = 0; tick < kTicks; ++tick) {
    hand.translation.z() -= 1e-5;
    const ist::Tick made = built.simulation->tick(hand);
    require(!made.fault && ring.push(ist::record_of(tick, built.simulation->dt(), made, true)),
            "a tick failed");
  }
  std::vector<ist::TickRecord> records(kTicks);
  require(ring.pop(records) == kTicks, "the ring has lost records");
  require(records.front().wrench[2] < 0.01 && records.back().wrench[2] > 0.1,
          "the box does not push the ball away");
  const ist::BuiltScene again = scene();
  for (const ist::TickRecord& record : records) {
    const ist::TickRecord made = ist::replay(
        {.tick = record.tick, .device = ist::to_placement(record.device)}, *again.simulation);
    require(made.wrench == record.wrench && made.tool == record.tool,
            "the recording gives other forces");
  }
  const Eigen::Isometry3d tool = again.simulation->tool_pose().isometry();
  std::printf("force %a N, tool at %a m\n", records.back().wrench[2], tool.translation().z());
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
  measure(made, read);
  press();
  catch_error();
}
