// What is no scene: each is refused with the line where it is wrong and with a remedy.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ist/models/models.h"
#include "ist/scene.h"
#include "ist/tree/sphere_tree.h"
#include "scene/scene_case.h"
#include "support/errors.h"
#include "support/scoped_variable.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

// The sound scene with `part` replaced, the line that is blamed, and some of what is said of it.
struct BadScene {
  std::string part, by;
  int line;
  std::string said, remedy;
};

// In place of what is after the last line.
BadScene added(const std::string& lines, int line, const std::string& said,
               const std::string& remedy) {
  return {std::string(kLastLine), std::string(kLastLine) + lines, line, said, remedy};
}

class BadSceneTest : public ::testing::Test {
 protected:
  void expect_refused(const std::vector<BadScene>& scenes) const {
    for (const BadScene& bad : scenes) expect_error(replaced(kSoundScene, bad.part, bad.by), bad);
  }

  void expect_error(const std::string& text, const BadScene& bad) const {
    SCOPED_TRACE(bad.by.substr(0, 200));
    const std::filesystem::path file = folder_.write("scene.toml", text);
    const auto error = error_of([&] { static_cast<void>(read_scene(file)); });
    ASSERT_TRUE(error) << "it is taken for sound";
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    const std::string what = error->what();
    const std::string place = file.string() + ":" + std::to_string(bad.line) + ": ";
    EXPECT_TRUE(what.starts_with(place)) << what << "\nis not at line " << bad.line;
    const std::size_t said = what.find(bad.said);
    EXPECT_NE(said, std::string::npos) << what << "\ndoes not say: " << bad.said;
    EXPECT_NE(what.find(bad.remedy, said), std::string::npos)
        << what << "\nhas no remedy: " << bad.remedy;
  }

  TempDir folder_;
};

TEST_F(BadSceneTest, IsSoundBeforeItIsSpoilt) {
  EXPECT_EQ(
      error_name([&] { static_cast<void>(read_scene(folder_.write("scene.toml", kSoundScene))); }),
      "none");
}

TEST_F(BadSceneTest, HasNoSuchNumberOfWorkers) {
  for (const std::string workers : {"0", "3", "-1", "1.5", "\"two\"", "18446744073709551617"}) {
    const std::string text = replaced(kSoundScene, "rate = 1000", "workers = " + workers);
    const auto error =
        error_of([&] { static_cast<void>(read_scene(folder_.write("scene.toml", text))); });
    ASSERT_TRUE(error) << workers;
    EXPECT_NE(std::string(error->what()).find("scene.toml:2: "), std::string::npos)
        << error->what();
  }
}

TEST_F(BadSceneTest, IsNoToml) {
  const std::string toml = "write it in TOML 1.0";
  expect_refused({
      {"rate = 1000", "rate = ", 2, "expected value", toml},
      {"rate = 1000", "rate 1000", 2, "expected '='", toml},
      {"rate = 1000", "rate = 1000 seconds = 1", 2, "expected a comment or whitespace", toml},
      {"rate = 1000", "rate = 1000\nrate = 1000", 3, "cannot redefine existing integer 'rate'",
       toml},
      {"rate = 1000", "rate = 1e999", 2, "1e999", toml},
      {"rate = 1000", "rate = 99999999999999999999", 2, "not representable in 64 bits", toml},
      {"rate = 1000", "rate = 0100", 2, "leading zeroes", toml},
      {"\"mm\"", "\"mm", 1, "unescaped control characters", toml},
      {"\"mm\"", "\"mm\xff\"", 1, "invalid utf-8", toml},
      {"\"mm\"", "\"\\q\"", 1, "escape", toml},
      {"rate = 1000", std::string("rate = 1000\0", 12), 2, "saw '\\u0000'", toml},
      {"[held]", "[!]", 7, "expected bare key starting character", toml},
      {"[40, 40, 10]", "[40, }]", 5, "could not determine value type", toml},
      {"rate = 1000", "rate = 1979-05-27TT07:32:00Z", 2, "expected 2-digit hour", toml},
      {"rate", "\u00e9", 2, "saw '", toml},
      {"rate = 1000", "rate =\u00a01000", 2, "saw '", toml},
      {"rate = 1000", "rate = x\"\u00e9\u0499", 2, "could not determine value type", toml},
      {"[held]", "[held", 7, "expected ']'", toml},
      {"]\n[effects", "\n[effects", 17, "could not determine value type", toml},
      added("[fixed]\n", 19, "cannot redefine existing table 'fixed'", toml),
      added("[effects.springs]\n", 19, "cannot redefine existing table 'effects.springs'", toml),
  });
}

