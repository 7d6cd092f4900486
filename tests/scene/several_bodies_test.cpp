// Scenes of several bodies: what is built of them, and what is refused.

#include <gtest/gtest.h>

#include "ist/base/error.h"
#include "scene/scene_case.h"
#include "support/errors.h"
#include "support/largest_allocation.h"

namespace ist::test {
namespace {

constexpr std::string_view kBodies = R"(unit = "mm"
[[fixed]]
name = "plate"
shape = "box"
size = [40, 40, 4]
voxel_size = 1
[[fixed]]
name = "piece"
shape = "box"
size = [4, 4, 4]
voxel_size = 1
translation = [0, 10, 8]
attachable = true
[[fixed]]
name = "far"
shape = "box"
size = [4, 4, 4]
voxel_size = 1
translation = [0, 300, 8]
[[held]]
name = "tool"
shape = "sphere"
radius = 3
voxel_size = 0.5
translation = [0, 0, 8]
[[held]]
name = "handle"
shape = "box"
size = [2, 2, 20]
voxel_size = 0.5
translation = [0, 0, 22]
[device]
kind = "hand"
plan = [
  { time = 0, move = [0, 0, 0] },
  { time = 1, move = [0, 0, -4] },
]
[[changes]]
time = 0.1
attach = "piece"
[[changes]]
time = 0.5
release = "piece"
[effects.springs]
)";

class SeveralBodies : public SceneCase {
 protected:
  // A scene with one part replaced is refused at that line.
  void expect_refused(std::string_view part, std::string_view by, int line, std::string_view what,
                      std::string_view remedy) const {
    SCOPED_TRACE(by);
    const std::string text = replaced(kBodies, part, by);
    const std::optional<Error> error = error_of([&] { static_cast<void>(built(text)); });
    ASSERT_TRUE(error) << "it is built";
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    const std::string_view said = error->what();
    const std::string place = (dir_.path() / "scene.toml:").string() + std::to_string(line) + ": ";
    EXPECT_TRUE(said.starts_with(place)) << said << " is not at line " << line;
    EXPECT_NE(said.find(what), said.npos) << said;
    EXPECT_NE(said.find(remedy, said.find(what)), said.npos) << said;
  }
};

TEST_F(SeveralBodies, AreReadInTheirOrder) {
  const Scene scene = scene_of(kBodies);
  ASSERT_EQ(scene.fixed.size(), 3u);
  ASSERT_EQ(scene.held.size(), 2u);
  EXPECT_EQ(scene.fixed[1].name, "piece");
  EXPECT_TRUE(scene.fixed[1].attachable);
  EXPECT_FALSE(scene.fixed[0].attachable);
  EXPECT_EQ(scene.held[1].name, "handle");
  ASSERT_EQ(scene.changes.size(), 2u);
  EXPECT_EQ(scene.changes[0].body, "piece");
  EXPECT_TRUE(scene.changes[0].attach);
  EXPECT_EQ(scene.changes[1].time, 0.5);
  EXPECT_FALSE(scene.changes[1].attach);
  EXPECT_EQ(scene.text, kBodies);
}

TEST_F(SeveralBodies, HaveNamesByDefault) {
  std::string text(kBodies);
  for (const char* name : {"name = \"plate\"\n", "name = \"far\"\n", "name = \"handle\"\n"}) {
    text = replaced(text, name, "");
  }
  const Scene scene = scene_of(text);
  EXPECT_EQ(scene.fixed[0].name, "fixed.1");
  EXPECT_EQ(scene.fixed[2].name, "fixed.3");
  EXPECT_EQ(scene.held[1].name, "held.2");
  EXPECT_EQ(scene_of(kSoundScene).fixed.front().name, "fixed");
}

// Each pair of one that may be fixed and one that may be held, but for those that cannot meet.
TEST_F(SeveralBodies, HaveAQueryForEachPairThatMayMeet) {
  const BuiltScene scene = built(kBodies);
  std::vector<std::string> queries;
  for (const BuildNote& note : scene.notes) {
    if (note.built && note.what.starts_with("contact points")) queries.push_back(note.what);
  }
  const std::vector<std::string> expected{
      "contact points, plate – piece",  "contact points, plate – tool",
      "contact points, plate – handle", "contact points, piece – tool",
      "contact points, piece – handle", "contact points, far – piece"};
  EXPECT_EQ(queries, expected);
  for (const char* held : {"tool", "handle"}) {
    const BuildNote note = note_of(scene, std::string("contact points, far – ") + held);
    EXPECT_FALSE(note.built);
    EXPECT_EQ(note.why, "their roots stay apart wherever the plan leads");
  }
  EXPECT_EQ(scene.simulation->bodies(), 5u);
  EXPECT_EQ(scene.simulation->body_name(4), "handle");
  EXPECT_EQ(scene.simulation->body_name(5), "");
}

// A plan that leads there has the pair's query.
TEST_F(SeveralBodies, ThatThePlanReachesHaveTheirQuery) {
  const BuiltScene scene = built(replaced(kBodies, "move = [0, 0, -4]", "move = [0, 260, 0]"));
  EXPECT_TRUE(note_of(scene, "contact points, far – tool").built);
}

// A body that brakes the tool from afar is not out of reach.
TEST_F(SeveralBodies, ThatBrakeFromAfarHaveTheirQuery) {
  const auto with_proximity = [](const char* distance) {
    return std::string(kBodies) + "[effects.proximity]\ndistance = " + distance + "\n";
  };
  EXPECT_FALSE(note_of(built(with_proximity("4")), "contact points, far – tool").built);
  const BuiltScene scene = built(with_proximity("200"));
  EXPECT_TRUE(note_of(scene, "contact points, far – tool").built);
  EXPECT_TRUE(note_of(scene, "proximity query, far – tool").built);
}

// The hand feels what is under the tool, whichever body it is.
TEST_F(SeveralBodies, AreFeltByTheHand) {
  const BuiltScene scene = built(kBodies);
  Tick tick{};
  while (!scene.device->done()) {
    tick = scene.simulation->tick(scene.device->read());
    scene.device->write(tick.wrench, scene.simulation->dt());
  }
  ASSERT_EQ(scene.simulation->changes().size(), 2u);
  EXPECT_EQ(scene.simulation->changes()[0].status, ChangeStatus::kDone);
  EXPECT_EQ(scene.simulation->changes()[1].status, ChangeStatus::kDone);
  EXPECT_GT(tick.wrench[2], 0.1);
  // It went along for 0.4 s, 1.6 mm.
  EXPECT_NEAR(scene.simulation->body_pose(1).translation.z(), 6.4e-3, 2e-4);
}

TEST_F(SeveralBodies, OfOneNameAreRefused) {
  expect_refused("\"far\"", "\"plate\"", 15, "two bodies are called plate", "a name of its own");
  expect_refused("\"handle\"", "\"piece\"", 27, "two bodies are called piece", "a name of its own");
  expect_refused("name = \"far\"", "name = \"\"", 15, "an empty 'name'", "give a name");
}

TEST_F(SeveralBodies, WithoutAHeldBodyAreRefused) {
  const std::size_t held = kBodies.find("[[held]]"), device = kBodies.find("[device]");
  const std::string none =
      std::string(kBodies.substr(0, held)) + std::string(kBodies.substr(device));
  const auto error = error_of([&] { static_cast<void>(built(none)); });
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("has no 'held'"), std::string::npos) << error->what();
  Scene scene = scene_of(kBodies);
  scene.held.clear();
  const auto made = error_of([&] { static_cast<void>(build_scene(scene)); });
  ASSERT_TRUE(made);
  EXPECT_NE(std::string(made->what()).find("there is no held body"), std::string::npos);
  scene = scene_of(kBodies);
  scene.fixed.clear();
  ASSERT_TRUE(error_of([&] { static_cast<void>(build_scene(scene)); }));
}

