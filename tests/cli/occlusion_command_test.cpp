#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "cli/occlusion_case.h"
#include "support/effort.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using nlohmann::json;

TEST_F(OcclusionCommand, SaysThreeLinesAndItsContacts) {
  const CommandResult result = ask({"--move", "0,0,1.8", "-o", path("bite.vtp")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 5);
  const CommandResult unnamed = ask({"--move", "0,0,1.8"});
  EXPECT_EQ(unnamed.exit_code, 0) << unnamed.err;
  EXPECT_TRUE(says(unnamed.out, "; nothing written\n"));
  EXPECT_TRUE(says(result.out,
                   "contact      on  area, mm²  least distance, µm  share, %  closest "
                   "at, mm\n      1    both "));
  EXPECT_TRUE(says(result.out, " -200     100.0  ("));
  for (const char* part :
       {"touch yes, ", "(± 0.05 mm assumed for scanning)",
        "areas, scan (intersection and contact of scans: Beck 2023): in each other ",
        "within 100 µm or overlapping ", " without the overlap); 1 contact, 0 of them on one body",
        "overlap above 0.1 mm: check the bite", "unit: mm (assumed)",
        "sides: +x and -x, divided in the middle of the fixed body's box", "wrote ", "bite.vtp"}) {
    EXPECT_TRUE(says(result.out, part));
  }
  const CommandResult apart = ask({"--move", "0,0,2.5", "-o", path("bite.vtp")});
  EXPECT_TRUE(says(apart.out, "touch no, 0.5 mm apart ("));
  EXPECT_TRUE(says(apart.out, "No contacts.\n"));
  EXPECT_FALSE(says(apart.out, "no contacts"));
  EXPECT_FALSE(says(apart.out, "overlap above"));
}

// A cap of height t of a sphere of radius r has the area 2 π r t; the plate's part in the ball is a
// disc of π t (2 r - t).
TEST_F(OcclusionCommand, MeasuresACap) {
  const double t = 0.2, pi = 3.14159265358979;
  const json bite = asked({"--move", "0,0,1.8"});
  EXPECT_EQ(bite["schema"], 1);
  EXPECT_EQ(bite["touch"], "yes");
  EXPECT_LE(bite["depth_lower"], t);
  EXPECT_NEAR(bite["depth_upper"].get<double>(), t, 0.002);
  EXPECT_EQ(bite["fixed"]["areas"][0]["micrometres"], 0);
  EXPECT_NEAR(bite["moving"]["areas"][0]["area"].get<double>(), 2 * pi * 2 * t, 0.03);
  EXPECT_NEAR(bite["fixed"]["areas"][0]["area"].get<double>(), pi * t * (4 - t), 0.03);
  EXPECT_NEAR(bite["moving"]["areas"][1]["area"].get<double>(), 2 * pi * 2 * (t + 0.1), 0.03);
  // ∫ depth over the cap: 2 π r t² / 2.
  EXPECT_NEAR(bite["moving"]["depth_integral"].get<double>(), 2 * pi * t * t, 0.01);
  ASSERT_EQ(bite["moving"]["regions"].size(), 1u);
  EXPECT_EQ(bite["moving"]["regions"][0]["partner"], 0);
  EXPECT_EQ(bite["moving"]["regions"][0]["share"], 1);
  EXPECT_EQ(bite["moving"]["regions"][0]["contact"], 1);
  // Without the overlap a ring of the cap is left: 2 π r · 0.1.
  EXPECT_NEAR(bite["moving"]["areas"][1]["area_outside"].get<double>(), 2 * pi * 2 * 0.1, 0.03);
  EXPECT_EQ(bite["moving"]["areas"][0]["area_outside"], 0);
  EXPECT_NEAR(bite["moving"]["sides"]["per_cent"]["+x"].get<double>(), 50, 1);
  EXPECT_TRUE(bite["caveat"].get<std::string>().starts_with("Research software, not a medical"));
  EXPECT_EQ(bite["moving"]["file"], "ball.stl");
  EXPECT_EQ(bite["unit_assumed"], true);
}

TEST_F(OcclusionCommand, Lengths_HaveFourDigitsAndNoExponent) {
  for (const char* apart : {"130", "1450"}) {
    const std::string said = ask({"--move", fmt::format("0,0,{}", std::stoi(apart) + 2)}).out;
    EXPECT_TRUE(says(said, fmt::format("The scans are {} mm apart: they", apart)));
    EXPECT_TRUE(says(said, fmt::format("touch no, {} mm apart (", apart)));
    EXPECT_FALSE(says(said, "e+"));
  }
  const std::string plate = mesh("plate_um.stl", box({-5000, -5000, -3000}, {5000, 5000, 0}));
  const std::string ball = mesh("ball_um.stl", icosphere(4, 2000));
  const auto text = [&](const std::string& fixed, const std::string& moving, const char* unit,
                        const char* move) {
    const std::string said =
        ist_well({"occlusion", fixed, moving, "--unit", unit, "--move", move}).out;
    return said.substr(0, said.find("; 1 contact"));
  };
  const std::string in_mm = text(plate_, ball_, "mm", "0,0,1.8");
  EXPECT_EQ(text(plate, ball, "um", "0,0,1800"), in_mm);
  EXPECT_TRUE(says(in_mm, " mm deep (± 0.05 mm assumed for scanning)"));
  EXPECT_TRUE(says(in_mm, " mm²"));
}

TEST_F(OcclusionCommand, OverlapOfMoreThan2mm_IsWarnedOf) {
  const std::string block = mesh("block.stl", box({-5, -5, -9}, {5, 5, 0}));
  const std::string said = ist_well({"occlusion", block, ball_, "--move", "0,0,-0.5"}).out;
  EXPECT_TRUE(says(said, "The scans overlap by 2.")) << said;
  EXPECT_TRUE(says(said, " mm, more than a bite does: check that they are the upper"));
  EXPECT_EQ(asked({"--move", "0,0,0.1"})["warning"], nullptr);
}

TEST_F(OcclusionCommand, ReportEnding_CountsInAnyCase) {
  const CommandResult result = ask({"-o", path("X.REPORT.HTML")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_FALSE(says(result.err, "static report")) << result.err;
  EXPECT_TRUE(says(file_content(path("X.REPORT.HTML")), "id=\"findings\""));
}

// A box with one of two balls in it: all is as if the other were not there.
TEST_F(OcclusionCommand, ARegionLeavesOutWhatLiesBesideIt) {
  TriangleMesh floor;
  for (int x = -5; x < 5; ++x) {
    for (int y = -5; y < 5; ++y) {
      const auto at = static_cast<std::uint32_t>(floor.vertices.size());
      for (const auto& [i, k] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
        floor.vertices.emplace_back(x + i, y + k, 0);
      }
      floor.triangles.push_back({at, at + 1, at + 2});
      floor.triangles.push_back({at, at + 2, at + 3});
    }
  }
  const TriangleMesh left = moved(icosphere(4, 1), {-3, 0, 0});
  const std::string sheet = mesh("sheet.stl", floor), one = mesh("one.stl", left),
                    two = mesh("two.stl", joined(left, moved(icosphere(4, 1), {3, 0, -0.1})));
  const auto asked = [&](const std::string& moving, std::vector<std::string> more) {
    std::vector<std::string> words{"occlusion", sheet, moving, "--move", "0,0,0.9", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return json_lines(ist_well(words).out).at(0);
  };
  const std::vector<std::string> within{"--region", "-6,-6,9,0,6,-9"};
  const json whole = asked(two, {}), part = asked(two, within), alone = asked(one, {});
  EXPECT_EQ(whole["contacts"].size(), 2U);
  EXPECT_EQ(whole["region"], nullptr);
  ASSERT_EQ(part["contacts"].size(), 1U);
  EXPECT_EQ(part["region"], json({-6.0, -6.0, -9.0, 0.0, 6.0, 9.0}));
  EXPECT_EQ(part["contacts"], alone["contacts"]);
  for (const char* role : {"fixed", "moving"}) {
    for (const char* key : {"areas", "penetrating_area", "depth_at_vertices", "depth_integral"}) {
      EXPECT_EQ(part[role][key], alone[role][key]) << role << " " << key;
    }
  }
  // The fixed body's box within the region is split, not the whole box.
  EXPECT_EQ(whole["sides"]["at"], 0);
  EXPECT_EQ(part["sides"]["at"], -2.5);
  EXPECT_EQ(part["fore_aft"]["at"], 0);
  EXPECT_GT(part["moving"]["sides"]["per_cent"]["-x"], 50);
  EXPECT_NEAR(whole["depth_point"][0].get<double>(), 3, 0.5);
  EXPECT_NEAR(part["depth_point"][0].get<double>(), -3, 0.5);
  EXPECT_LT(part["depth_at_vertices"], whole["depth_at_vertices"]);
  EXPECT_TRUE(says(ist_well({"occlusion", sheet, two, "--region", within[1]}).out,
                   "region: areas, contacts, shares, depths of vertices and the deepest point are "
                   "of the triangles with their centroid in x -6 to 0, y -6 to 6, z -9 to 9; all "
                   "else is of the whole bodies\n"));
  EXPECT_TRUE(says(ist_well({"occlusion", sheet, two, "--region", within[1]}).out,
                   "divided in the middle of the fixed body's box within the region (assumed)"));
  // Files for viewers say it too.
  for (const char* name : {"region.ply", "region.glb"}) {
    ist_well({"occlusion", sheet, two, "--region", within[1], "-o", path(name)});
    EXPECT_TRUE(says(file_content(path(name)), "region: areas, contacts, shares")) << name;
  }
  for (const char* bad : {"1,2,3,4,5", "1,2,3,4,5,x", "1,2,3,4,5,6,7"}) {
    refuses({"--json", "--region", bad}, 2, "give x0,y0,z0,x1,y1,z1, two corners of a box");
  }
  refuses({"--json", "--region", "0,0,0,1,0,1"}, 2, "the box is empty: its corners must differ");
  refuses(
      {"--json", "--region", "50,50,50,60,60,60"}, 2,
      "no triangle of plate.stl has its centroid in x 50 to 60, y 50 to 60, z 50 to 60: the body "
      "lies in x -5 to 5, y -5 to 5, z -3 to 0");
}

TEST_F(OcclusionCommand, WritesBothBodiesWhereTheyBite) {
  ASSERT_EQ(ask({"--move", "0,0,2.05", "-o", path("b.ply")}).exit_code, 0);
  const PlyFile ply = parse_ply(file_content(path("b.ply")));
  std::string names;
  for (const auto& [kind, name] : ply.properties) names += kind + " " + name + ", ";
  EXPECT_EQ(names,
            "float x, float y, float z, uchar red, uchar green, uchar blue, float signed, uchar "
            "body, ");
  std::size_t moving = 0, unknown = 0;
  for (const auto& v : ply.vertices) {
    const double signed_distance = v.at("signed");
    if (v.at("body") == 1) {
      ++moving;
      // Of the ball, the distance from the plate is the height.
      EXPECT_TRUE(std::isnan(signed_distance) || std::abs(signed_distance - v.at("z")) <= 1e-5);
      EXPECT_EQ(std::isnan(signed_distance), v.at("z") > 2);
    }
    unknown += std::isnan(signed_distance) ? 1U : 0U;
  }
  EXPECT_EQ(moving, icosphere(4, 2).vertices.size());
  EXPECT_GT(unknown, 0u);
  ASSERT_EQ(ask({"--side", "fixed", "-o", path("f.ply")}).exit_code, 0);
  EXPECT_EQ(parse_ply(file_content(path("f.ply"))).vertices.size(), 8u);
}

TEST_F(OcclusionCommand, WritesEveryFormatAtOnce) {
  std::vector<std::string> arguments{"--move", "0,0,1.8"};
  for (const char* ending : {"vtp", "ply", "glb", "csv", "json", "html"}) {
    arguments.insert(arguments.end(), {"-o", path(std::string("bite.") + ending)});
  }
  ASSERT_EQ(ask(arguments).exit_code, 0);
  EXPECT_TRUE(says(file_content(path("bite.vtp")), "Name=\"SignKnown\""));
  EXPECT_TRUE(says(file_content(path("bite.glb")), "\"name\":\"ball.stl\""));
  const std::string html = file_content(path("bite.html"));
  EXPECT_TRUE(says(html, "ball.stl"));
  EXPECT_FALSE(says(html, "<script"));
  EXPECT_FALSE(says(html, dir_.path().string()));
  const json written = json::parse(file_content(path("bite.json")));
  EXPECT_EQ(written, asked({"--move", "0,0,1.8"}));
}

// Opened, no body reaches beyond its half, and what faced the other body faces one way.
TEST_F(OcclusionCommand, OpensLikeABook) {
  ASSERT_EQ(ask({"--move", "0,0,1.9", "--open", "3", "-o", path("b.ply")}).exit_code, 0);
  double highest_fixed = -1e9, lowest_moving = 1e9;
  Eigen::Vector3d nearest(0, 0, 0);  // of the ball, to the plate
  double least = 1e9, facing_fixed = 0;
  for (const auto& v : parse_ply(file_content(path("b.ply"))).vertices) {
    const Eigen::Vector3d at(v.at("x"), v.at("y"), v.at("z"));
    const bool moving = v.at("body") == 1;
    if (!moving) highest_fixed = std::max(highest_fixed, at[2]);
    if (!moving) facing_fixed = std::max(facing_fixed, std::abs(at[0]));
    if (moving) lowest_moving = std::min(lowest_moving, at[2]);
    if (!moving || !(v.at("signed") < least)) continue;
    least = v.at("signed");
    nearest = at;
  }
  EXPECT_NEAR(lowest_moving - highest_fixed, 3, 1e-5);
  // The hinge is y, so they face +x or -x: the ball's lowest vertex is its farthest that way.
  EXPECT_NEAR(std::abs(nearest[0]), 2, 1e-5);
  EXPECT_NEAR(facing_fixed, 1.5, 1e-5);  // the plate stands on its edge
  // Both look the same way with what faced the other.
  ist_well({"occlusion", ball_, ball_, "--move", "0,0,3.9", "--open", "3", "-o", path("b.ply")});
  std::array<double, 2> least_of{1e9, 1e9}, facing{};
  for (const auto& v : parse_ply(file_content(path("b.ply"))).vertices) {
    const auto body = static_cast<std::size_t>(v.at("body"));
    if (!(v.at("signed") < least_of[body])) continue;
    least_of[body] = v.at("signed");
    facing[body] = v.at("x");
  }
  EXPECT_GT(std::abs(facing[0]), 1.9);
  EXPECT_NEAR(facing[0], facing[1], 0.05);
  refuses({"--open", "3", "-o", path("b.vtp")}, 2, "goes with .ply and .glb");
  refuses({"--open", "-1", "-o", path("b.ply")}, 2, "--open");
}

TEST_F(OcclusionCommand, NamesNothingThatItWasNotTold) {
  const auto words = [&](std::vector<std::string> more) { return asked(std::move(more)).dump(); };
  for (const char* word : {"left", "right", "anterior", "posterior"}) {
    EXPECT_FALSE(says(words({"--move", "0,0,1.8"}), word)) << word;
    EXPECT_TRUE(says(words({"--move", "0,0,1.8", "--frame", "lps"}), word)) << word;
  }
  const json lps = asked({"--move", "2,0,1.8", "--frame", "lps"}),
             ras = asked({"--move", "2,0,1.8", "--frame", "ras"}),
             left = asked({"--move", "2,0,1.8", "--left", "0,3,0", "--midline", "0,9,0"});
  EXPECT_EQ(lps["moving"]["sides"]["per_cent"]["left"], 100);
  EXPECT_EQ(ras["moving"]["sides"]["per_cent"]["right"], 100);
  EXPECT_EQ(left["moving"]["sides"]["per_cent"]["right"], 100);
  EXPECT_EQ(left["moving"]["sides"]["per_cent"]["asymmetry"], 100);
  EXPECT_EQ(left["sides"]["assumed"], false);
  EXPECT_EQ(lps["sides"]["assumed"], true);
  const std::string anonymous = words({"--move", "0,0,1.8", "--no-names"});
  EXPECT_FALSE(says(anonymous, "ball"));
  EXPECT_FALSE(says(anonymous, "plate"));
}

TEST_F(OcclusionCommand, TeethAreToldByTheirNumbers) {
  IST_SLOW();
  std::string labels;
  for (std::size_t i = 0; i < icosphere(4, 2).triangles.size(); ++i) labels += "36\n";
  const std::string file = write("labels.txt", labels);
  const json bite = asked({"--move", "0,0,1.8", "--labels-moving", file, "--numbering", "fdi"});
  EXPECT_EQ(bite["numbering"], "fdi");
  ASSERT_EQ(bite["moving"]["teeth"].size(), 1u);
  EXPECT_EQ(bite["moving"]["teeth"][0]["number"], 36);
  EXPECT_NEAR(bite["moving"]["teeth"][0]["share"].get<double>(), 1, 1e-12);
  EXPECT_TRUE(bite["fixed"]["teeth"].empty());
  refuses({"--labels-moving", file, "--json"}, 2, "--numbering");
  refuses({"--labels-moving", file, "--numbering", "universal", "--json"}, 3, "labels.txt");
  refuses({"--labels-fixed", file, "--numbering", "fdi", "--json"}, 3, "labels.txt");
  refuses({"--numbering", "fdi", "--json"}, 2, "--labels-fixed");
}

// Which would end after seconds, with another error.
TEST_F(OcclusionCommand, LabelsAreReadBeforeAnythingIsMeasured) {
  const std::string lower = mesh("lower.stl", box({0, 0, 0}, {999, 999, 10}));
  const std::string upper = mesh("upper.stl", box({0, 0, 10}, {999, 999, 20}));
  const CommandResult result = ist({"occlusion", lower, upper, "--labels-moving",
                                    write("labels.txt", "36\n"), "--numbering", "fdi", "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(says(result.err, "labels.txt: 1 label for a mesh of 12 triangles"));
}

TEST_F(OcclusionCommand, AnOpenBodyAndAFarOneAreSaid) {
  TriangleMesh open = box({-5, -5, -3}, {5, 5, 0});
  open.triangles.resize(10);
  const std::string shell = mesh("shell.stl", open);
  const CommandResult result =
      ist_well({"occlusion", shell, ball_, "--move", "0,0,1.8", "-o", path("b.csv")});
  EXPECT_TRUE(says(result.out, "depth is a lower bound, measured at vertices: shell.stl is open"));
  const CommandResult far = ask({"--move", "0,0,50", "-o", path("b.csv")});
  EXPECT_EQ(far.exit_code, 0);
  EXPECT_TRUE(says(far.out, "the map is empty: nothing lies within the reach of 2 mm"));
  EXPECT_TRUE(says(far.out,
                   "The scans are 48 mm apart: they are probably not in one coordinate "
                   "system. Register them first, or give --matrix.\n"));
  EXPECT_TRUE(says(far.out, "No contacts.\n"));
  const CsvRows rows = csv_rows(file_content(path("b.csv")));
  EXPECT_TRUE(only(rows, {{"kind", "region"}}).empty());
  EXPECT_EQ(only(rows, {{"kind", "total"}, {"body", "both"}}).at(0)["least_distance_um"], "48000");
}

// Two open sheets that lie in each other and cross nowhere: nobody can tell overlap from a gap.
TEST_F(OcclusionCommand, OpenSheetsMayOverlapWithoutTouching) {
  TriangleMesh sheet;
  for (std::uint32_t i = 0; i < 121; ++i) {
    sheet.vertices.emplace_back(i % 11 - 5.0, i / 11 - 5.0, 0);
    if (i % 11 == 10 || i >= 110) continue;
    sheet.triangles.push_back({i, i + 1, i + 12});
    sheet.triangles.push_back({i, i + 12, i + 11});
  }
  TriangleMesh down = sheet;
  for (Triangle& t : down.triangles) std::swap(t[1], t[2]);
  const std::string lower = mesh("lower.stl", sheet), upper = mesh("upper.stl", down);
  const auto lines =
      json_lines(ist_well({"occlusion", lower, upper, "--move", "0,0,-0.1", "--json"}).out);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["touch"], "no");
  EXPECT_TRUE(lines[0]["inside"].is_null() && lines[0]["depth_lower"].is_null());
  EXPECT_NEAR(lines[0]["depth_at_vertices"].get<double>(), 0.1, 1e-6);
  const std::string said =
      ist_well({"occlusion", lower, upper, "--move", "0,0,-0.15", "-o", path("s.csv")}).out;
  EXPECT_TRUE(says(said, "apart, or at least 0.15 mm deep (open surface, by vertices)"));
  EXPECT_TRUE(says(said, "apart, or in each other: a part lies behind an open surface"));
  EXPECT_TRUE(says(said, "overlap above 0.1 mm"));
  EXPECT_EQ(ist({"occlusion", lower, upper, "--move", "0,0,-0.15", "-o", path("s.csv"),
                 "--fail-if-touching"})
                .exit_code,
            1);
}

TEST_F(OcclusionCommand, ABodyInTheOtherIsToldWithNumbers) {
  const CommandResult inside = ask({"--move", "0,0,-1.5", "-o", path("b.csv")});
  EXPECT_TRUE(says(inside.out, "touch yes"));
  const std::string small = mesh("small.stl", icosphere(2, 1));
  const CommandResult whole = ist({"occlusion", plate_, small, "--move", "0,0,-1.5", "-o",
                                   path("b.csv"), "--fail-if-touching"});
  EXPECT_EQ(whole.exit_code, 6);
  EXPECT_TRUE(says(whole.out,
                   "touch no, the moving body lies inside the other, 0.5 mm apart, 1.5 mm deep ("));
  EXPECT_FALSE(says(whole.out, "the map is empty"));
}

// All files or none: a disk that is full at the last leaves the older one of the first.
TEST_F(OcclusionCommand, FilesAreCompletedTogether) {
  if (!std::filesystem::exists("/dev/full")) IST_SKIP("/dev/full is not there");
  const std::string older = write("b.csv", "older");
  std::filesystem::create_symlink("/dev/full", path("full.vtp"));
  const CommandResult result = ask({"-o", older, "-o", path("full.vtp")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, "full.vtp: cannot write"));
  EXPECT_EQ(file_content(older), "older");
  EXPECT_EQ(dir_.entries(), 4u);
}

// The disk fails when the first file is stored already.
TEST_F(OcclusionCommand, ADiskThatFailsAtTheSecondFileLeavesBothOlderOnes) {
  const std::string table = write("b.csv", "older"), map = write("b.vtp", "older");
  const std::size_t before = dir_.entries();
  const CommandResult result =
      with_failing_call("fsync", 1, {"occlusion", plate_, ball_, "-o", table, "-o", map});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(says(result.err, "b.vtp: cannot write the file: Input/output error"));
  EXPECT_EQ(file_content(table), "older");
  EXPECT_EQ(file_content(map), "older");
  EXPECT_EQ(dir_.entries(), before);
}

// In every file that has a place for it.
TEST_F(OcclusionCommand, FilesTellTheirUnit) {
  ASSERT_EQ(ask({"--move", "0,0,1.8", "-o", path("b.vtp"), "-o", path("b.ply"), "-o", path("b.glb"),
                 "-o", path("b.csv"), "-o", path("b.html")})
                .exit_code,
            0);
  EXPECT_TRUE(says(file_content(path("b.vtp")), "Name=\"Unit\""));
  EXPECT_TRUE(says(file_content(path("b.ply")), "comment unit: mm (assumed)\n"));
  EXPECT_TRUE(says(file_content(path("b.glb")), "\"Unit\":\"mm (assumed)\""));
  EXPECT_EQ(only(csv_rows(file_content(path("b.csv"))), {{"name", "unit: mm (assumed)"}}).size(),
            1U);
  EXPECT_TRUE(says(file_content(path("b.html")), "assumed"));
  // One tree's unit says nothing of the other body.
  const std::string tree = path("plate.ist");
  ist_well({"build", plate_, "-o", tree, "--voxel-size", "0.2", "--unit", "mm"});
  const auto of = [&](const std::string& moving) {
    return json_lines(ist_well({"occlusion", tree, moving, "--json"}).out).at(0)["unit_assumed"];
  };
  EXPECT_EQ(of(ball_), true);
  EXPECT_EQ(of(tree), false);
}

// The header tells the unit that is taken, and no voxel size that nobody asked for.
TEST_F(OcclusionCommand, TheFirstLineTellsTheUnit) {
  const std::string tree = path("plate.ist");
  ist_well({"build", plate_, "-o", tree, "--voxel-size", "0.2", "--unit", "mm"});
  const auto header = [&](const std::string& fixed, std::vector<std::string> more) {
    std::vector<std::string> words{"occlusion", fixed, fixed, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const std::string out = ist_well(words).out;
    return json::parse(out.substr(0, out.find('\n')));
  };
  const json assumed = header(plate_, {}),
             named = header(plate_, {"--unit", "inch", "--move", "0,0,5"}),
             stored = header(tree, {});
  EXPECT_EQ(assumed["unit"], "mm");
  EXPECT_EQ(assumed["unit_assumed"], true);
  EXPECT_EQ(assumed["voxel_size"], (json{nullptr, nullptr}));
  EXPECT_EQ(named["unit"], "inch");
  EXPECT_EQ(named["unit_assumed"], false);
  EXPECT_EQ(stored["unit"], "mm");
  EXPECT_EQ(stored["unit_assumed"], false);
  EXPECT_EQ(stored["voxel_size"], (json{0.2, 0.2}));
}

TEST_F(OcclusionCommand, FlatMeshesAndStrangeSizesAreRefused) {
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  const CommandResult result =
      ist({"occlusion", mesh("flat.stl", flat), ball_, "-o", path("b.vtp")});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_TRUE(says(result.err, ": the mesh is flat"));
  EXPECT_FALSE(exists("b.vtp"));
  refuses({"--unit", "m", "--json"}, 2, "jaws are 1 to 1000");
  refuses({"--unit", "um", "--json"}, 2, "--unit");
}

// In inches, presets are still micrometres.
TEST_F(OcclusionCommand, UnitsAreSaidAndPresetsKeepTheirs) {
  IST_SLOW();
  const json mm = asked({"--move", "0,0,1.8", "--unit", "mm"}),
             inch = asked({"--move", "0,0,1.8", "--unit", "inch"});
  EXPECT_EQ(mm["unit_assumed"], false);
  EXPECT_EQ(inch["unit"], "inch");
  EXPECT_NEAR(inch["reach"].get<double>(), 2 / 25.4, 1e-12);
  EXPECT_LT(inch["moving"]["areas"][1]["area"], mm["moving"]["areas"][1]["area"]);
  const std::string tree = path("plate.ist");
  ist_well({"build", plate_, "-o", tree, "--voxel-size", "0.2", "--unit", "inch"});
  EXPECT_EQ(ist({"occlusion", tree, ball_, "--unit", "mm", "--json"}).exit_code, 2);
}

TEST_F(OcclusionCommand, BadWordsAreRefused) {
  refuses({"-o", path("b.stl")}, 2, ".vtp");
  refuses({"-o", ball_ + ".vtp", "--preset", "nonsense"}, 2, "--preset");
  for (const char* reach : {"0", "-1", "nan", "inf"}) {
    refuses({"--json", "--reach", reach}, 2, "--reach");
  }
  refuses({"--json", "--scanner-band", "-1"}, 2, "--scanner-band");
  refuses({"--json", "--left", "0,0,0"}, 2, "no direction");
  refuses({"--json", "--left", "1,0"}, 2, "give x,y,z");
  refuses({"--json", "--left", "1,0,0", "--frame", "lps"}, 2, "contradicts");
  refuses({"--json", "--left", "1,0,0", "--front", "2,0,0"}, 2, "--front");
  refuses({"--json", "--reach", "0.05"}, 2, "largest limit");
  refuses({"-o", path("b.csv"), "-o", path("b.csv")}, 2, "named twice");
  refuses({"-o", path("b.csv"), "-o", path("./b.csv")}, 2, "named twice");
  write("b.csv", "older");
  std::filesystem::create_symlink("b.csv", path("link.csv"));
  refuses({"-o", path("b.csv"), "-o", path("link.csv")}, 2, "named twice");
  refuses({"-o", path("b.csv"), "-o", path("none/b.vtp")}, 1, "none/b.vtp");
  refuses({"-o", path("c.csv"), "--decimal", "point,"}, 2, "--decimal");
  refuses({"-o", path("c.vtp"), "--decimal", "comma"}, 2, "--decimal: goes with .csv");
  refuses({"--side", "fixed", "-o", path("b.csv")}, 2, "--side");
  const std::string input = write("plate.ply", file_content(plate_));
  EXPECT_EQ(ist({"occlusion", input, ball_, "-o", input}).exit_code, 2);
  EXPECT_EQ(file_content(input), file_content(plate_));
  const std::string bare = path("bare.ist");
  ist_well({"build", plate_, "-o", bare, "--voxel-size", "0.5", "--no-triangles"});
  const CommandResult result = ist({"occlusion", bare, ball_, "--json"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(says(result.err, "--no-triangles"));
}

}  // namespace
}  // namespace ist::test