TEST_F(BadSceneTest, IsTooMuch) {
  const std::string many(1001, ' ');
  expect_refused({
      {"rate = 1000", "rate = 1000 " + many, 2, "a line of more than 1000 bytes", "break the line"},
      added("x = " + std::string(300, '[') + std::string(300, ']') + "\n", 19,
            "exceeded maximum nested value depth", "write it in TOML"),
      // Each part of a key is a table of its own.
      added(
          "[x" +
              [] {
                std::string s;
                for (int i = 0; i < 400; ++i) s += ".x";
                return s;
              }() +
              "]\n",
          19, "more than 8 nested values", "take the inner ones out"),
  });
  std::string large(kSoundScene);
  while (large.size() <= (std::size_t{1} << 20)) large += "# a long story\n";
  expect_error(large, {"", "1 MB", 1, "more than 1 MB", "names its meshes"});
}

TEST_F(BadSceneTest, HoldsWhatNobodyKnows) {
  expect_refused({
      {"rate = 1000", "rat = 1000", 2, "'rat' in the file is unknown", "did you mean 'rate'?"},
      {"rate = 1000", "colour = 3", 2, "'colour' in the file is unknown", "known here are unit, "},
      {"unit =", "unti =", 1, "'unti' in the file is unknown", "did you mean 'unit'?"},
      {"[held]", "[hled]", 7, "'hled' in the file is unknown", "did you mean 'held'?"},
      {"voxel_size = 1\n", "voxelsize = 1\n", 6, "'voxelsize' in [fixed] is unknown",
       "did you mean 'voxel_size'?"},
      {"shape = \"box\"", "shap = \"box\"", 4, "'shap' in [fixed] is unknown",
       "did you mean 'shape'?"},
      {"size = [40, 40, 10]", "size = [40, 40, 10]\nradius = 3", 6,
       "'radius' in [fixed] is unknown", "take it out; known here are name, file, shape, size"},
      {"size = [40, 40, 10]", "size = [40, 40, 10]\nopen = \"z\"", 6,
       "'open' in [fixed] is unknown", "known here are"},
      {"kind = \"hand\"", "kind = \"hand\"\npath = \"a.csv\"", 13, "'path' in [device] is unknown",
       "known here are kind"},
      {"time = 1,", "time = 1, trun = [1, 0, 0, 0],", 15, "'trun' in [device.plan.2] is unknown",
       "did you mean 'turn'?"},
      {"stiffness = 20000", "stifness = 20000", 18, "'stifness' in [effects.springs] is unknown",
       "did you mean 'stiffness'?"},
      {"[effects.springs]", "[effects.contacts]", 17, "'contacts' in [effects] is unknown",
       "did you mean 'contact'?"},
      {"[effects.springs]", "[effect.springs]", 17, "'effect' in the file is unknown",
       "did you mean 'effects'?"},
      added("[coupling]\nforce = 1\n", 20, "'force' in [coupling] is unknown", "max_force"),
      added("[safety]\nstiffness = 1\n", 20, "'stiffness' in [safety] is unknown", "max_force"),
  });
}

TEST_F(BadSceneTest, LacksWhatItNeeds) {
  expect_refused({
      {"unit = \"mm\"", "", 1, "the file has no 'unit'", "give \"m\", \"cm\", \"mm\""},
      {"shape = \"box\"\nsize = [40, 40, 10]\n", "", 3, "[fixed] has no 'file'",
       "or shape = \"upper jaw\""},
      {"shape = \"box\"\nsize = [40, 40, 10]\n", "mesh = \"x.ist\"\n", 4,
       "'mesh' in [fixed] is unknown, and there is no 'file'", "give 'file', a mesh or a tree, or"},
      {"size = [40, 40, 10]\n", "", 3, "[fixed] has no 'size'", "[x, y, z], three numbers"},
      {"radius = 5\n", "", 7, "[held] has no 'radius'", "a number from 1e-12"},
      {"shape = \"sphere\"", "shape = \"cylinder\"", 7, "[held] has no 'height'", "a number from"},
      {"shape = \"sphere\"", "shape = \"fossa\"", 7, "[held] has no 'thickness'", "a number from"},
      {"\"sphere\"\nradius = 5", "\"fossa\"\nthickness = 5", 7, "[held] has no 'radius'",
       "a number from"},
      {"voxel_size = 1\n", "", 3, "springs act between voxels", "give the edge of a voxel"},
      {"kind = \"hand\"\n", "", 11, "[device] has no 'kind'", "\"hand\", \"script\" or \"null\""},
      {"kind = \"hand\"", "kind = \"script\"", 11, "[device] has no 'path'", "name of a file"},
      {", move = [0, 0, -4]", "", 15, "[device.plan.2] has no 'move'", "[x, y, z], three numbers"},
      {"time = 1, ", "", 15, "[device.plan.2] has no 'time'", "a number from 0"},
      added("[effects.proximity]\n", 19, "[effects.proximity] has no 'distance'", "a number from"),
      added("[effects.gravity]\n", 19, "[effects.gravity] has no 'mass'", "kg"),
      added("[effects.snap]\n", 19, "[effects.snap] has no 'radius'", "a number from"),
  });
  expect_error("", {"", "nothing", 1, "the file has no 'unit'", "give"});
  expect_error("unit = \"mm\"\n", {"", "unit alone", 1, "the file has no 'fixed'", "give"});
}