TEST_F(SeveralBodies, WithWrongChangesAreRefused) {
  expect_refused("attach = \"piece\"", "attach = \"peace\"", 40, "there is no body called peace",
                 "far, handle, piece, plate, tool");
  expect_refused("attach = \"piece\"", "attach = \"plate\"", 40, "plate stays where it is",
                 "attachable = true");
  expect_refused("attach = \"piece\"", "release = \"piece\"", 40, "not in the hand", "take");
  expect_refused("release = \"piece\"", "attach = \"piece\"", 43, "in the hand already", "take");
  expect_refused("time = 0.5", "time = 0.05", 42, "does not come after 0.1", "ascend");
  expect_refused("release = \"piece\"", "attach = \"piece\"\nrelease = \"piece\"", 44,
                 "both 'attach' and 'release'", "take out one");
  expect_refused("release = \"piece\"", "carry = \"piece\"", 41, "has no 'attach'", "give");
}

// Nothing would tell whether the body that the hand takes is free.
TEST_F(SeveralBodies, ForTheHandNeedContacts) {
  expect_refused("[effects.springs]", "[effects.gravity]\nmass = 0.1", 13,
                 "whether anything touches piece is not known", "[effects.contact]");
}

TEST_F(SeveralBodies, ThatAreNotFreeNameThePair) {
  expect_refused("translation = [0, 10, 8]", "translation = [0, 2, 8]", 20,
                 "piece and tool intersect", "open = ");
}

