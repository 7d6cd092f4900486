#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "ist/base/pose.h"
#include "ist/mesh/mesh.h"
#include "ist/query/inside.h"
#include "ist/query/query.h"
#include "ist/query/reference/reference_query.h"
#include "ist/query/workers/shared_work.h"
#include "ist/tree/bound_builder.h"
#include "ist/tree/saved_spheres.h"
#include "ist/tree/sphere_tree.h"
#include "ist/voxel/voxelizer.h"
#include "query/scenes.h"
#include "stability/float_environment_case.h"
#include "support/effort.h"

namespace ist::test {
namespace {

INSTANTIATE_TEST_SUITE_P(Units, FloatEnvironmentOfTheCaller, ::testing::Values(1.0, 0x1p-37),
                         [](const auto& unit) { return unit.param == 1 ? "one" : "tiny"; });

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoTreeThatIsBuilt) {
  changes_nothing("build_tree", 10'000, [&](Record& record) {
    for (const TriangleMesh& mesh : {meshes_.a, meshes_.b}) record.add(bytes_of(tree(mesh)));
  });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoTreeFile) {
  const SphereTree written = tree(meshes_.a);
  const std::filesystem::path file = folder_.path() / "tree.ist";
  changes_nothing("write_tree", 10'000, [&](Record& record) {
    write_tree(written, file);
    record.add(file_content(file));
  });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoTreeThatIsRead) {
  const std::filesystem::path file = folder_.path() / "tree.ist";
  write_tree(tree(meshes_.a), file);
  changes_nothing("read_tree", 10'000,
                  [&](Record& record) { record.add(bytes_of(read_tree(file))); });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoStlFile) {
  const std::filesystem::path file = folder_.path() / "mesh.stl";
  changes_nothing("write_stl", 10'000, [&](Record& record) {
    write_stl(meshes_.a, file);
    record.add(file_content(file));
  });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoMeshThatIsRead) {
  const std::filesystem::path stl = folder_.path() / "mesh.stl";
  write_stl(meshes_.a, stl);
  const std::filesystem::path text = folder_.write(
      "text.obj", "v 0.1 0.2 0.3\nv 1.7 2e-3 -0.7\nv 3.1415926535 -1.1 0.123\nf 1 2 3\n");
  changes_nothing("read_mesh of an STL", 1000,
                  [&](Record& record) { record.add(read_mesh(stl).vertices); });
  changes_nothing("read_mesh of text", 72,
                  [&](Record& record) { record.add(read_mesh(text).vertices); });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoMeshCheck) {
  changes_nothing("check_mesh", 8,
                  [&](Record& record) { record.add(check_mesh(meshes_.a).signed_volume); });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoOrientation) {
  changes_nothing("orient_outward", 1, [&](Record& record) {
    TriangleMesh turned = meshes_.a;
    record.add(orient_outward(turned).turned_components);
  });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoLevelStatistics) {
  const SphereTree of = tree(meshes_.a);
  changes_nothing("level_statistics", 100, [&](Record& record) {
    for (const LevelStatistics& level : level_statistics(of)) {
      for (const LevelSpheres& spheres : level.spheres) record.add(spheres.volume);
    }
  });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoVoxel) {
  const VoxelizerOptions options{.voxel_size = 0.1 * unit_, .keep_triangles = true};
  changes_nothing("voxelize", 5000,
                  [&](Record& record) { record.add(voxelize(meshes_.a, options).codes); });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoBound) {
  changes_nothing("BoundBuilder", 1000, [&](Record& record) {
    BoundBuilder builder(SpherePolicy::kTight);
    const VoxelSet voxels = voxelize(meshes_.a, {.voxel_size = 0.1 * unit_, .visitor = &builder});
    const BoundBlocks bounds = builder.finish(LinearOctree(voxels.codes, voxels.lattice.depth));
    for (const BallBlock& block : bounds.balls.front()) {
      for (const std::uint16_t radius : block.r) record.add(radius);
    }
  });
}

TEST_P(FloatEnvironmentOfTheCaller, ChangesNoProjectedPose) {
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.matrix()(0, 1) = 0x1.23456789abcdep-20;
  changes_nothing("project_to_rigid", 72, [&](Record& record) {
    const Eigen::Isometry3d projected = project_to_rigid(bent).value();
    for (Eigen::Index i = 0; i < 3; ++i) record.add(Eigen::Vector3d(projected.linear().col(i)));
  });
}

