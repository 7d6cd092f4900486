#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <string>

#include "ist/models/models.h"
#include "ist/tree/sphere_tree.h"
#include "loop/scene/make_effects.h"
#include "scene/scene_case.h"
#include "support/scoped_variable.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using Vector = Eigen::Vector3d;

// The numbers of settings that hold nothing else, in their order.
template <class Settings>
auto numbers_of(const Settings& settings) {
  return std::bit_cast<std::array<double, sizeof(Settings) / sizeof(double)>>(settings);
}
// Of a hand, without its plan.
std::array<double, 11> numbers_of(const HandSettings& hand) {
  const DeviceMechanics& mechanics = hand.mechanics;
  return {mechanics.damping,
          mechanics.angular_damping,
          mechanics.delay,
          hand.mass,
          hand.inertia,
          hand.arm_stiffness,
          hand.arm_damping,
          hand.arm_angular_stiffness,
          hand.arm_angular_damping,
          hand.resolution,
          hand.angular_resolution};
}
template <class... Number>
std::array<double, sizeof...(Number)> numbers(Number... each) {
  return {static_cast<double>(each)...};
}

class SceneFile : public ::testing::Test {
 protected:
  [[nodiscard]] Scene read(std::string_view text) const {
    return read_scene(folder_.write("scene.toml", text));
  }
  // The sound scene with its device replaced.
  [[nodiscard]] Scene with_device(const std::string& lines) const {
    const std::size_t begin = kSoundScene.find("kind"), end = kSoundScene.find("[effects");
    return read(replaced(kSoundScene, kSoundScene.substr(begin, end - begin), lines));
  }

  TempDir folder_;
};

TEST_F(SceneFile, SaysWhatIsSimulated) {
  const Scene scene = read(kSoundScene);
  EXPECT_EQ(scene.file, folder_.path() / "scene.toml");
  EXPECT_EQ(scene.unit, 1e-3);
  EXPECT_EQ(scene.rate, 1000);
  const auto& fixed = std::get<BuiltInShape>(scene.fixed.front().source);
  EXPECT_EQ(fixed.kind, BuiltInShape::Kind::kBox);
  EXPECT_EQ(fixed.size, Vector(40, 40, 10));
  EXPECT_EQ(scene.fixed.front().voxel_size, 1);
  const auto& held = std::get<BuiltInShape>(scene.held.front().source);
  EXPECT_EQ(held.kind, BuiltInShape::Kind::kSphere);
  EXPECT_EQ(held.radius, 5);
  EXPECT_EQ(scene.held.front().voxel_size, 0.5);
  const auto& hand = std::get<HandSettings>(scene.device);
  ASSERT_EQ(hand.plan.size(), 2u);
  EXPECT_EQ(hand.plan[0].time, 0);
  EXPECT_EQ(hand.plan[1].time, 1);
  EXPECT_EQ(hand.plan[1].pose.translation, Vector(0, 0, 1e-3 * -4));
  EXPECT_EQ(hand.plan[1].pose.rotation, Eigen::Matrix3d::Identity());
  EXPECT_EQ(scene.springs.value().stiffness, 20000);
}

TEST_F(SceneFile, TakesAWholeFloatForAWholeNumber) {
  EXPECT_EQ(read(replaced(kSoundScene, "rate = 1000", "workers = 2.0")).workers, 2);
  EXPECT_EQ(read(replaced(kSoundScene, "rate = 1000", "workers = 2e0")).workers, 2);
}

TEST_F(SceneFile, LeavesOutWhatIsNotNamed) {
  const Scene scene = read(kSoundScene);
  EXPECT_EQ(make_effects(scene, {}, true).size(), 1u);
  EXPECT_FALSE(scene.open);
  EXPECT_FALSE(read(replaced(kSoundScene, kSprings, "")).springs);
}