TEST_F(SeveralBodies, BeyondTheMemoryNameThePair) {
  const Scene scene = scene_of(kBodies);
  std::optional<Error> error;
  const std::size_t peak = peak_allocation(
      [&] { error = error_of([&] { static_cast<void>(build_scene(scene, {}, 60'000'000)); }); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  const std::string said = error->what();
  const std::string place = (dir_.path() / "scene.toml:7: ").string();
  EXPECT_TRUE(said.starts_with(place + "the queries up to that of piece and tool take")) << said;
  EXPECT_TRUE(said.ends_with("allow more with --max-memory, or take bodies out")) << said;
  EXPECT_LT(peak, 8'000'000u) << "a query was made";
}

// A script of a fixed body: read from its file, with its flaws at their line.
TEST_F(SeveralBodies, MayFollowAScript) {
  dir_.write("rail.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.5,0,0,2,1,0,0,0\n");
  const std::string text =
      replaced(kBodies, "name = \"far\"\n", "name = \"far\"\nscript = \"rail.csv\"\n");
  const BuiltScene scene = built(text);
  EXPECT_TRUE(note_of(scene, "contact points, far – tool").built) << "it may come near";
  const auto taken = error_of(
      [&] { static_cast<void>(built(replaced(text, "attach = \"piece\"", "attach = \"far\""))); });
  ASSERT_TRUE(taken);
  EXPECT_NE(std::string(taken->what()).find(":41: far follows a script"), std::string::npos)
      << taken->what();
  for (int i = 0; i < 250; ++i) {
    static_cast<void>(scene.simulation->tick(scene.device->read()));
  }
  EXPECT_NEAR(scene.simulation->body_pose(2).translation.z(), 9e-3, 2e-5);
  dir_.write("rail.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.001,0,0,2,1,0,0,0\n");
  const auto error = error_of([&] { static_cast<void>(built(text)); });
  ASSERT_TRUE(error);
  const std::string said = error->what();
  EXPECT_NE(said.find("scene.toml:16: "), std::string::npos) << said;
  EXPECT_NE(said.find("rail.csv: from 0 s to 0.001 s, far moves by"), std::string::npos) << said;
}

}  // namespace
}  // namespace ist::test