// The same, of queries at poses where the bodies cross, are near and are in each other; made and
// asked in the caller's arithmetic.
class FloatEnvironmentOfAQuery : public FloatEnvironmentOfTheCaller {
 protected:
  // `call` takes a query, a pose and the record.
  template <class Call>
  void changes_no_answer(const std::string& name, std::size_t least, const Call& call) const {
    changes_nothing(name, least, [&](Record& record) {
      for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
        for (const int workers : {1, 2}) {
          Query query(fixed_, moving_, options_of(policy, "", workers));
          for (const Eigen::Isometry3d& pose : poses_) call(query, pose, record);
        }
      }
    });
  }
  // Numbers that are exact in any arithmetic.
  [[nodiscard]] Eigen::Isometry3d pose(double distance) const {
    Eigen::Matrix3d rotation;
    rotation << 1, 0, 0, 0, 0.6, -0.8, 0, 0.8, 0.6;
    return pose_of(rotation, {distance * unit_, 1e-310, 0.25 * distance * unit_});
  }

  const SphereTree fixed_ = tree(meshes_.a), moving_ = tree(meshes_.b);
  const std::vector<Eigen::Isometry3d> poses_{pose(1.5), pose(2.5), pose(0)};
};

INSTANTIATE_TEST_SUITE_P(Units, FloatEnvironmentOfAQuery, ::testing::Values(1.0, 0x1p-37),
                         [](const auto& unit) { return unit.param == 1 ? "one" : "tiny"; });

TEST_P(FloatEnvironmentOfAQuery, ChangesNoLeafPair) {
  changes_no_answer("Query::leaf_pairs", 1000, [](Query& query, const auto& pose, Record& record) {
    record.add(ask(query, pose));
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoPublishedLeafPair) {
  changes_nothing("ReferenceQuery::leaf_pairs", 1000, [&](Record& record) {
    for (const SpherePolicy policy : {SpherePolicy::kTable, SpherePolicy::kSlab}) {
      ReferenceQuery reference(fixed_, moving_, policy, SphereSource::kSaved);
      for (const Eigen::Isometry3d& pose : poses_) record.add(ask(reference, pose));
    }
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoDistance) {
  changes_no_answer("Query::distance", 192, [](Query& query, const auto& pose, Record& record) {
    record.add(query.distance(pose, 0).distance);
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoIntervalOfACutSearch) {
  changes_no_answer("Query::leaf_pairs within a budget", 192,
                    [](Query& query, const auto& pose, Record& record) {
                      const Budget budget{.tests = 200};
                      record.add(*query.leaf_pairs(pose, std::span<LeafPair>(), budget).distance);
                    });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoTrianglePair) {
  changes_no_answer("Query::triangle_pairs", 500,
                    [](Query& query, const auto& pose, Record& record) {
                      std::vector<TrianglePair> pairs(1 << 12);
                      pairs.resize(query.triangle_pairs(pose, pairs).triangle_pairs);
                      record.add(pairs);
                    });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoNearPair) {
  changes_no_answer("Query::near_pairs", 500, [](Query& query, const auto& pose, Record& record) {
    std::vector<NearPair> pairs(1 << 12);
    pairs.resize(query.near_pairs(pose, 0.05, pairs).near_pairs);
    for (const NearPair& pair : pairs) {
      record.add(pair.triangles);
      record.add(pair.distance);
      record.add(pair.fixed_point);
      record.add(pair.moving_point);
      record.add(pair.direction());
    }
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoIntersection) {
  changes_no_answer("Query::intersects", 12, [](Query& query, const auto& pose, Record& record) {
    record.add(query.intersects(pose).answer);
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoInsideTest) {
  changes_nothing("InsideTest::at", 3, [&](Record& record) {
    const InsideTest inside(meshes_.a, meshes_.b);
    for (const Eigen::Isometry3d& pose : poses_) record.add(inside.at(pose));
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoInside) {
  changes_no_answer("Query::inside", 3, [](Query& query, const auto& pose, Record& record) {
    record.add(query.inside(pose).inside);
  });
}

TEST_P(FloatEnvironmentOfAQuery, ChangesNoContact) {
  changes_no_answer("Query::contacts", 1000, [&](Query& query, const auto& pose, Record& record) {
    ContactManifold manifold(fixed_, moving_, query.policy(), {.margin = 2});
    static_cast<void>(query.contacts(pose, manifold));
    record.add(manifold.rates().spring_torque);
    for (const Contact& contact : manifold.points()) record.add(contact);
    record.add(manifold.sums().spring.torque);
    record.add(manifold.sums().pressure.force);
    record.add(manifold.wrench(0.3).torque);
  });
}

// Much work, so that the second worker has its part of it: it computes as IEEE 754 has it too.
TEST(FloatEnvironmentOfTheSecondWorker, IsNotTheCallers) {
  IST_SLOW();
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
    const std::uint64_t enough = sharing_of(*query).chunks + 4;
    while (sharing_of(*query).chunks < enough) {
      {
        HostArithmetic host(rounding, kFlushToZero | kDenormalsAreZero);
        answer.result = query->leaf_pairs(scene.pose, answer.leaf_pairs);
      }
      wrong.sample(same(answer, expected) ? 0 : 1, 0);
    }
  }
}

}  // namespace
}  // namespace ist::test