TEST_F(SceneFile, HasDefaults) {
  const Scene scene = read(replaced(kSoundScene, "rate = 1000", ""));
  EXPECT_EQ(scene.rate, 1000);
  EXPECT_EQ(scene.seconds, 10);
  for (const SceneBody* body : {&scene.fixed.front(), &scene.held.front()}) {
    EXPECT_FALSE(body->spheres);
    EXPECT_FALSE(body->trust_normals);
    EXPECT_EQ(body->rotation, Eigen::Matrix3d::Identity());
    EXPECT_EQ(body->translation, Vector::Zero());
  }
  EXPECT_EQ(numbers_of(scene.coupling), numbers(1000, 0.5, 1, 5e-4, 5, 0.2));
  EXPECT_EQ(numbers_of(scene.safety), numbers(8, 0.3, 500, 20, 0.5));
  EXPECT_EQ(numbers_of(std::get<HandSettings>(scene.device)),
            numbers(2, 2e-3, 0, 0.2, 2e-4, 500, 10, 1, 0.02, 0, 0));
}

TEST_F(SceneFile, HasDefaultsOfEachEffect) {
  const Scene scene = read(replaced(kSoundScene, kLastLine,
                                    "[effects.damping]\n"
                                    "[effects.proximity]\ndistance = 2\n"
                                    "[effects.gravity]\nmass = 0.1\n"
                                    "[effects.snap]\nradius = 3\n"));
  EXPECT_EQ(scene.springs.value().stiffness, 40000);
  EXPECT_EQ(scene.springs->margin, 0);
  EXPECT_EQ(scene.springs->full_area, 0);
  EXPECT_FALSE(scene.springs->allow_breaking);
  EXPECT_EQ(numbers_of(scene.damping.value()), numbers(10));
  EXPECT_EQ(numbers_of(scene.proximity.value()), numbers(1e-3 * 2, 2));
  EXPECT_EQ(scene.gravity.value().mass, 0.1);
  EXPECT_FALSE(scene.gravity->centre);
  EXPECT_EQ(scene.gravity->acceleration, Vector(0, 0, -9.81));
  EXPECT_EQ(scene.snap.value().pose.translation, Vector::Zero());
  EXPECT_EQ(scene.snap->pose.rotation, Eigen::Matrix3d::Identity());
  EXPECT_EQ(scene.snap->stiffness, 200);
  EXPECT_EQ(scene.snap->angular_stiffness, 0.2);
  EXPECT_EQ(scene.snap->radius, 1e-3 * 3);
  EXPECT_EQ(scene.snap->angle, 0.2);
}

TEST_F(SceneFile, HasDefaultsOfContactAndFriction) {
  const Scene scene =
      read(replaced(kSoundScene, kSprings, "[effects.contact]\n[effects.friction]\n"));
  EXPECT_FALSE(scene.springs);
  EXPECT_EQ(scene.contact.value().skin, 0);
  EXPECT_EQ(scene.contact->trust, 0);
  EXPECT_EQ(scene.contact->steps, 3);
  EXPECT_EQ(numbers_of(scene.friction.value()), numbers(0.3));
}

TEST_F(SceneFile, LetsDefaultsFollowWhatIsNamed) {
  const Scene scene = read(with_lines("[safety]\nmax_force = 3\nmax_torque = 0.1\n"));
  EXPECT_EQ(scene.coupling.max_force, 3);
  EXPECT_EQ(scene.coupling.max_torque, 0.1);
}