TEST_F(BadSceneTest, HasValuesOfTheWrongKind) {
  expect_refused({
      {"\"mm\"", "\"furlong\"", 1, "'unit' in the file is \"furlong\"", "give \"m\", \"cm\""},
      {"\"mm\"", "0.001", 1, "'unit' in the file is 0.001", "give \"m\""},
      {"\"mm\"", "\"mm\\u0000\"", 1, "'unit' in the file is a text of 3 bytes", "give \"m\""},
      {"rate = 1000", "rate = \"1000\"", 2, "'rate' in the file is \"1000\"",
       "give a number from 1 to 10000 Hz"},
      {"rate = 1000", "rate = true", 2, "'rate' in the file is true", "give a number"},
      {"rate = 1000", "rate = 2026-01-01", 2, "'rate' in the file is a date or a time",
       "give a number"},
      {"rate = 1000", "rate = [1000]", 2, "'rate' in the file is an array of 1", "give a number"},
      {"\"box\"", "\"cube\"", 4, "'shape' in [fixed] is \"cube\"", "\"box\", \"sphere\""},
      {"[40, 40, 10]", "40", 5, "'size' in [fixed] is 40", "give [x, y, z]"},
      {"[40, 40, 10]", "[40, 40]", 5, "'size' in [fixed] is an array of 2", "give [x, y, z]"},
      {"[40, 40, 10]", "[40,\n\"40\", 10]", 6, "'size' in [fixed] is \"40\"", "give a number"},
      {"radius = 5", "radius = 5\ntrust_normals = 1", 10, "'trust_normals' in [held] is 1",
       "give true or false"},
      {"radius = 5", "radius = 5\nspheres = \"round\"", 10, "'spheres' in [held] is \"round\"",
       "\"tight\" or \"slab\""},
      {"radius = 5", "radius = 5\nopen = \"w\"", 10, "'open' in [held] is \"w\"", "\"-z\""},
      {"radius = 5", "radius = 5\nopen = \"-\"", 10, "'open' in [held] is \"-\"", "\"-z\""},
      {"radius = 5", "radius = 5\nopen = \"xy\"", 10, "'open' in [held] is \"xy\"", "\"-z\""},
      {"\"sphere\"\nradius = 5", "\"lower jaw\"\nseed = -1", 9, "'seed' in [held] is -1",
       "a whole number, from 0 on"},
      {"\"sphere\"\nradius = 5", "\"lower jaw\"\nseed = 1.5", 9, "'seed' in [held] is 1.5",
       "a whole number, from 0 on"},
      {"\"sphere\"\nradius = 5", "\"splint\"\nopening = \"5\"", 9, "'opening' in [held] is \"5\"",
       "from 0 to 20 mm"},
      {"\"hand\"", "\"foot\"", 12, "'kind' in [device] is \"foot\"", "\"hand\", \"script\""},
      {"[device]", "[[device]]", 11, "'device' in the file is an array of 1", "a table, [device]"},
      added("[[safety]]\n", 19, "'safety' in the file is an array of 1", "a table, [safety]"),
      {"[effects.springs]\nstiffness", "[effects]\nstiffness", 18,
       "'stiffness' in [effects] is unknown", "known here are contact, springs, friction"},
      {"[effects.springs]\nstiffness = 20000", "[effects]\ncontact = true", 18,
       "'contact' in [effects] is true", "a table, [effects.contact]"},
  });
}

