// Bodies from files: meshes whose outside is not known, and trees, with their triangles or without.

#include <gtest/gtest.h>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "ist/tree/sphere_tree.h"
#include "loop/haptics/effects/springs_effect.h"
#include "scene/scene_case.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

constexpr std::string_view kBall = "shape = \"sphere\"\nradius = 5\nvoxel_size = 0.5\n";

class SceneBodies : public SceneCase {
 protected:
  // The sound scene, started 2 above the box and pressed to 1 below its face, with the ball from a
  // file.
  [[nodiscard]] static std::string with_ball(std::string_view ball) {
    const std::string near =
        replaced(replaced(kSoundScene, "move = [0, 0, 0]", "move = [0, 0, 12]"),
                 "move = [0, 0, -4]", "move = [0, 0, 9]");
    return replaced(near, kBall, ball);
  }
  // Writes the ball's tree.
  void write_ball(const char* name, bool triangles, SpherePolicy spheres) const {
    BuildOptions options;
    options.voxel_size = 0.5;
    options.spheres = spheres;
    options.keep_triangles = triangles;
    write_tree(build_tree(icosphere(5, 5), options), dir_.path() / name);
  }
  void write_open_ball() const {
    TriangleMesh mesh = icosphere(4, 5);
    mesh.triangles.pop_back();
    write_stl(mesh, dir_.path() / "open.stl");
  }
  // The largest force up that the hand feels as it presses, N.
  [[nodiscard]] static double pressed_by(const BuiltScene& scene) {
    double most = 0;
    for (int i = 0; i < 1200; ++i) {
      const Tick tick = scene.simulation->tick(scene.device->read(), {});
      scene.device->write(tick.wrench, scene.simulation->dt());
      most = std::max(most, tick.wrench[2]);
    }
    return most;
  }
};

TEST_F(SceneBodies, WhoseOutsideIsNotKnownPushNothingAndSaySo) {
  write_open_ball();
  const std::string text =
      with_ball("file = \"open.stl\"\nvoxel_size = 0.5\n") + "[effects.gravity]\nmass = 0.05\n";
  const BuiltScene scene = built(text);
  EXPECT_TRUE(warns(scene, "no contact is felt: repair it, or say trust_normals = true in [held]"));
  EXPECT_FALSE(warns(scene, "in [fixed]"));
  ASSERT_EQ(scene.simulation->effects().size(), 1u);
  EXPECT_EQ(scene.simulation->effects()[0].name, "gravity");
  EXPECT_EQ(scene.simulation->bytes(), 0u);
  EXPECT_FALSE(note_of(scene, "held tree").built);

  // An effect of the caller's is left out by the same rule.
  std::vector<std::unique_ptr<Effect>> own;
  own.push_back(std::make_unique<SpringsEffect>(SpringsSettings{}));
  const BuiltScene with_own = build_scene(scene_of(text), std::move(own));
  EXPECT_EQ(with_own.simulation->effects().size(), 1u);
  EXPECT_EQ(pressed_by(scene), 0);  // nothing holds its weight but the hand

  const BuiltScene silent = built(replaced(text, "[effects.springs]\nstiffness = 20000\n", ""));
  EXPECT_FALSE(warns(silent, "pushes nothing"));
}

TEST_F(SceneBodies, WhoseNormalsAreTrustedPush) {
  write_open_ball();
  const BuiltScene scene =
      built(with_ball("file = \"open.stl\"\nvoxel_size = 0.5\ntrust_normals = true\n"));
  EXPECT_FALSE(warns(scene, "pushes nothing"));
  EXPECT_GT(pressed_by(scene), 0.3);
}

TEST_F(SceneBodies, FromATreeAreThoseOfTheMesh) {
  write_ball("exact.ist", true, SpherePolicy::kSlab);
  write_ball("plain.ist", false, SpherePolicy::kSlab);
  const double of_mesh = pressed_by(built(with_ball(kBall)));
  EXPECT_GT(of_mesh, 0.3);
  for (const char* file : {"exact.ist", "plain.ist"}) {
    const BuiltScene scene = built(with_ball("file = \"" + std::string(file) + "\"\n"));
    // Without triangles the tool's origin is the centre of the grid.
    EXPECT_NEAR(pressed_by(scene), of_mesh, file == std::string("exact.ist") ? 0 : 0.05) << file;
    EXPECT_EQ(scene.step_limit, 0.5e-3);
  }
}

TEST_F(SceneBodies, WithoutTrianglesCannotTellWhatIsInside) {
  write_ball("exact.ist", true, SpherePolicy::kTable);
  write_ball("plain.ist", false, SpherePolicy::kTable);
  const auto inside = [](std::string_view file) {
    return replaced(replaced(replaced(kSoundScene, kBall, "file = \"" + std::string(file) + "\"\n"),
                             "size = [40, 40, 10]", "size = [40, 40, 40]"),
                    "move = [0, 0, -4]", "move = [0, 0, 1]");
  };
  const std::optional<Error> error =
      error_of([&] { static_cast<void>(built(inside("exact.ist"))); });
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("one body is inside the other"), std::string::npos);
  EXPECT_TRUE(warns(built(inside("plain.ist")), "build it without --no-triangles"));
}

