// The command writes numbers alike in every locale: in that of the environment, and what its parts
// write where a host has set one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "answers/formats/csv_writer.h"
#include "answers/refusals.h"
#include "cli/commands/advise_report.h"
#include "ist/mesh/mesh.h"
#include "support/effort.h"
#include "support/german_locale.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

class CommandLocale : public GermanLocale {};

TEST_F(CommandLocale, OfTheEnvironmentChangesNoOutput) {
  IST_SLOW();
  const std::string ball = folder_.path() / "ball.stl";
  write_stl(icosphere(2, 2), ball);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"info", ball},
        {"collide", ball, ball, "--move", "3.25,0,0.125", "--voxel-size", "0.25"},
        {"collide", ball, ball, "--move", "4.125,0,0", "--voxel-size", "0.25"}}) {
    const CommandResult here = run_command(IST_COMMAND, arguments);
    language_.set(nullptr);
    const CommandResult elsewhere = run_command(IST_COMMAND, arguments);
    language_.set(kName);
    EXPECT_EQ(here.exit_code, elsewhere.exit_code) << here.err;
    EXPECT_EQ(here.out, elsewhere.out);
    EXPECT_TRUE(std::regex_search(here.out, std::regex("[0-9]\\.[0-9]"))) << here.out;
  }
}

TEST_F(CommandLocale, AdviceIsTheSame) {
  VoxelAdvice advice;
  advice.measured.resize(1);
  advice.measured.front().voxel_size = 0.125;
  advice.measured.front().error = 0.0625;
  advice.measured.front().slowest_query = 1234.5;
  for (const AdviceGoal::Of of : {AdviceGoal::Of::kError, AdviceGoal::Of::kSlowestQuery}) {
    expect_same([&] { return cli::why_none(advice, {of, 0.015}); });
  }
  advice.recommended = 0;
  expect_same([&] {
    ::testing::internal::CaptureStdout();
    cli::print_table(advice);
    cli::print_json(advice);
    cli::print_build_commands(0.125, "a.stl", "b.stl", 1'000'000);
    std::fflush(stdout);
    return ::testing::internal::GetCapturedStdout();
  });
}

TEST_F(CommandLocale, TablesAreTheSame) {
  const std::string file = folder_.path() / "table.csv";
  expect_same([&] {
    answers::CsvWriter csv(file, {"a", "b", "c"});
    csv.row(0.5, 1234567.25F, 1'000'000);
    csv.commit();
    return file_content(file);
  });
}

TEST_F(CommandLocale, NumbersAreReadAlike) {
  EXPECT_EQ(answers::numbers_of("0.5,-1.25e2"), (std::vector<double>{0.5, -125}));
  EXPECT_EQ(answers::numbers_of("0.5.5"), std::nullopt);
}

}  // namespace
}  // namespace ist::test
