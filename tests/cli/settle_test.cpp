#include <Eigen/Geometry>
#include <filesystem>

#include "cli/cli_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

// A box of 10 above a plate.
class SettleCommand : public CliTest {
 protected:
  [[nodiscard]] std::vector<std::string> with(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"settle", plate_,    box_,   "--closing", "-z",
                                       "--move", "0.2,0,1", "--at", "3,2,5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  const std::string plate_ = mesh("plate.stl", box({-20, -20, -2}, {20, 20, 0}));
  const std::string box_ = mesh("box.stl", box({-5, -5, 0}, {5, 5, 10}));
};

TEST_F(SettleCommand, SaysThatTheBoxRests) {
  const CommandResult said = ist_well(with({}));
  EXPECT_TRUE(said.out.starts_with("rests, level in 3 directions\n")) << said.out;
  EXPECT_NE(said.err.find("lengths are taken as millimetres"), std::string::npos);
  EXPECT_EQ(said.err.find("the load acts at"), std::string::npos);
}

TEST_F(SettleCommand, JsonHasTheProof) {
  const auto lines = json_lines(ist_well(with({"--json"})).out);
  ASSERT_FALSE(lines.empty());
  const json& settled = lines.back();
  EXPECT_EQ(settled["status"], "rests-level");
  EXPECT_EQ(settled["rocks"], false);
  EXPECT_EQ(settled["free"], true);
  EXPECT_NEAR(settled["margin"].get<double>(), 2, 1e-3);
  EXPECT_LE(settled["residual"].get<double>(), 1e-3);
  EXPECT_LE(settled["remaining"].get<double>(), 1e-3);
  EXPECT_EQ(settled["level"].size(), 3u);
  double sum = 0;
  for (const json& contact : settled["contacts"]) sum += contact["force"].get<double>();
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_EQ(settled["guessed"]["load_point"], false);
}

TEST_F(SettleCommand, WritesAPoseThatItReads) {
  for (const char* file : {"rest.tfm", "rest.pose"}) {
    ist_well(with({"-o", path(file)}));
    const auto lines = json_lines(ist_well({"settle", plate_, box_, "--closing", "-z", "--at",
                                            "3,2,5", "--json", "--matrix", path(file)})
                                      .out);
    ASSERT_FALSE(lines.empty());
    EXPECT_LT(std::abs(lines.back()["closed"].get<double>()), 1e-6) << file;
    EXPECT_NEAR(lines.back()["pose"][12].get<double>(), 0.2, 1e-3) << file;
  }
}

TEST_F(SettleCommand, ListsTheBitesOfManyStarts) {
  const auto lines = json_lines(ist_well(with({"--starts", "5", "--json"})).out);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back()["starts"], 5);
  std::size_t members = 0;
  for (const json& rest : lines.back()["rests"]) members += rest["starts"].size();
  EXPECT_EQ(members, 5u);
  EXPECT_EQ(json_lines(ist_well(with({"--starts", "5", "--json"})).out), lines);
}

TEST_F(SettleCommand, RefusesWrongWords) {
  const auto refuses = [&](const std::vector<std::string>& more, const std::string& part) {
    const CommandResult result = ist(with(more));
    EXPECT_NE(result.exit_code, 0) << part;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
  };
  refuses({"--hold", "x,tilt"}, "tilt is no freedom");
  refuses({"--hold", "z"}, "held");
  refuses({"--within", "2"}, "--within");
  refuses({"--within", "2,100"}, "--within");
  refuses({"--starts", "0"}, "--starts");
}

}  // namespace
}  // namespace ist::test
