#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/occlusion_case.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

constexpr double kRoundPi = 3.14159265358979;

// Bites of a ball of radius 2, or of two, over a plate. At z = 2 - t a ball is t deep in it.
class CompareCommand : public OcclusionCommand {
 protected:
  // Writes a bite, and returns its path.
  std::string bite(const std::string& name, const std::string& body, const std::string& move,
                   std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"occlusion", plate_, body, "--move", move, "-o", path(name)};
    words.insert(words.end(), more.begin(), more.end());
    ist_well(words);
    return path(name);
  }
  [[nodiscard]] static json compared(const std::string& before, const std::string& after,
                                     std::vector<std::string> more = {}) {
    std::vector<std::string> words{"compare", before, after, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return json_lines(ist_well(words).out).at(0);
  }
  // A pose that moves, as --before and --after take it.
  std::string pose(const std::string& name, double x, double y, double z) const {
    return write(name, fmt::format("1 0 0 {}\n0 1 0 {}\n0 0 1 {}\n0 0 0 1\n", x, y, z));
  }
  void refuses_to_compare(const std::vector<std::string>& words, int code,
                          const std::string& part) const {
    std::vector<std::string> all{"compare"};
    all.insert(all.end(), words.begin(), words.end());
    const std::size_t before = dir_.entries();
    const CommandResult result = ist(all);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part)) << result.err;
    EXPECT_EQ(dir_.entries(), before);
  }

  const std::string balls_ = mesh("balls.stl", joined(moved(icosphere(4, 2), {-2.5, 0, 0}),
                                                      moved(icosphere(4, 2), {2.5, 0, -0.25})));
};

std::vector<std::string> fates(const json& comparison) {
  std::vector<std::string> fates;
  for (const json& contact : comparison["contacts"]) fates.push_back(contact["fate"]);
  return fates;
}

TEST_F(CompareCommand, OneBiteTwice_HasNoChange) {
  const std::string one = bite("one.json", balls_, "0,0,1.9");
  const json same = compared(one, one);
  EXPECT_EQ(fates(same), (std::vector<std::string>{"kept", "kept"}));
  for (const json& contact : same["contacts"]) {
    EXPECT_EQ(contact["moved"], 0);
    for (const char* key : {"area", "penetrating_area", "depth", "least_distance", "share"}) {
      EXPECT_EQ(contact["change"][key], 0) << key;
    }
  }
  for (const char* role : {"fixed", "moving"}) {
    for (const char* key : {"area", "penetrating_area", "depth_integral", "depth_at_vertices"}) {
      EXPECT_EQ(same[role][key]["change"], 0) << role << " " << key;
    }
  }
  EXPECT_EQ(same["depth"]["change"], json({0.0, 0.0}));
  EXPECT_EQ(same["motion"]["translation"], json({0.0, 0.0, 0.0}));
  EXPECT_EQ(same["motion"]["screw"]["point"], nullptr);
  EXPECT_EQ(same["count"]["kept"], 2);
}

