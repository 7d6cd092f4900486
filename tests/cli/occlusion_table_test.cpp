// The table of ist occlusion: each number under its heading, with its unit.

#include <fmt/format.h>

#include <algorithm>

#include "cli/occlusion_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

class OcclusionTable : public OcclusionCommand {};

// As a table writes it: four significant digits.
std::string four(double number) {
  return fmt::format("{}", std::stod(fmt::format("{:.4g}", number)));
}

// Two balls of other depths in the plate, with labels: each number of the table is that of JSON.
TEST_F(OcclusionTable, TablesHoldEachNumberUnderItsHeading) {
  const std::string pair = mesh("balls.stl", joined(moved(icosphere(4, 2), {-2.5, 0, 0}),
                                                    moved(icosphere(4, 2), {2.5, 0, -0.1})));
  const auto count = static_cast<int>(icosphere(4, 2).triangles.size());
  std::string labels;
  for (int i = 0; i < 2 * count; ++i) labels += i < count ? "46\n" : "36\n";
  ist_well({"occlusion", plate_, pair, "--move", "0,0,1.9", "--labels-moving",
            write("labels.txt", labels), "--numbering", "fdi", "-o", path("b.csv"), "-o",
            path("b.json"), "-o", path("c.report.html")});
  const CsvRows rows = csv_rows(file_content(path("b.csv")));
  const json bite = json::parse(file_content(path("b.json")));
  const auto expect = [&](const std::map<std::string, std::string>& which, const char* heading,
                          const json& number, double factor = 1) {
    const CsvRows found = only(rows, which);
    ASSERT_EQ(found.size(), 1U) << heading;
    EXPECT_EQ(found[0].at(heading), four(factor * number.get<double>())) << heading;
  };
  // The ends of the interval are rounded away from each other.
  const auto both = only(rows, {{"kind", "total"}, {"body", "both"}}).at(0);
  const double lower = bite["depth_lower"], upper = bite["depth_upper"];
  EXPECT_LE(std::stod(both.at("depth_mm")), lower);
  EXPECT_NEAR(std::stod(both.at("depth_mm")), lower, 0.001 * lower);
  EXPECT_GE(std::stod(both.at("depth_upper_mm")), upper);
  EXPECT_NEAR(std::stod(both.at("depth_upper_mm")), upper, 0.001 * upper);
  expect({{"kind", "total"}, {"body", "both"}}, "depth_at_vertices_mm", bite["depth_at_vertices"]);
  ASSERT_EQ(bite["contacts"].size(), 2U);
  for (const json& contact : bite["contacts"]) {
    const auto number = std::to_string(contact["number"].get<int>());
    const std::map<std::string, std::string> row{{"kind", "pair"}, {"contact", number}};
    expect(row, "area_mm2", contact["area"]);
    expect(row, "overlap_mm2", contact["penetrating_area"]);
    expect(row, "depth_integral_mm3", contact["depth_integral"]);
    expect(row, "least_distance_um", contact["least_distance"], 1000);
    expect(row, "share_percent", contact["share"], 100);
    expect(row, "share_thinner_percent", contact["share_thinner"], 100);
    expect(row, "share_thicker_percent", contact["share_thicker"], 100);
    EXPECT_NEAR(std::stod(only(rows, row).at(0)["closest_x_mm"]),
                contact["closest"][0].get<double>(), 0.0051);
    EXPECT_NEAR(std::stod(only(rows, row).at(0)["centre_z_mm"]), contact["centre"][2].get<double>(),
                0.0051);
  }
  EXPECT_GT(bite["contacts"][0]["area"], bite["contacts"][1]["area"]);
  for (const std::string role : {"fixed", "moving"}) {
    const json& body = bite[role];
    const std::map<std::string, std::string> total{{"kind", "total"}, {"body", role}};
    expect(total, "depth_at_vertices_mm", body["depth_at_vertices"]);
    EXPECT_EQ(only(rows, total).at(0).at("depth_mm"), "");
    expect(total, "overlap_mm2", body["penetrating_area"]);
    expect(total, "depth_integral_mm3", body["depth_integral"]);
    expect(total, "area_mm2",
           body["regions"][0]["area"].get<double>() + body["regions"][1]["area"].get<double>());
    const std::map<std::string, std::string> band{{"kind", "band"}, {"body", role}};
    const auto of = [&](const char* from, const char* to) {
      auto row = band;
      row["from_um"] = from;
      row["to_um"] = to;
      return row;
    };
    EXPECT_EQ(only(rows, band).size(), 3U);
    expect(of("", "0"), "area_mm2", body["penetrating_area"]);
    expect(of("", "100"), "area_mm2", body["areas"][1]["area"]);
    expect(of("0", "100"), "area_mm2", body["areas"][1]["area_outside"]);
    for (const json& region : body["regions"]) {
      expect({{"kind", "region"},
              {"body", role},
              {"contact", std::to_string(region["contact"].get<int>())}},
             "area_mm2", region["area"]);
    }
    for (const auto& [name, share] : body["sides"]["per_cent"].items()) {
      if (name == "asymmetry") continue;
      expect({{"kind", "side"}, {"body", role}, {"name", name}}, "share_percent", share);
    }
  }
  for (const json& tooth : bite["moving"]["teeth"]) {
    const std::map<std::string, std::string> row{
        {"kind", "tooth"}, {"name", std::to_string(tooth["number"].get<int>())}};
    expect(row, "area_mm2", tooth["area"]);
    expect(row, "share_percent", tooth["share"], 100);
    expect(row, "least_distance_um", tooth["least_distance"], 1000);
  }
  EXPECT_EQ(only(rows, {{"kind", "tooth"}}).size(), 2U);
  EXPECT_EQ(only(rows, {{"kind", "note"}}).size(), bite["checks"].size());
  for (const auto& row : rows) {
    for (const auto& [heading, cell] : row) EXPECT_NE(cell, "-0") << heading;
  }
}