TEST_F(SceneBodies, ProximityNeedsTheTrianglesOfATree) {
  write_ball("exact.ist", true, SpherePolicy::kTable);
  write_ball("plain.ist", false, SpherePolicy::kTable);
  const std::string proximity = "[effects.proximity]\ndistance = 1\n";
  const std::optional<Error> error =
      error_of([&] { static_cast<void>(built(with_ball("file = \"plain.ist\"\n") + proximity)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  for (const char* part :
       {"scene.toml:17: proximity needs triangles", "plain.ist", "--no-triangles"}) {
    EXPECT_NE(std::string(error->what()).find(part), std::string::npos) << error->what();
  }
  const BuiltScene scene = built(with_ball("file = \"exact.ist\"\n") + proximity);
  ASSERT_TRUE(scene.trees.back().coarse);
  EXPECT_EQ(scene.trees.back().coarse->voxel_size(), 0.5);
}

// By whatever spheres are named, if the tree has them; by the tightest of both where none are.
TEST_F(SceneBodies, AnswerByTheSpheresThatAreNamed) {
  write_ball("slab.ist", false, SpherePolicy::kSlab);
  write_ball("table.ist", false, SpherePolicy::kTable);
  const auto tests = [&](std::string_view ball, std::string_view more = "") {
    const BuiltScene scene =
        built(replaced(with_ball(ball), "[held]", std::string(more) + "[held]"));
    return scene.simulation->tick(scene.device->read(), {}).contacts->sphere_tests;
  };
  const std::uint64_t slab = tests("file = \"slab.ist\"\n"),
                      table = tests("file = \"table.ist\"\n");
  EXPECT_LT(slab, table);
  EXPECT_EQ(tests("file = \"slab.ist\"\nspheres = \"table\"\n"), table);
  EXPECT_EQ(tests("file = \"slab.ist\"\nspheres = \"slab\"\n"), slab);
  EXPECT_EQ(tests(std::string(kBall) + "spheres = \"table\"\n"), table);
  EXPECT_EQ(tests("file = \"slab.ist\"\n", "spheres = \"table\"\n"), table);
  const std::optional<Error> error =
      error_of([&] { static_cast<void>(tests("file = \"table.ist\"\nspheres = \"tight\"\n")); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  for (const char* part :
       {"scene.toml:9: spheres = \"tight\" in [held]", "table.ist", "--spheres tight"}) {
    EXPECT_NE(std::string(error->what()).find(part), std::string::npos) << error->what();
  }
}

// Which shows only when the lattice is laid, or filled: of a contact tree by its voxel size, of
// proximity voxels by the distance that they come from.
TEST_F(SceneBodies, VoxelsTooSmallAreRefusedByTheLineThatNamesThem) {
  const std::string sound = with_ball(kBall), proximity = "[effects.proximity]\ndistance = ";
  struct Case {
    std::string text, what, remedy;
    std::uint64_t max_memory = BuildOptions{}.max_memory;
  };
  for (const Case& each :
       {Case{replaced(sound, "voxel_size = 0.5", "voxel_size = 1e-5"),
             "scene.toml:10: the held shape: voxel size 1e-05", "the smallest size for this mesh"},
        Case{sound,
             "scene.toml:6: the fixed shape: voxel size 1 needs more than the allowed 100000 bytes",
             "use a voxel size of", 100'000},
        Case{sound + proximity + "1e-5\n",
             "scene.toml:20: proximity voxels have half that size: the fixed shape",
             "the smallest size for this mesh"},
        Case{replaced(sound, "[effects.springs]\nstiffness = 20000\n", proximity + "0.2\n"),
             "scene.toml:18: the fixed shape: voxel size 0.1 needs", "use a voxel size of",
             1'000'000}}) {
    SCOPED_TRACE(each.what);
    const std::optional<Error> error =
        error_of([&] { static_cast<void>(build_scene(scene_of(each.text), {}, each.max_memory)); });
    ASSERT_TRUE(error) << "it is built";
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    for (const std::string& part : {each.what, each.remedy}) {
      EXPECT_NE(std::string(error->what()).find(part), std::string::npos) << error->what();
    }
  }
}

TEST_F(SceneBodies, CouplingBeyondTheBorderIsClampedAndSaid) {
  const auto coupling = [&](std::string_view key) {
    return built(with_ball(kBall) + "[coupling]\n" + std::string(key) + "\n");
  };
  EXPECT_TRUE(coupling("stiffness = 500").warnings.empty());
  EXPECT_TRUE(warns(coupling("stiffness = 100000"), "coupling.stiffness of 1e+05 N/m is too near"));
  EXPECT_TRUE(warns(coupling("damping = 100"), "coupling.damping of 100 N s/m"));
  EXPECT_TRUE(warns(coupling("angular_stiffness = 1000"), "coupling.angular_stiffness of 1000"));
  EXPECT_TRUE(warns(coupling("angular_damping = 10"), "coupling.angular_damping of 10 N m s/rad"));
}

}  // namespace
}  // namespace ist::test
