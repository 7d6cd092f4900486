// A host program may set a locale whose decimal mark is a comma: numbers in files are read all the
// same.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <string>

#include "ist/mesh/mesh.h"
#include "ist/scene.h"
#include "scene/scene_text.h"
#include "support/mesh_files.h"
#include "support/run_command.h"
#include "support/shapes.h"
#include "support/skip.h"
#include "support/temp_dir.h"
#include "support/zip_file.h"

namespace ist::test {
namespace {

class Locale : public ::testing::Test {
 protected:
  // Makes the locale of a country that writes 0,5, and sets it.
  void SetUp() override {
    const std::string made = folder_.path() / "de_DE.UTF-8";
    if (!std::filesystem::exists("/usr/share/i18n/locales/de_DE")) {
      IST_SKIP("no sources of locales are here: scripts/setup.sh installs them");
    }
    const CommandResult made_it =
        run_command("/usr/bin/localedef", {"--no-archive", "-i", "de_DE", "-f", "UTF-8", made});
    ASSERT_EQ(made_it.exit_code, 0) << made_it.err;
    ASSERT_EQ(setenv("LOCPATH", folder_.path().c_str(), 1), 0);
    ASSERT_NE(std::setlocale(LC_ALL, "de_DE.UTF-8"), nullptr);
    ASSERT_STREQ(std::localeconv()->decimal_point, ",");
    ASSERT_EQ(std::strtod("0,5", nullptr), 0.5);
  }
  void TearDown() override { std::setlocale(LC_ALL, "C"); }

  TempDir folder_;
};

TEST_F(Locale, MeshesAreReadAlikeInEveryFormat) {
  // Made before and after: what makes the texts may depend on the locale as well.
  std::setlocale(LC_ALL, "C");
  const TriangleMesh mesh = narrowed(icosphere(1, 1.25));
  auto formats = all_formats(mesh);
  formats.emplace_back("3MF", as_3mf(threemf_model(mesh)));
  std::setlocale(LC_ALL, "de_DE.UTF-8");
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

}  // namespace
}  // namespace ist::test