TEST_F(SceneFile, TakesEveryKeyOfEachEffect) {
  const Scene scene = read(with_lines(R"(margin = 0.25
full_area = 3
allow_breaking = true
[effects.damping]
damping = 3
[effects.proximity]
distance = 1.5
damping = 4
[effects.gravity]
mass = 0.2
centre = [1, 2, 3]
acceleration = [0, -9.8, 0]
[effects.snap]
move = [1, 0, -2]
turn = [1, 1, 0, 0]
stiffness = 150
angular_stiffness = 0.3
radius = 4
angle = 0.5
)"));
  EXPECT_EQ(scene.springs.value().margin, 1e-3 * 0.25);
  EXPECT_EQ(scene.springs->full_area, 1e-3 * 1e-3 * 3);
  EXPECT_TRUE(scene.springs->allow_breaking);
  EXPECT_EQ(numbers_of(scene.damping.value()), numbers(3));
  EXPECT_EQ(numbers_of(scene.proximity.value()), numbers(1e-3 * 1.5, 4));
  EXPECT_EQ(scene.gravity.value().mass, 0.2);
  EXPECT_EQ(scene.gravity->centre.value(), Vector(1, 2, 3)) << "not in mesh units";
  EXPECT_EQ(scene.gravity->acceleration, Vector(0, -9.8, 0));
  EXPECT_EQ(scene.snap.value().pose.translation, Vector(1e-3 * 1, 0, 1e-3 * -2));
  Eigen::Matrix3d quarter;  // about x
  quarter << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_EQ(scene.snap->pose.rotation, quarter);
  EXPECT_EQ(scene.snap->stiffness, 150);
  EXPECT_EQ(scene.snap->angular_stiffness, 0.3);
  EXPECT_EQ(scene.snap->radius, 1e-3 * 4);
  EXPECT_EQ(scene.snap->angle, 0.5);
}

TEST_F(SceneFile, TakesEveryKeyOfContactAndFriction) {
  const Scene scene = read(replaced(kSoundScene, kSprings, R"([effects.contact]
skin = 0.01
trust = 0.02
steps = 10
[effects.friction]
coefficient = 0.5
)"));
  EXPECT_EQ(scene.contact.value().skin, 0.01) << "not in the scene's unit";
  EXPECT_EQ(scene.contact->trust, 0.02);
  EXPECT_EQ(scene.contact->steps, 10);
  EXPECT_EQ(numbers_of(scene.friction.value()), numbers(0.5));
}

TEST_F(SceneFile, TakesEveryKeyOfCouplingAndSafety) {
  const Scene scene = read(with_lines(R"(
[coupling]
stiffness = 1500
damping = 0.25
angular_stiffness = 2
angular_damping = 0.001
max_force = 9
max_torque = 0.4
[safety]
max_force = 10
max_torque = 0.5
force_slew = 300
torque_slew = 15
soft_start = 0
)"));
  EXPECT_EQ(numbers_of(scene.coupling), numbers(1500, 0.25, 2, 0.001, 9, 0.4));
  EXPECT_EQ(numbers_of(scene.safety), numbers(10, 0.5, 300, 15, 0));
}

TEST_F(SceneFile, TakesEveryKeyOfAHand) {
  const Scene scene = with_device(R"(kind = "hand"
damping = 3
angular_damping = 0.004
delay = 0.001
mass = 0.3
inertia = 0.0005
arm_stiffness = 400
arm_damping = 8
arm_angular_stiffness = 1.5
arm_angular_damping = 0.03
resolution = 0.02
angular_resolution = 0.0001
plan = [ { time = 0.0, move = [1, 2, 3], turn = [2, 0, 0, 0] } ]
)");
  const auto& hand = std::get<HandSettings>(scene.device);
  EXPECT_EQ(numbers_of(hand),
            numbers(3, 0.004, 0.001, 0.3, 0.0005, 400, 8, 1.5, 0.03, 1e-3 * 0.02, 0.0001));
  ASSERT_EQ(hand.plan.size(), 1u);
  EXPECT_EQ(hand.plan[0].pose.translation, 1e-3 * Vector(1, 2, 3));
  EXPECT_EQ(hand.plan[0].pose.rotation, Eigen::Matrix3d::Identity());
}

TEST_F(SceneFile, TakesDevicesThatFeelNothing) {
  folder_.write("path.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n2,1,2,3,1,0,0,0\n");
  const Scene scripted = with_device("kind = \"script\"\npath = \"path.csv\"\ndelay = 0.002\n");
  const auto& script = std::get<ScriptSettings>(scripted.device);
  EXPECT_EQ(script.mechanics.delay, 0.002);
  ASSERT_EQ(script.plan.size(), 2u);
  EXPECT_EQ(script.plan[1].time, 2);
  EXPECT_EQ(script.plan[1].pose.translation, 1e-3 * Vector(1, 2, 3));
  const Scene still = with_device("kind = \"null\"\ndamping = 0\n");
  EXPECT_EQ(std::get<NullSettings>(still.device).mechanics.damping, 0);
}

TEST_F(SceneFile, TakesEveryKeyOfABody) {
  const Scene scene = read(R"(unit = "mm"
rate = 4000.5
seconds = 2
device = { kind = "null" }
[fixed]
shape = "upper jaw"
seed = 7
voxel_size = 0.4
spheres = "tight"
trust_normals = true
[held]
shape = "cylinder"
radius = 2
height = 3
voxel_size = 0.2
spheres = "simple"
translation = [1, -2, 3.5]
quaternion = [0, 0, 0, -3]
open = "-y"
)");
  EXPECT_EQ(scene.rate, 4000.5);
  EXPECT_EQ(scene.seconds, 2);
  const auto& jaw = std::get<BuiltInShape>(scene.fixed.front().source);
  EXPECT_EQ(jaw.kind, BuiltInShape::Kind::kUpperJaw);
  EXPECT_EQ(jaw.seed, 7u);
  EXPECT_EQ(scene.fixed.front().spheres, SpherePolicy::kTight);
  EXPECT_TRUE(scene.fixed.front().trust_normals);
  const auto& cylinder = std::get<BuiltInShape>(scene.held.front().source);
  EXPECT_EQ(cylinder.kind, BuiltInShape::Kind::kCylinder);
  EXPECT_EQ(cylinder.radius, 2);
  EXPECT_EQ(cylinder.height, 3);
  EXPECT_EQ(scene.held.front().spheres, SpherePolicy::kSimple);
  EXPECT_FALSE(scene.held.front().trust_normals);
  EXPECT_EQ(scene.held.front().translation, Vector(1, -2, 3.5)) << "not in the scene's unit";
  EXPECT_EQ(scene.held.front().rotation, Vector(-1, -1, 1).asDiagonal().toDenseMatrix());
  EXPECT_EQ(scene.open.value(), Vector(0, -1, 0));
}

TEST_F(SceneFile, KnowsUnitsPoliciesAxesAndShapes) {
  const std::pair<const char*, double> units[] = {
      {"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"inch", 0.0254}};
  for (const auto& [name, metres] : units) {
    const Scene scene = read(replaced(kSoundScene, "\"mm\"", std::string("\"") + name + "\""));
    EXPECT_EQ(scene.unit, metres);
    EXPECT_EQ(std::get<HandSettings>(scene.device).plan[1].pose.translation.z(), metres * -4);
  }
  for (const SpherePolicy policy : kSpherePolicies) {
    const std::string line = "radius = 5\nspheres = \"" + std::string(to_string(policy)) + "\"";
    EXPECT_EQ(read(replaced(kSoundScene, "radius = 5", line)).held.front().spheres, policy);
  }
  const std::pair<const char*, Vector> axes[] = {{"x", {1, 0, 0}}, {"-x", {-1, 0, 0}},
                                                 {"y", {0, 1, 0}}, {"-y", {0, -1, 0}},
                                                 {"z", {0, 0, 1}}, {"-z", {0, 0, -1}}};
  for (const auto& [name, axis] : axes) {
    const std::string line = std::string("radius = 5\nopen = \"") + name + "\"";
    EXPECT_EQ(read(replaced(kSoundScene, "radius = 5", line)).open.value(), axis);
  }
  const Scene jaw = read(replaced(kSoundScene, "\"sphere\"\nradius = 5", "\"lower jaw\""));
  EXPECT_EQ(std::get<BuiltInShape>(jaw.held.front().source).kind, BuiltInShape::Kind::kLowerJaw);
  EXPECT_EQ(std::get<BuiltInShape>(jaw.held.front().source).seed, 1u);

  const auto held = [&](const char* shape) {
    const Scene scene = read(replaced(kSoundScene, "\"sphere\"\nradius = 5", shape));
    return std::get<BuiltInShape>(scene.held.front().source);
  };
  const BuiltInShape splint = held("\"splint\"\nseed = 4\nopening = 4.5");
  EXPECT_EQ(splint.kind, BuiltInShape::Kind::kSplint);
  EXPECT_EQ(splint.seed, 4u);
  EXPECT_EQ(splint.opening, 4.5);
  EXPECT_EQ(held("\"splint\"").seed, 1u);
  EXPECT_EQ(held("\"splint\"").opening, 5);
  const BuiltInShape fossa = held("\"fossa\"\nradius = 7\nthickness = 2");
  EXPECT_EQ(fossa.kind, BuiltInShape::Kind::kFossa);
  EXPECT_EQ(fossa.radius, 7);
  EXPECT_EQ(fossa.thickness, 2);
}

TEST_F(SceneFile, FindsFilesFromItsFolderAndFromThatOfTheData) {
  const TriangleMesh cube = make_box({0, 0, 0}, {1, 1, 1});
  BuildOptions options;
  options.voxel_size = 0.5;
  std::filesystem::create_directory(folder_.path() / "sub");
  const auto tree = folder_.path() / "sub" / "cube.ist";
  write_tree(build_tree(cube, options), tree);
  const std::string shape = "shape = \"box\"\nsize = [40, 40, 10]\nvoxel_size = 1\n";
  const auto read_from = [&](const std::string& name) {
    return read(replaced(kSoundScene, shape, "file = \"" + name + "\"\n")).fixed.front();
  };
  const auto expect_tree = [&](const SceneBody& body) {
    EXPECT_TRUE(std::filesystem::equivalent(std::get<std::filesystem::path>(body.source), tree));
    EXPECT_FALSE(body.voxel_size);
  };
  expect_tree(read_from("sub/cube.ist"));
  expect_tree(read_from("./sub/../sub/cube.ist"));
  expect_tree(read_from(tree.string()));
  {
    const ScopedVariable data("IST_DATA_DIR", (folder_.path() / "sub").c_str());
    expect_tree(read_from("${IST_DATA_DIR}/cube.ist"));
  }
  folder_.write("cube.stl", "solid\nendsolid\n");
  const SceneBody mesh =
      read(replaced(kSoundScene, shape, "file = \"cube.stl\"\nvoxel_size = 1\n")).fixed.front();
  EXPECT_EQ(std::get<std::filesystem::path>(mesh.source), folder_.path() / "cube.stl");
  EXPECT_EQ(mesh.voxel_size, 1);
}

TEST_F(SceneFile, IsTextOfAnyHabit) {
  std::string lines_of_windows;
  for (const char c : kSoundScene)
    lines_of_windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& text :
       {lines_of_windows, "\xEF\xBB\xBF" + std::string(kSoundScene),
        "# é\n" + std::string(kSoundScene.substr(0, kSoundScene.size() - 1))}) {
    const Scene scene = read(text);
    EXPECT_EQ(scene.springs.value().stiffness, 20000);
    EXPECT_EQ(std::get<HandSettings>(scene.device).plan.size(), 2u);
  }
}

TEST_F(SceneFile, TakesQuaternionsOfAnyLength) {
  Eigen::Quaterniond turn(0.3, -0.7, 0.2, 0.9);
  for (const double length : {1.0, 1e-3, 100.0}) {
    const Eigen::Quaterniond q(turn.normalized().coeffs() * length);
    const std::string line = "radius = 5\nquaternion = [" + std::to_string(q.w()) + ", " +
                             std::to_string(q.x()) + ", " + std::to_string(q.y()) + ", " +
                             std::to_string(q.z()) + "]";
    const Eigen::Matrix3d rotation =
        read(replaced(kSoundScene, "radius = 5", line)).held.front().rotation;
    // to_string() gives six digits after the point.
    EXPECT_LT((rotation - turn.normalized().toRotationMatrix()).cwiseAbs().maxCoeff(),
              4e-6 / std::min(length, 1.0));
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
              2e-15);
  }
  const auto rotation = [&](const std::string& quaternion) {
    const std::string line = "radius = 5\nquaternion = " + quaternion;
    return read(replaced(kSoundScene, "radius = 5", line)).held.front().rotation;
  };
  EXPECT_LT((rotation("[3e-201, -7e-201, 2e-201, 9e-201]") - rotation("[3, -7, 2, 9]")).norm(),
            1e-15);
}

}  // namespace
}  // namespace ist::test
