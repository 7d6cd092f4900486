// A host program may set a locale whose decimal mark is a comma: a sweep is the same one there.

#include <gtest/gtest.h>

#include <string>

#include "support/german_locale.h"
#include "support/shapes.h"
#include "sweep/merge_parts.h"
#include "sweep/sweep.h"
#include "sweep/sweep_case.h"

namespace ist::test {
namespace {

class SweepLocale : public GermanLocale {
 protected:
  // A sweep opened in one locale, or in the other.
  [[nodiscard]] Sweep sweep(const std::string& text, bool german) const {
    german ? set_german() : set_classic();
    return Sweep(folder_.write("job.toml", text));
  }
  [[nodiscard]] SweepFolder folder(const Sweep& sweep) const {
    return {folder_.path() / "out", sweep.identity(), sweep.layout(), SweepFolder::Access::kWrite};
  }
};

TEST_F(SweepLocale, ChangesNeitherHashesNorParts) {
  for (const char* name : {"fixed.ist", "moving.ist"}) {
    write_tree(build_tree(icosphere(1, 1.5), {.voxel_size = 0.5}), folder_.path() / name);
  }
  const std::string box(kSoundSweep),
      grid = box.substr(0, box.find("[poses.box]")) +
             "[[poses.axes]]\nturn = [1, 2, 0.5]\nabout = [0, 0.25, 1]\nfrom = -1.5\nto = 1.5\n"
             "count = 5\n";
  for (const std::string& text : {box, grid}) {
    EXPECT_EQ(sweep(text, true).identity().hash, sweep(text, false).identity().hash) << text;
  }
  // What one began the other goes on with.
  const Sweep german = sweep(box, true);
  EXPECT_EQ(german.run_part(folder(german), 0, 1), Sweep::Outcome::kMade);
  const Sweep classic = sweep(box, false);
  const SweepFolder parts = folder(classic);
  EXPECT_EQ(classic.run_part(parts, 0, 1), Sweep::Outcome::kWasThere);
  EXPECT_GT(parts.look(0).seconds, 0);
  for (const std::uint64_t part : {1U, 2U}) classic.run_part(parts, part, 1);
  set_german();
  EXPECT_EQ(merge_parts(folder(german), german.layout(), TableCheck::kChecksum).rows, 10U);
}

}  // namespace
}  // namespace ist::test