// A hundred triangles of 0.0072 mm², each too small for a region, over a plate.
TEST_F(OcclusionTable, TotalArea_IsTheMeanOfBothBodies) {
  TriangleMesh flakes;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.15 * (i % 10), y = 0.15 * (i / 10);
    const auto at = static_cast<std::uint32_t>(flakes.vertices.size());
    for (const auto& [dx, dy] : {std::pair(0.0, 0.0), {0.0, 0.12}, {0.12, 0.0}}) {
      flakes.vertices.emplace_back(x + dx, y + dy, 0.05);
    }
    flakes.triangles.push_back({at, at + 1, at + 2});
  }
  ist_well({"occlusion", plate_, mesh("flakes.stl", flakes), "-o", path("b.csv")});
  const CsvRows rows = csv_rows(file_content(path("b.csv")));
  const auto area = [&](const char* body) {
    return std::stod(only(rows, {{"kind", "total"}, {"body", body}}).at(0).at("area_mm2"));
  };
  EXPECT_EQ(area("moving"), 0);
  EXPECT_GT(area("fixed"), 1);
  EXPECT_NEAR(area("both"), area("fixed") / 2, 0.001);
}

// Two triangles that cross. All corners are nearest to a border, where there is no sign.
TEST_F(OcclusionTable, OpenSurfaceWithoutADeepVertex_HasNoKnownDepth) {
  TriangleMesh sheet, strip;
  sheet.vertices = {{-5, -5, 0}, {5, -5, 0}, {0, 6, 0}};
  strip.vertices = {{-4, 0, 3}, {-4, 0, 1}, {4, 0, -0.6}};
  sheet.triangles = strip.triangles = {{0, 1, 2}};
  const std::string lower = mesh("lower.stl", sheet), upper = mesh("upper.stl", strip);
  const auto asked = [&](const char* move) {
    return ist_well({"occlusion", lower, upper, "--move", move, "-o", path("b.csv"), "-o",
                     path("b.json"), "-o", path("b.report.html")})
        .out;
  };
  const auto cells = [&](const char* heading) {
    std::vector<std::string> found;
    for (const auto& row : only(csv_rows(file_content(path("b.csv"))), {{"kind", "total"}})) {
      found.push_back(row.at(heading));
    }
    return found;
  };
  const std::string met = asked("0,0,0");
  EXPECT_TRUE(says(met, "touch yes, depth not known (open surface) ("));
  EXPECT_TRUE(says(met, "depth is not known: lower.stl and upper.stl are open"));
  EXPECT_FALSE(says(met, "lower bound"));
  EXPECT_EQ(cells("depth_mm"), (std::vector<std::string>{"", "", ""}));
  EXPECT_EQ(cells("depth_at_vertices_mm"), (std::vector<std::string>{"", "", ""}));
  const std::string report = file_content(path("b.report.html"));
  EXPECT_TRUE(says(report, "<td>not known (open surface)</td>"));
  EXPECT_TRUE(says(report, "<td>not known</td>"));
  const auto depths = [&] {
    const json bite = json::parse(file_content(path("b.json")));
    return std::vector<json>{bite["depth_at_vertices"], bite["fixed"]["depth_at_vertices"],
                             bite["moving"]["depth_at_vertices"]};
  };
  EXPECT_EQ(depths(), std::vector<json>(3, json(nullptr)));
  const std::string answers = ist_well({"collide", lower, upper, "--json"}).out;
  const json line = json::parse(answers.substr(answers.find('\n') + 1));
  EXPECT_EQ(line["touch"], "yes");
  EXPECT_TRUE(line["depth_at_vertices"].is_null());
  asked("0,0,4");
  EXPECT_EQ(depths(), std::vector<json>(3, json(0.0)));
  EXPECT_EQ(cells("depth_at_vertices_mm"), (std::vector<std::string>{"0", "0", "0"}));
}

TEST_F(OcclusionTable, ADecimalCommaHoldsTheSameNumbers) {
  ASSERT_EQ(ask({"--move", "0,0,1.8", "-o", path("p.csv")}).exit_code, 0);
  ASSERT_EQ(ask({"--move", "0,0,1.8", "-o", path("c.csv"), "--decimal", "comma"}).exit_code, 0);
  const CsvRows point = csv_rows(file_content(path("p.csv"))),
                comma = csv_rows(file_content(path("c.csv")), ';');
  ASSERT_EQ(point.size(), comma.size());
  for (std::size_t i = 0; i < point.size(); ++i) {
    for (const auto& [heading, cell] : point[i]) {
      std::string expected = cell;
      if (heading != "name") std::replace(expected.begin(), expected.end(), '.', ',');
      EXPECT_EQ(comma[i].at(heading), expected) << heading;
    }
  }
}

}  // namespace
}  // namespace ist::test
