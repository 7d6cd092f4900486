#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <cfenv>
#include <chrono>
#include <cstring>
#include <optional>
#include <sstream>

#include "ist/base/pose.h"
#include "ist/mesh/mesh.h"
#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/voxelizer.h"
#include "query/scenes.h"
#include "support/shapes.h"
#include "support/stability.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
// Flags, of which one is up or none: so is seen who clears them, and who raises them.
constexpr unsigned kFlags = 0x3F, kInexactSeen = 0x20;
// That the processor traps what is invalid, divided by zero, too large or too small.
constexpr unsigned kTraps = 0x80 | 0x200 | 0x400 | 0x800;

// The caller's arithmetic while it lives, of SSE and, as to rounding, of the x87 too.
class HostArithmetic {
 public:
  HostArithmetic(int rounding, unsigned bits, unsigned traps = 0) : saved_(_mm_getcsr()) {
    std::fesetround(rounding);
    _mm_setcsr((_mm_getcsr() & ~(traps | kFlags)) | bits | (traps != 0 ? kInexactSeen : 0));
    set_ = _mm_getcsr();
  }
  ~HostArithmetic() {
    std::fesetround(FE_TONEAREST);
    _mm_setcsr(saved_);
  }
  HostArithmetic(const HostArithmetic&) = delete;
  HostArithmetic& operator=(const HostArithmetic&) = delete;
  // What `work` gives; counts where it leaves another arithmetic behind.
  template <class Work>
  decltype(auto) keeps(const Work& work) {
    struct Look {
      ~Look() { host.changed += _mm_getcsr() != host.set_ ? 1 : 0; }
      HostArithmetic& host;
    } look{*this};
    _mm_setcsr(set_);  // what was done since may have raised flags
    return work();
  }
  int changed = 0;

 private:
  unsigned saved_, set_;
};

// Bytes of all that is said, compared as they are.
class Record {
 public:
  template <class Number>
  void add(const Number& number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void add(const Eigen::Vector3d& vector) {
    for (const double x : vector) add(x);
  }
  void add(const DistanceInterval& gap) {
    add(gap.lower);
    add(gap.upper);
  }
  template <class Pair>
  void pairs(const std::vector<Pair>& all) {
    for (const auto& [fixed, moving] : all) {
      add(fixed);
      add(moving);
    }
  }
  void add(const FoundPairs& answer) {
    pairs(answer.leaf_pairs);
    add(answer.result.sphere_tests);
    add(answer.result.pad);
  }
  void bytes(const std::string& some) { bytes_ += some; }
  [[nodiscard]] const std::string& all() const { return bytes_; }

 private:
  std::string bytes_;
};

// Two bodies with coordinates of every size, denormal ones too; `unit` makes them so small that
// squares of lengths are nearly denormal floats.
struct Meshes {
  explicit Meshes(double unit) : a(icosphere(2, unit)), b(icosphere(1, 0.8 * unit)) {
    for (TriangleMesh* mesh : {&a, &b}) {
      mesh->vertices[0] += Eigen::Vector3d(1e-310, -3e-320, 0);
      *mesh = joined(*mesh, triangle({1e-310, 0, 0}, {0, 0.7 * unit, 1e-312}, {0, 0, 0.3 * unit}));
    }
  }
  TriangleMesh a, b;
};

SphereTree built(const TriangleMesh& mesh, double voxel_size) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.keep_triangles = true;
  options.proximity = true;
  return build_tree(mesh, options);
}