TEST_F(BadSceneTest, HasNumbersWithoutSense) {
  const std::string springs(kSprings);
  expect_refused({
      {"rate = 1000", "rate = nan", 2, "'rate' in the file is nan", "from 1 to 10000 Hz"},
      {"rate = 1000", "rate = inf", 2, "'rate' in the file is inf", "from 1 to 10000 Hz"},
      {"rate = 1000", "rate = 0", 2, "'rate' in the file is 0", "from 1 to 10000 Hz"},
      {"rate = 1000", "rate = 10001", 2, "'rate' in the file is 10001", "from 1 to 10000 Hz"},
      {"rate = 1000", "seconds = -1", 2, "'seconds' in the file is -1", "s"},
      {"[40, 40, 10]", "[40, 0, 10]", 5, "'size' in [fixed] is 0", "from 1e-12"},
      {"radius = 5", "radius = -5", 9, "'radius' in [held] is -5", "from 1e-12"},
      {"\"sphere\"\nradius = 5", "\"splint\"\nopening = 20.5", 9, "'opening' in [held] is 20.5",
       "from 0 to 20 mm"},
      {"\"sphere\"\nradius = 5", "\"splint\"\nopening = -1", 9, "'opening' in [held] is -1",
       "from 0 to 20 mm"},
      {"\"sphere\"", "\"fossa\"\nthickness = 0", 9, "'thickness' in [held] is 0", "from 1e-12"},
      {"voxel_size = 0.5", "voxel_size = 0.0", 10, "'voxel_size' in [held] is 0", "from 1e-12"},
      {"radius = 5", "radius = 5\nquaternion = [0, 0, 0, 0]", 10,
       "'quaternion' in [held] is an array of 4", "[1, 0, 0, 0] is no turn"},
      {"radius = 5", "radius = 5\nquaternion = [1, 0, 0, nan]", 10, "'quaternion' in [held] is nan",
       "give a number"},
      {"radius = 5", "radius = 5\nquaternion = [1, 0, 0]", 10,
       "'quaternion' in [held] is an array of 3", "[w, x, y, z]"},
      {"radius = 5", "radius = 5\ntranslation = [0, inf, 0]", 10, "'translation' in [held] is inf",
       "give a number"},
      {"kind = \"hand\"", "kind = \"hand\"\nmass = 0", 13, "'mass' in [device] is 0", "kg"},
      {"kind = \"hand\"", "kind = \"hand\"\ninertia = -1", 13, "'inertia' in [device] is -1",
       "kg m²"},
      {"kind = \"hand\"", "kind = \"hand\"\narm_stiffness = -1", 13,
       "'arm_stiffness' in [device] is -1", "N/m"},
      {"kind = \"hand\"", "kind = \"hand\"\ndelay = 0.5", 13, "'delay' in [device] is 0.5",
       "from 0 to 0.01 s"},
      {"kind = \"hand\"", "kind = \"hand\"\ndamping = -0.1", 13, "'damping' in [device] is -0.1",
       "N s/m"},
      {"kind = \"hand\"", "kind = \"hand\"\nresolution = -1", 13, "'resolution' in [device] is -1",
       "from 0"},
      {"stiffness = 20000", "stiffness = -2000", 18, "'stiffness' in [effects.springs] is -2000",
       "from 0"},
      {"stiffness = 20000", "margin = -1", 18, "'margin' in [effects.springs] is -1",
       "in the scene's unit"},
      {"stiffness = 20000", "full_area = -1", 18, "'full_area' in [effects.springs] is -1",
       "in the scene's unit squared"},
      {springs, "[effects.contact]\nskin = -1", 18, "'skin' in [effects.contact] is -1",
       "in the scene's unit"},
      {springs, "[effects.contact]\nsteps = 11", 18, "'steps' in [effects.contact] is 11",
       "a whole number, 1 to 10"},
      {springs, "[effects.contact]\nsteps = 0", 18, "'steps' in [effects.contact] is 0",
       "a whole number, 1 to 10"},
      {springs, "[effects.contact]\n[effects.friction]\ncoefficient = -0.1", 19,
       "'coefficient' in [effects.friction] is -0.1", "from 0 to 10"},
      added("[effects.damping]\ndamping = -1\n", 20, "'damping' in [effects.damping] is -1",
            "from 0"),
      added("[effects.proximity]\ndistance = 0\n", 20, "'distance' in [effects.proximity] is 0",
            "from 1e-12"),
      added("[effects.gravity]\nmass = -1\n", 20, "'mass' in [effects.gravity] is -1", "kg"),
      added("[effects.gravity]\nmass = 1\nacceleration = [0, 0, nan]\n", 21,
            "'acceleration' in [effects.gravity] is nan", "m/s²"),
      added("[effects.snap]\nradius = 1\nangle = 4\n", 21, "'angle' in [effects.snap] is 4", "rad"),
      added("[coupling]\nstiffness = -1\n", 20, "'stiffness' in [coupling] is -1", "N/m"),
      added("[coupling]\nmax_force = 0\n", 20, "'max_force' in [coupling] is 0", "N"),
      added("[coupling]\nmax_force = 9\n", 20,
            "'max_force' in [coupling] is 9 N, more than the 8 that [safety] lets through",
            "raise 'max_force' in [safety]"),
      added("[safety]\nmax_torque = 0.1\n[coupling]\nmax_torque = 0.15\n", 22,
            "'max_torque' in [coupling] is 0.15 N m, more than the 0.1", "lower it"),
      added("[safety]\nsoft_start = -1\n", 20, "'soft_start' in [safety] is -1", "from 0 to 60 s"),
      added("[safety]\nforce_slew = 0\n", 20, "'force_slew' in [safety] is 0", "N/s"),
  });
}