// A cap of height t of a sphere of radius r has the area 2 π r t.
TEST_F(CompareCommand, DeeperBall_HasTheAreaOfItsCap) {
  const json change = compared(bite("a.json", ball_, "0,0,1.8"), bite("b.json", ball_, "0,0,1.7"));
  ASSERT_EQ(fates(change), std::vector<std::string>{"kept"});
  EXPECT_NEAR(change["moving"]["area"]["change"].get<double>(), 2 * kRoundPi * 2 * 0.1, 0.03);
  EXPECT_NEAR(change["moving"]["penetrating_area"]["change"].get<double>(), 0.4 * kRoundPi, 0.03);
  EXPECT_NEAR(change["contacts"][0]["change"]["depth"].get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(change["contacts"][0]["change"]["least_distance"].get<double>(), -0.1, 1e-9);
  EXPECT_EQ(change["contacts"][0]["change"]["share"], 0);
  EXPECT_LE(change["depth"]["change"][0], 0.1);
  EXPECT_GE(change["depth"]["change"][1], 0.1);
  EXPECT_NEAR(change["motion"]["translation"][2].get<double>(), -0.1, 1e-12);
  EXPECT_EQ(change["motion"]["rotation_degrees"], json({0.0, 0.0, 0.0}));
}

TEST_F(CompareCommand, ShiftedBall_IsMovedOrNewByItsWay) {
  const std::string before = bite("a.json", ball_, "0,0,1.8");
  const json near = compared(before, bite("b.json", ball_, "1.5,0,1.8"));
  ASSERT_EQ(fates(near), std::vector<std::string>{"moved"});
  EXPECT_NEAR(near["contacts"][0]["moved"].get<double>(), 1.5, 0.01);
  const std::string far = bite("c.json", ball_, "2.5,0,1.8");
  EXPECT_EQ(fates(compared(before, far)), (std::vector<std::string>{"lost", "new"}));
  EXPECT_EQ(fates(compared(before, far, {"--within", "3"})), std::vector<std::string>{"moved"});
  EXPECT_EQ(fates(compared(before, far, {"--within", "3", "--moved", "2.6"})),
            std::vector<std::string>{"kept"});
}

TEST_F(CompareCommand, ExchangedBites_ExchangeLostAndNew) {
  // At 2.1 the left ball is off the plate by 0.1, and the right one is 0.15 deep.
  const std::string both = bite("both.json", balls_, "0,0,2"),
                    one = bite("one.json", balls_, "0,0,2.12");
  const json there = compared(both, one), back = compared(one, both);
  EXPECT_EQ(fates(there), (std::vector<std::string>{"kept", "lost"}));
  EXPECT_EQ(fates(back), (std::vector<std::string>{"kept", "new"}));
  EXPECT_EQ(there["contacts"][1]["before"], back["contacts"][1]["after"]);
  EXPECT_EQ(there["contacts"][0]["change"]["area"].get<double>(),
            -back["contacts"][0]["change"]["area"].get<double>());
  for (const char* role : {"fixed", "moving"}) {
    EXPECT_EQ(there[role]["area"]["change"].get<double>(),
              -back[role]["area"]["change"].get<double>());
  }
}

TEST_F(CompareCommand, Meshes_GiveTheComparisonOfTheirBites) {
  const std::string before = pose("before.txt", 0, 0, 1.9), after = pose("after.txt", 0.5, 0, 1.8);
  const json files =
      compared(bite("a.json", balls_, "0,0,1.9"), bite("b.json", balls_, "0.5,0,1.8"));
  const json meshes = compared(plate_, balls_, {"--before", before, "--after", after});
  EXPECT_EQ(files, meshes);
  // Without --before the first pose is the stored one.
  const std::string stored = path("stored.json");
  ist_well({"occlusion", plate_, balls_, "-o", stored});
  EXPECT_EQ(compared(stored, path("b.json")), compared(plate_, balls_, {"--after", after}));
}

// The body turns by 90° about the axis through (3, 0, z) along z.
TEST_F(CompareCommand, Turn_IsToldAboutThePointAndAsAScrew) {
  const std::string before = pose("before.txt", 0, 0, 1.8),
                    after = write("after.txt", "0 -1 0 3\n1 0 0 -3\n0 0 1 1.9\n0 0 0 1\n");
  const json told =
      compared(plate_, ball_, {"--before", before, "--after", after, "--about", "3,2,0"})["motion"];
  const auto near = [](const json& of, const std::vector<double>& wanted) {
    ASSERT_EQ(of.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_NEAR(of[i].get<double>(), wanted[i], 1e-9) << i;
    }
  };
  EXPECT_EQ(told["about_named"], true);
  near(told["about"], {3, 2, 0});
  near(told["translation"], {-2, -2, 0.1});
  near(told["rotation_degrees"], {0, 0, 90});
  near(told["screw"]["axis"], {0, 0, 1});
  near(told["screw"]["point"], {3, 0, 0});
  EXPECT_NEAR(told["screw"]["angle_degrees"].get<double>(), 90, 1e-9);
  EXPECT_NEAR(told["screw"]["along"].get<double>(), 0.1, 1e-9);
  const json middle = compared(plate_, ball_, {"--before", before, "--after", after})["motion"];
  EXPECT_EQ(middle["about_named"], false);
  near(middle["about"], {0, 0, 1.8});
}

TEST_F(CompareCommand, Teeth_AreMatchedByTheirNumbers) {
  const auto count = icosphere(4, 2).triangles.size();
  const auto labels = [&](const char* name, const char* left, const char* right) {
    std::string text;
    for (std::size_t i = 0; i < 2 * count; ++i) text += i < count ? left : right;
    return write(name, text);
  };
  const auto labelled = [&](const char* name, const char* move, const std::string& file) {
    return bite(name, balls_, move, {"--labels-moving", file, "--numbering", "fdi"});
  };
  const std::string file = labels("labels.txt", "46\n", "36\n");
  const std::string before = labelled("a.json", "0,0,1.9", file);
  const json change = compared(before, labelled("b.json", "0,0,1.8", file));
  ASSERT_EQ(change["moving"]["teeth"].size(), 2U);
  EXPECT_EQ(change["moving"]["teeth"][0]["number"], 36);
  EXPECT_NEAR(change["moving"]["teeth"][0]["area"]["change"].get<double>(), 0.4 * kRoundPi, 0.03);
  EXPECT_EQ(change["contacts"][0]["after"]["teeth"], json({{"fixed", nullptr}, {"moving", 36}}));
  // Another tooth in the same place is another contact.
  const std::string other = labelled("c.json", "0,0,1.9", labels("other.txt", "47\n", "36\n"));
  EXPECT_EQ(fates(compared(before, other)), (std::vector<std::string>{"kept", "lost", "new"}));
  refuses_to_compare({before, labelled("d.json", "0,0,1.9", labels("none.txt", "17\n", "27\n"))}, 2,
                     "the moving body has no tooth that it has in ");
  const json unlabelled = compared(before, bite("e.json", balls_, "0,0,1.9"));
  EXPECT_EQ(unlabelled["moving"]["teeth"], json::array());
  EXPECT_TRUE(says(unlabelled["notes"].dump(), "teeth are left out: only one bite has labels"));
}

TEST_F(CompareCommand, BiteWithoutContact_LosesAll) {
  const std::string before = bite("a.json", balls_, "0,0,1.9"),
                    apart = bite("b.json", balls_, "0,0,3");
  EXPECT_EQ(fates(compared(before, apart)), (std::vector<std::string>{"lost", "lost"}));
  EXPECT_EQ(fates(compared(apart, before)), (std::vector<std::string>{"new", "new"}));
  const json none = compared(apart, apart);
  EXPECT_TRUE(none["contacts"].empty());
  EXPECT_EQ(none["fixed"]["sides"], nullptr);
  EXPECT_TRUE(says(ist_well({"compare", before, apart}).out, "the second bite has no contact"));
  EXPECT_TRUE(says(ist_well({"compare", apart, apart}).out, "contacts 0 before, 0 after"));
}

TEST_F(CompareCommand, TextTellsTheMotionAndEachContact) {
  const std::string said = ist_well({"compare", bite("a.json", ball_, "0,0,1.8"),
                                     bite("b.json", ball_, "0,0,1.7"), "-o", path("c.csv")})
                               .out;
  for (const char* part :
       {"moved    (0.000, 0.000, -0.100) mm at (0, 0, 1.8), the middle of the moving body's box; "
        "turned (0.000, 0.000, 0.000)° about x, y, z\n",
        "screw    no turn, 0.100 mm along (0, 0, -1)\n", "area     ", " before, ",
        "contacts 1 before, 1 after: 1 kept, 0 moved, 0 lost, 0 new\n", "-200 to -300",
        "100.0 to 100.0", "unit: mm (assumed)", "wrote ", "c.csv\n"}) {
    EXPECT_TRUE(says(said, part)) << said;
  }
}

TEST_F(CompareCommand, TableHoldsTheNumbersOfJson) {
  const std::string before = bite("a.json", balls_, "0,0,1.9"),
                    after = bite("b.json", balls_, "1,0,2.12");
  const json change = compared(before, after);
  ist_well({"compare", before, after, "-o", path("c.csv"), "-o", path("c.json")});
  EXPECT_EQ(json::parse(file_content(path("c.json"))), change);
  const CsvRows rows = csv_rows(file_content(path("c.csv")));
  const auto four = [](const json& number, double factor) {
    return fmt::format("{}", std::stod(fmt::format("{:.4g}", factor * number.get<double>())));
  };
  const CsvRows contacts = only(rows, {{"kind", "contact"}});
  ASSERT_EQ(contacts.size(), change["contacts"].size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const json& contact = change["contacts"][i];
    EXPECT_EQ(contacts[i].at("change"), contact["fate"]);
    for (const char* when : {"before", "after"}) {
      const json& of = contact[when];
      const auto cell = [&, i](const char* measure) {
        return contacts[i].at(fmt::format(fmt::runtime(measure), when));
      };
      if (of.is_null()) {
        EXPECT_EQ(cell("area_{}_mm2"), "");
        continue;
      }
      EXPECT_EQ(cell("contact_{}"), fmt::format("{}", of["number"].get<int>()));
      EXPECT_EQ(cell("area_{}_mm2"), four(of["area"], 1));
      EXPECT_EQ(cell("depth_{}_mm"), four(of["depth"], 1));
      EXPECT_EQ(cell("least_distance_{}_um"), four(of["least_distance"], 1000));
      EXPECT_EQ(cell("share_{}_percent"), four(of["share"], 100));
    }
    if (contact["change"].is_null()) continue;
    EXPECT_EQ(contacts[i].at("area_change_mm2"), four(contact["change"]["area"], 1));
  }
  EXPECT_EQ(only(rows, {{"kind", "motion"}, {"name", "translation_x_mm"}}).at(0).at("value"), "1");
  EXPECT_EQ(only(rows, {{"kind", "total"}, {"body", "moving"}}).at(0).at("area_change_mm2"),
            four(change["moving"]["area"]["change"], 1));
}

TEST_F(CompareCommand, MapsHoldTheChangeOfEachVertex) {
  ist_well({"compare", plate_, ball_, "--before", pose("a.txt", 0, 0, 2.5), "--after",
            pose("b.txt", 0, 0, 2.25), "-o", path("c.vtp"), "-o", path("c.ply"), "--range", "500"});
  const std::string vtp = file_content(path("c.vtp")), ply = file_content(path("c.ply"));
  for (const char* part : {"\"Before\"", "\"After\"", "\"Change\""}) {
    EXPECT_TRUE(says(vtp.substr(0, 4000), part));
  }
  EXPECT_TRUE(says(ply.substr(0, 1000), "property float change"));
  EXPECT_TRUE(says(ply.substr(0, 1000), "to 0.5 either way"));
}

TEST_F(CompareCommand, RefusesBitesThatAreNoPair) {
  const std::string one = bite("one.json", ball_, "0,0,1.8");
  const std::string other = mesh("other.stl", icosphere(3, 2));
  refuses_to_compare({one, bite("other.json", other, "0,0,1.8")}, 2,
                     "the moving body is other.stl (");
  ist_well({"occlusion", ball_, plate_, "--move", "0,0,-1.8", "-o", path("swapped.json")});
  refuses_to_compare({one, path("swapped.json")}, 2, "its fixed body is the moving one of ");
  refuses_to_compare({one, bite("part.json", ball_, "0,0,1.8", {"--region", "-9,-9,-9,9,9,9"})}, 2,
                     "the region is -9,-9,-9,9,9,9, and of ");
  json metres = json::parse(file_content(one));
  metres["unit"] = "m";
  refuses_to_compare({one, write("m.json", metres.dump())}, 2, "the unit is m, and of ");
  const json preset = compared(one, bite("stl.json", ball_, "0,0,1.8", {"--preset", "stl"}));
  EXPECT_EQ(preset["fixed"]["areas"], json::array());
  EXPECT_TRUE(says(preset["notes"].dump(), "areas within limits are left out"));
}

TEST_F(CompareCommand, RefusesFilesThatAreNoBites) {
  const std::string one = bite("one.json", ball_, "0,0,1.8");
  const auto changed = [&](const char* name, auto change) {
    json bite = json::parse(file_content(one));
    change(bite);
    return write(name, bite.dump());
  };
  refuses_to_compare({one, write("cut.json", "{\"schema\": 1")}, 3, "cut.json: not JSON: ");
  refuses_to_compare({one, write("list.json", "[]")}, 3, "list.json: no object");
  refuses_to_compare({one, changed("new.json", [](json& b) { b["schema"] = 2; })}, 3,
                     "schema is 2, and this version of IST reads 1");
  refuses_to_compare({one, changed("less.json", [](json& b) { b["contacts"][0].erase("area"); })},
                     3, "contacts[0].area is missing");
  refuses_to_compare(
      {one, changed("text.json", [](json& b) { b["contacts"][0]["centre"] = "here"; })}, 3,
      "contacts[0].centre is no list");
  refuses_to_compare({one, changed("pose.json", [](json& b) { b["pose"] = std::vector(16, 0); })},
                     3, "pose is no rigid motion");
  refuses_to_compare({one, path("none.json")}, 3, "none.json");
}

TEST_F(CompareCommand, RefusesOptionsThatDoNotGoTogether) {
  const std::string one = bite("one.json", ball_, "0,0,1.8"), at = pose("at.txt", 0, 0, 1);
  refuses_to_compare({one, ball_}, 2, "give two bites that ist occlusion -o FILE.json wrote");
  refuses_to_compare({one, one, "--preset", "stl"}, 2, "--preset: goes with two meshes");
  refuses_to_compare({one, one, "-o", path("c.vtp")}, 2, "a map of the change needs the meshes");
  refuses_to_compare({one, one, "-o", one}, 2, "writing it would destroy an input");
  refuses_to_compare({one, one, "--decimal", "comma"}, 2, "--decimal: goes with .csv");
  refuses_to_compare({plate_, ball_, "--after", at, "--range", "100"}, 2, "--range: goes with");
  refuses_to_compare({one, one, "--within", "-1"}, 2, "--within: give millimetres from 0 on");
  refuses_to_compare({one, one, "--about", "1,2"}, 2, "--about: 1,2: give x,y,z");
}

}  // namespace
}  // namespace ist::test