// Builds, saves, reads and asks everything in the caller's arithmetic `host`; `unit` is a power of
// two, so that nothing here is rounded.
std::string all_of_it(const Meshes& meshes, double unit, const std::filesystem::path& folder,
                      HostArithmetic& host) {
  Record record;
  const auto made = [&](const TriangleMesh& mesh, const char* name) {
    const SphereTree tree = host.keeps([&] { return built(mesh, 0.11 * unit); });
    const std::filesystem::path file = folder / name;
    host.keeps([&] { return write_tree(tree, file); });
    record.bytes(file_content(file));
    return host.keeps([&] { return read_tree(file); });
  };
  const SphereTree fixed = made(meshes.a, "a.ist"), moving = made(meshes.b, "b.ist");
  const std::filesystem::path stl = folder / "a.stl", text = folder / "text.obj";
  host.keeps([&] { write_stl(meshes.a, stl); });
  record.bytes(file_content(stl));
  for (const std::filesystem::path& file : {stl, text}) {
    const TriangleMesh read = host.keeps([&] { return read_mesh(file); });
    for (const Eigen::Vector3d& vertex : read.vertices) record.add(vertex);
  }

  record.add(host.keeps([&] { return check_mesh(meshes.a); }).signed_volume);
  TriangleMesh turned = meshes.a;
  record.add(host.keeps([&] { return orient_outward(turned); }).turned_components);
  for (const LevelStatistics& level : host.keeps([&] { return level_statistics(fixed); })) {
    for (const LevelSpheres& spheres : level.spheres) record.add(spheres.volume);
  }

  // The parts of a build, each for itself.
  VoxelizerOptions options;
  options.voxel_size = 0.1 * unit;
  options.keep_triangles = true;
  const VoxelSet voxels = host.keeps([&] { return voxelize(meshes.a, options); });
  const LinearOctree octree(voxels.codes, voxels.lattice.depth);
  const BoundBlocks bounds =
      host.keeps([&] { return build_bounds(SpherePolicy::kTight, meshes.a, voxels, octree); });
  for (const std::uint64_t code : voxels.codes) record.add(code);
  for (const BallBlock& block : bounds.balls.front()) {
    for (const std::uint16_t radius : block.r) record.add(radius);
  }
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.matrix()(0, 1) = 0x1.23456789abcdep-20;
  const Eigen::Isometry3d projected = host.keeps([&] { return project_to_rigid(bent); }).value();
  for (Eigen::Index i = 0; i < 3; ++i) record.add(Eigen::Vector3d(projected.linear().col(i)));

  // Numbers of few bits that the caller's arithmetic cannot change.
  Eigen::Matrix3d rotation;
  rotation << 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6;
  const InsideTest inside(meshes.a, meshes.b);
  for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
    for (const int workers : {1, 2}) {
      auto query = host.keeps(
          [&] { return std::make_unique<Query>(fixed, moving, options_of(policy, "", workers)); });
      auto reference = host.keeps([&] {
        return std::make_unique<ReferenceQuery>(fixed, moving, policy, SphereSource::kSaved);
      });
      auto points =
          host.keeps([&] { return std::make_unique<ContactManifold>(fixed, moving, policy); });
      record.add(points->rates().spring_torque);
      for (const double distance : {1.5, 2.5, 0.0}) {
        const Eigen::Isometry3d pose =
            pose_of(rotation, {distance * unit, 1e-310, 0.25 * distance * unit});
        const FoundPairs answer = host.keeps([&] { return ask(*query, pose); });
        record.add(answer);
        record.add(answer.result.resolution);
        record.add(host.keeps([&] { return ask(*reference, pose); }));
        record.add(host.keeps([&] { return query->distance(pose, 0); }).distance);
        record.add(*host.keeps([&] {
                          return query->leaf_pairs(pose, std::span<LeafPair>(),
                                                   Budget{.tests = 200});
                        })
                        .distance);
        std::vector<TrianglePair> pairs(1 << 12);
        pairs.resize(host.keeps([&] { return query->triangle_pairs(pose, pairs); }).triangle_pairs);
        record.pairs(pairs);
        record.add(host.keeps([&] { return query->intersects(pose).answer; }));
        record.add(host.keeps([&] { return inside.at(pose); }));
        static_cast<void>(host.keeps([&] { return query->contacts(pose, *points); }));
        for (const Contact& point : points->points()) {
          record.add(point.position);
          record.add(point.normal);
          record.add(point.depth);
          record.add(point.weight);
        }
        record.add(points->sums().spring.torque);
        record.add(points->sums().pressure.force);
      }
    }
  }
  return record.all();
}

TEST(FloatEnvironment, OfTheCallerChangesNothingAndIsKept) {
  StabilityCase wrong("arithmetic", "any rounding, FTZ and DAZ of the caller",
                      "answers that differ");
  StabilityCase kept("arithmetic", "the caller's MXCSR afterwards", "calls that changed it");
  const TempDir folder;
  folder.write("text.obj", "v 0.1 0.2 0.3\nv 1.7 2e-3 -0.7\nv 3.1415926535 -1.1 0.123\nf 1 2 3\n");
  for (const double unit : {1.0, 0x1p-37}) {
    const Meshes meshes(unit);
    std::string expected;
    for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      for (const unsigned bits :
           {0U, kFlushToZero, kDenormalsAreZero, kFlushToZero | kDenormalsAreZero}) {
        std::string found;
        int changed = 0;
        {
          HostArithmetic host(rounding, bits, bits == 0 ? 0 : kTraps);
          found = all_of_it(meshes, unit, folder.path(), host);
          changed = host.changed;
        }
        if (expected.empty()) expected = found;
        std::ostringstream where;
        where << "unit " << unit << ", rounding " << rounding << ", bits " << std::hex << bits;
        wrong.sample(found == expected ? 0 : 1, 0, where.str());
        kept.sample(changed, 0, where.str());
      }
    }
    EXPECT_GT(expected.size(), 100'000u);
  }
}

// Much work, so that the second worker has its part of it: it computes as IEEE 754 has it too.
TEST(FloatEnvironment, OfTheSecondWorkerIsNotTheCallers) {
  StabilityCase wrong("arithmetic", "the second worker's rounding, FTZ and DAZ",
                      "answers that differ");
  const Scene& scene = shells();
  Query serial(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab));
  const FoundPairs expected = ask(serial, scene.pose);
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    FoundPairs answer = expected;
    std::optional<Query> query;
    {
      HostArithmetic host(rounding,
                          kFlushToZero | kDenormalsAreZero);  // and the worker comes in it
      query.emplace(scene.fixed, scene.moving, options_of(SpherePolicy::kSlab, "", 2));
    }
    const std::uint64_t enough = query->sharing().chunks + 4;
    using Clock = std::chrono::steady_clock;
    for (const auto give_up = Clock::now() + std::chrono::minutes(2);
         query->sharing().chunks < enough && Clock::now() < give_up;) {
      {
        HostArithmetic host(rounding, kFlushToZero | kDenormalsAreZero);
        answer.result = query->leaf_pairs(scene.pose, answer.leaf_pairs);
      }
      wrong.sample(same(answer, expected) ? 0 : 1, 0);
    }
    EXPECT_GE(query->sharing().chunks, enough);
  }
}

}  // namespace
}  // namespace ist::test