TEST_F(BadSceneTest, HasKeysOfEarlierVersions) {
  const std::string springs(kSprings);
  expect_refused({
      {springs, "[effects.contact]\nstiffness = 2000", 18,
       "'stiffness' in [effects.contact] belongs to [effects.springs]", "take the key out"},
      {springs, "[effects.contact]\nskin = 1\nmargin = 0.25", 19,
       "'margin' in [effects.contact] belongs to [effects.springs]", "take the key out"},
      {springs, "[effects.contact]\n[effects.friction]\nstatic = 0.3", 19,
       "'static' in [effects.friction] is no key any more", "give 'coefficient'"},
      {springs, "[effects.contact]\n[effects.friction]\ndynamic = 0.2", 19,
       "'dynamic' in [effects.friction] is no key any more", "give 'coefficient'"},
      {springs, "[effects.contact]\n[effects.friction]\nstiffness = 500", 19,
       "'stiffness' in [effects.friction] is no key any more", "give 'coefficient'"},
  });
}

TEST_F(BadSceneTest, ContradictsItself) {
  const std::string springs(kSprings);
  expect_refused({
      {"shape = \"box\"", "shape = \"box\"\nfile = \"a.stl\"", 4,
       "[fixed] has both a 'file' and a 'shape'", "take out one"},
      {"\"sphere\"\nradius = 5", "\"file\"\nradius = 5", 8, "'shape' in [held] is \"file\"",
       "give"},
      {"unit = \"mm\"\nrate = 1000\n[fixed]\nshape = \"box\"\nsize = [40, 40, 10]",
       "unit = \"m\"\n[fixed]\nshape = \"upper jaw\"", 3, "a built-in jaw is in millimetres",
       "write unit = \"mm\""},
      {"unit = \"mm\"\nrate = 1000\n[fixed]\nshape = \"box\"\nsize = [40, 40, 10]",
       "unit = \"inch\"\n[fixed]\nshape = \"splint\"", 3, "a built-in splint is in millimetres",
       "write unit = \"mm\""},
      {springs, "[effects.friction]", 17, "[effects.friction] is a part of contact",
       "add the table [effects.contact]"},
      added("[effects.friction]\n", 19, "[effects.friction] is a part of contact",
            "write [effects.contact] in place of [effects.springs]"),
      added("[effects.contact]\n", 17, "a scene has [effects.contact] or [effects.springs]",
            "take one of the two out"),
      {springs, "[effects.damping]", 17, "[effects.damping] acts at contacts",
       "add the table [effects.contact] or [effects.springs]"},
      {"plan = [\n  { time = 0, move = [0, 0, 0] },\n  { time = 1, move = [0, 0, -4] },\n]",
       "plan = []", 13, "'plan' in [device] is an array of 0", "an array of tables"},
      {"  { time = 1, move = [0, 0, -4] },", "  3", 13, "'plan' in [device] is an array of 2",
       "an array of tables"},
      {"time = 0,", "time = 0.5,", 14, "[device.plan.1]: the first time is 0.5 s", "start at 0"},
      {"time = 1,", "time = 0,", 15, "[device.plan.2]: the time 0 s does not come after 0 s",
       "let times ascend"},
      {"move = [0, 0, -4]", "move = [0, 0, -4], turn = [0, 0, 1, 0]", 15,
       "more than a third of a circle", "add a waypoint between"},
  });
}

