#include <gtest/gtest.h>

#include <array>
#include <string>

#include "ist/capi/ist_c.h"
#include "ist/measure.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "ist/query/world/world.h"
#include "ist/scene.h"
#include "ist/tree/sphere_tree.h"
#include "loop/scene/ranges.h"
#include "loop/scene/spelling.h"
#include "scene/scene_case.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/german_locale.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/zip_file.h"

namespace ist::test {
namespace {

// A host program may set a locale whose decimal mark is a comma: numbers are read all the same, and
// said so.

class Locale : public GermanLocale {
 protected:
  // The text of the error that `action` throws.
  template <class Action>
  static void expect_same_error(const Action& action) {
    expect_same([&] {
      const std::optional<Error> error = error_of(action);
      return error ? std::string(error->what()) : "no error";
    });
  }
};

TEST_F(Locale, MeshesAreReadAlikeInEveryFormat) {
  // Made before and after: what makes the texts may depend on the locale as well.
  set_classic();
  const TriangleMesh mesh = narrowed(icosphere(1, 1.25));
  auto formats = all_formats(mesh);
  formats.emplace_back("3MF", as_3mf(threemf_model(mesh)));
  set_german();
  ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  ASSERT_GT(formats.size(), 8u);
  for (const auto& [name, bytes] : formats) {
    const TriangleMesh read = read_mesh(folder_.write(name, bytes));
    EXPECT_EQ(corners(read), corners(mesh)) << name;
  }
}

TEST_F(Locale, ScenesAreReadAlike) {
  const Scene scene = read_scene(folder_.write("scene.toml", kSoundScene));
  EXPECT_EQ(scene.held.front().voxel_size, 0.5);
  const std::string finer = replaced(kSoundScene, "voxel_size = 1\n", "voxel_size = 1.25e-1\n");
  EXPECT_EQ(read_scene(folder_.write("finer.toml", finer)).fixed.front().voxel_size, 0.125);
}

TEST_F(Locale, PlansAreReadAlike) {
  const std::vector<Waypoint> plan = read_script(
      folder_.write("plan.csv",
                    "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.5,0.125,-2.5,1e-3,1,0,0,0\n"),
      2);
  ASSERT_EQ(plan.size(), 2u);
  EXPECT_EQ(plan.back().time, 0.5);
  EXPECT_EQ(plan.back().pose.translation, Eigen::Vector3d(0.25, -5, 2e-3));
}

TEST_F(Locale, PlansAreRefusedAlike) {
  for (const char* line : {"0,5;1;2;3;1;0;0;0", "0,0.1,0.2.5,0.3,1,0,0,0", "-0.5,0,0,0,1,0,0,0"}) {
    const auto file =
        folder_.write("plan.csv", std::string("time,x,y,z,qw,qx,qy,qz\n") + line + "\n");
    const auto read = [&] { static_cast<void>(read_script(file, 1)); };
    set_classic();
    const std::string expected = error_of(read).value().what();
    set_german();
    EXPECT_EQ(error_of(read).value().what(), expected);
  }
}

// Sizes that are too small for the lattice or the memory, and the remedies in the errors.
TEST_F(Locale, TreesAreRefusedAlike) {
  const TriangleMesh mesh = icosphere(2, 1.25);
  for (const double voxel_size : {1.25e-7, 1.5e9, -0.5}) {
    expect_same_error([&] { static_cast<void>(build_tree(mesh, {.voxel_size = voxel_size})); });
  }
  expect_same_error(
      [&] { static_cast<void>(build_tree(mesh, {.voxel_size = 0.0125, .max_memory = 100'000})); });
  expect_same_error(
      [] { static_cast<void>(build_tree(icosphere(1, 1.25e17), {.voxel_size = 1e15})); });
}

TEST_F(Locale, ScenesAreRefusedAlike) {
  for (const auto& [part, by] :
       {std::pair("stiffness = 2000", "stiffness = -0.25"),
        std::pair("rate = 1000", "rate = 0.125"), std::pair("time = 1,", "time = -1.5,")}) {
    const auto file = folder_.write("scene.toml", replaced(kSoundScene, part, by));
    expect_same_error([&] { static_cast<void>(read_scene(file)); });
  }
}

// The ball begins in the box, and the contact is too stiff for the device.
TEST_F(Locale, ScenesWarnAlike) {
  const auto file = folder_.write(
      "scene.toml", replaced(replaced(replaced(kSoundScene, "[0, 0, 0] }", "[0, 0, 9] }"),
                                      "[device]\n", "open = \"z\"\n[device]\n"),
                             "stiffness = 2000", "stiffness = 90000"));
  expect_same([&] {
    std::string all;
    for (const std::string& warning : build_scene(read_scene(file)).warnings) all += warning + "\n";
    return all;
  });
}

TEST_F(Locale, MeasuresAndWorldsAreRefusedAlike) {
  IST_SLOW();
  const SphereTree tree = build_tree(icosphere(1, 1), {.voxel_size = 0.2, .keep_triangles = true});
  Query query(tree, tree);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  expect_same_error([&] { static_cast<void>(penetration(query, pose, -0.25)); });
  expect_same_error([&] { static_cast<void>(signed_distance(tree, {}, -0.25)); });
  const std::array<Eigen::Vector3d, 1> far = {Eigen::Vector3d(0.5, 1.25e300, 0)};
  expect_same_error([&] { static_cast<void>(signed_distance(tree, far, 1)); });
  expect_same_error([] { static_cast<void>(World({.reach = -0.25})); });
  expect_same_error([&] {
    World world({.max_memory = 1'234'567});
    static_cast<void>(world.add(tree));
    static_cast<void>(world.add(tree));
    world.reserve();
  });
  expect_same_error([] { static_cast<void>(make_splint(3, 0.25)); });
}

TEST_F(Locale, CallsInCAreRefusedAlike) {
  expect_same([] {
    const std::array<double, 16> pose{};
    ist_distance_result result{};
    result.struct_size = sizeof result;
    EXPECT_EQ(ist_query_distance(nullptr, pose.data(), -0.25, nullptr, &result),
              IST_ARGUMENT_INVALID);
    return std::string(ist_last_error_message());
  });
}

TEST(Spelling, CountsEdits) {
  EXPECT_EQ(edits("", ""), 0u);
  EXPECT_EQ(edits("mass", "mass"), 0u);
  EXPECT_EQ(edits("", "mass"), 4u);
  EXPECT_EQ(edits("mas", "mass"), 1u);
  EXPECT_EQ(edits("masss", "mass"), 1u);
  EXPECT_EQ(edits("mess", "mass"), 1u);
  EXPECT_EQ(edits("amss", "mass"), 1u);
  EXPECT_EQ(edits("kitten", "sitting"), 3u);
  EXPECT_EQ(edits("damping", "stiffness"), edits("stiffness", "damping"));
}

TEST(Spelling, KnowsWhatIsMisspeltFromWhatIsAnotherWord) {
  EXPECT_TRUE(looks_like("untis", "units"));
  EXPECT_TRUE(looks_like("voxelsize", "voxel_size"));
  EXPECT_TRUE(looks_like("qaternoin", "quaternion"));
  EXPECT_FALSE(looks_like("rate", "unit"));
  EXPECT_FALSE(looks_like("damping", "stiffness"));
  EXPECT_FALSE(looks_like(std::string(1000, 'x'), "mass"));
}

TEST(Units, AreKnownByTheirNamesAndNoOthers) {
  EXPECT_EQ(metres_in("m"), 1.0);
  EXPECT_EQ(metres_in("cm"), 1e-2);
  EXPECT_EQ(metres_in("mm"), 1e-3);
  EXPECT_EQ(metres_in("um"), 1e-6);
  EXPECT_EQ(metres_in("inch"), 0.0254);
  for (const char* other : {"", "MM", "millimetre", "mm ", "ft", "in"}) {
    EXPECT_FALSE(metres_in(other)) << other;
  }
}

}  // namespace
}  // namespace ist::test