TEST_F(BadSceneTest, NamesFilesThatAreNotThere) {
  const std::string shape = "shape = \"box\"\nsize = [40, 40, 10]";
  const ScopedVariable data("IST_DATA_DIR", nullptr);
  expect_refused({
      {shape, "file = \"none.stl\"", 4,
       "there is no file " + (folder_.path() / "none.stl").string(),
       "starts at the scene's folder"},
      {shape, "file = \"/none/at/all.stl\"", 4, "there is no file /none/at/all.stl", "check"},
      {shape, "file = \".\"", 4, "there is no file", "check 'file'"},
      {shape, "file = \"\"", 4, "there is no file", "check 'file'"},
      {shape, "file = 3", 4, "'file' in [fixed] is 3", "give the name of a file"},
      {shape, "file = \"scene.toml\\u0000\"", 4, "'file' in [fixed] is a text of 11 bytes",
       "give the name of a file"},
      {shape, "file = \"${IST_DATA_DIR}/a.stl\"", 4, "'file' needs IST_DATA_DIR, which is not set",
       "set it in the environment"},
      {shape, "file = \"${HOME}/a.stl\"", 4, "'file' names a variable in \"${HOME}/a.stl\"",
       "only ${IST_DATA_DIR}/… at the beginning is known"},
      {shape, "file = \"a/${IST_DATA_DIR}/a.stl\"", 4, "'file' names a variable",
       "only ${IST_DATA_DIR}"},
      {"kind = \"hand\"", "kind = \"script\"\npath = \"none.csv\"", 13, "there is no file",
       "check 'path'"},
  });
  data.set(folder_.path().c_str());
  expect_refused({{shape, "file = \"${IST_DATA_DIR}/a.stl\"", 4,
                   "there is no file " + (folder_.path() / "a.stl").string(), "check 'file'"}});
}

TEST_F(BadSceneTest, GivesAVoxelSizeToATree) {
  BuildOptions options;
  options.voxel_size = 0.5;
  write_tree(build_tree(make_box({0, 0, 0}, {1, 1, 1}), options), folder_.path() / "box.ist");
  expect_refused({{"shape = \"box\"\nsize = [40, 40, 10]", "file = \"box.ist\"", 5,
                   "the file is a tree, which has its voxels", "take the key out"}});
}

TEST_F(BadSceneTest, NamesFilesInDifferentFrames) {
  TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  for (const auto& [name, frame] :
       {std::pair("ras.stl", PatientFrame::kRas), {"lps.stl", PatientFrame::kLps}}) {
    box.frame = frame;
    write_stl(box, folder_.path() / name);
  }
  const auto file = folder_.write(
      "scene.toml",
      "unit = \"mm\"\n[fixed]\nfile = \"ras.stl\"\nvoxel_size = 0.5\n[held]\nfile = \"lps.stl\"\n"
      "voxel_size = 0.5\n[device]\nkind = \"hand\"\nplan = [{ time = 0, move = [0, 0, 5] }, "
      "{ time = 1, move = [0, 0, 2] }]\n[effects.contact]\n");
  const auto error = error_of([&] { static_cast<void>(build_scene(read_scene(file))); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_NE(std::string(error->what()).find("ist build --to-frame"), std::string::npos)
      << error->what();
}

TEST_F(BadSceneTest, HasAScriptThatIsNone) {
  folder_.write("bad.csv", "time,x,y\n");
  const auto file = folder_.write(
      "scene.toml", replaced(kSoundScene, kSoundScene.substr(kSoundScene.find("kind")),
                             "kind = \"script\"\npath = \"bad.csv\"\n"));
  const auto error = error_of([&] { static_cast<void>(read_scene(file)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_TRUE(std::string(error->what()).starts_with((folder_.path() / "bad.csv").string()))
      << error->what();
}

TEST_F(BadSceneTest, IsNotThere) {
  EXPECT_EQ(error_name([&] { static_cast<void>(read_scene(folder_.path() / "none.toml")); }),
            "file-unreadable");
  EXPECT_EQ(error_name([&] { static_cast<void>(read_scene(folder_.path())); }), "file-unreadable");
}

}  // namespace
}  // namespace ist::test
