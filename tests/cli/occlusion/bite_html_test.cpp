#include "cli/occlusion/bite_html.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/bite_numbers.h"
#include "answers/occlusion/map_colours.h"
#include "cli/occlusion/bite_view.h"
#include "cli/occlusion/bites.h"
#include "cli/occlusion/map_picture.h"
#include "support/effort.h"
#include "support/errors.h"
#include "support/run_command.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::Bite, answers::BiteBody, answers::Colour;
using nlohmann::json;
using Cells = std::vector<std::string>;
using Rows = std::vector<Cells>;

// A page, and what is in it.
struct Page {
  explicit Page(const Bite& bite) {
    const auto file = dir.path() / "bite.html";
    cli::write_bite_html(bite, file);
    const CommandResult read = run_command("/usr/bin/python3", {IST_READ_HTML, file, dir.path()});
    if (read.exit_code != 0) throw std::runtime_error(read.err);
    content = json::parse(read.out);
  }
  [[nodiscard]] Rows table(const char* id) const { return content["tables"].value(id, Rows{}); }
  [[nodiscard]] std::string text() const { return content["text"]; }
  [[nodiscard]] bool says(const std::string& part) const { return text().find(part) != part.npos; }
  [[nodiscard]] bool holds(const char* pattern) const {
    return std::regex_search(content["all"].get<std::string>(),
                             std::regex(pattern, std::regex::icase));
  }
  [[nodiscard]] cli::Picture picture(int i) const {
    return decoded(file_content(dir.path() / (std::to_string(i) + ".png")));
  }

  const TempDir dir;
  json content;
};

// The numbers of a cell, in order.
std::vector<double> numbers_in(const std::string& cell) {
  std::vector<double> numbers;
  static const std::regex kNumber(R"([-+]?\d+(\.\d+)?(e[-+]?\d+)?)");
  for (std::sregex_iterator at(cell.begin(), cell.end(), kNumber), end; at != end; ++at) {
    numbers.push_back(std::stod(at->str()));
  }
  return numbers;
}

void expect_numbers(const std::string& cell, const std::vector<double>& expected, double error) {
  const std::vector<double> found = numbers_in(cell);
  ASSERT_EQ(found.size(), expected.size()) << cell;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], error) << cell;
}

void expect_place(const std::string& cell, const Eigen::Vector3d& at) {
  expect_numbers(cell, {at.x(), at.y(), at.z()}, 0.0051);
}

// The row that begins so; empty without one.
Cells row_of(const Rows& rows, const Cells& begin) {
  for (const Cells& row : rows) {
    if (row.size() >= begin.size() && std::equal(begin.begin(), begin.end(), row.begin())) {
      return row;
    }
  }
  return {};
}

// The cell of the row that begins so, under a heading.
std::string cell(const Rows& table, const Cells& begin, const std::string& heading) {
  const Cells row = row_of(table, begin);
  if (row.empty()) return "no row";
  const Cells& head = table.front();
  EXPECT_EQ(row.size(), head.size());
  EXPECT_EQ(std::count(head.begin(), head.end(), heading), 1) << heading;
  return row.at(
      static_cast<std::size_t>(std::find(head.begin(), head.end(), heading) - head.begin()));
}

// A plate under two spheres, turned a little, with all that a bite may have.
std::unique_ptr<MadeBite> full_bite() {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.translation() = Eigen::Vector3d(0.3, -0.7, 3.9);
  auto made =
      bite_of(plate(10, 0.25), joined(icosphere(4, 4), moved(icosphere(4, 2), {-6, 2.5, -2.33})),
              pose, "biteeye");
  Bite& bite = made->bite;
  bite.made_by = "ist 1.2, commit 34";
  bite.checks = {"overlap above 0.1 mm: check the bite registration", "a < b & c"};
  bite.unit_assumed = true;
  bite.findings.triangle_pairs = 1234;
  bite.findings.depth.certain = DistanceInterval{0.123, 0.124};
  bite.findings.depth.area = 2.75;
  bite.findings.depth.point = Eigen::Vector3d(1.5, -2.25, 3.125);
  bite.findings.contacts = 17;
  bite.findings.contact_depth = 0.0456;
  bite.findings.notes = {"a note for people"};
  bite.numbers = answers::ToothNumbers::kFdi;
  answers::ToothLabels labels;
  for (const Triangle& t : bite.fixed.mesh->triangles) {
    const double x = bite.fixed.mesh->vertices[t[0]].x();
    labels.push_back(x > 0 ? 36 : x > -3 ? 0 : 46);
  }
  bite.fixed.teeth = answers::teeth_of(bite.fixed.surface, *bite.fixed.mesh, labels);
  return made;
}

// One of them and its page, for tests that change neither.
struct Shown {
  const std::unique_ptr<const MadeBite> made = full_bite();
  const Page page{made->bite};
};
const Shown& shown() {
  static const Shown kShown;
  return kShown;
}

TEST(BiteHtml, HasNoScriptAndRefersToNothingOutside) {
  const Page& page = shown().page;
  EXPECT_EQ(page.content["outside"], json::array());
  for (const char* element : {"script", "link", "iframe", "object", "a", "form"}) {
    EXPECT_FALSE(page.content["elements"].contains(element)) << element;
  }
  EXPECT_FALSE(page.holds("https?:|javascript"));
}

TEST(BiteHtml, HoldsTheContactsByTheirNumbers) {
  const auto made = full_bite();
  Bite& bite = made->bite;
  ASSERT_EQ(bite.contacts.size(), 2U);
  ContactRegion alone = bite.moving.surface.regions.at(1);
  alone.faces.reset();
  alone.area = 0.5;
  bite.moving.surface.regions.push_back(alone);
  bite.number_contacts();
  const Page page(bite);
  for (std::size_t i = 0; i < bite.contacts.size(); ++i) {
    const answers::BiteContact& contact = bite.contacts[i];
    const auto in = [&](const char* heading) {
      return cell(page.table(i < 2 ? "contacts" : "contacts-on-one"), {std::to_string(i + 1)},
                  heading);
    };
    if (i < 2) {
      const auto area = [](const BiteBody& body, std::uint32_t region) {
        return std::vector<double>{body.surface.regions[region].area};
      };
      expect_numbers(in("fixed area, mm²"), area(bite.fixed, contact.fixed.at(0)), 0.05);
      expect_numbers(in("moving area, mm²"), area(bite.moving, contact.moving.at(0)), 0.05);
    } else {
      EXPECT_EQ(in("fixed area, mm²"), "–");
      EXPECT_EQ(in("moving area, mm²"), "0.50");
    }
    expect_numbers(in("share, %"),
                   {100 * contact.share, 100 * contact.share_thinner, 100 * contact.share_thicker},
                   0.05);
    expect_numbers(in("least distance, µm"), {1000 * contact.least_distance}, 0.5);
    expect_numbers(in("overlap, mm²"), {contact.penetrating_area}, 0.05);
    expect_numbers(in("depth, integrated, mm³"), {contact.depth_integral}, 0.005);
    expect_place(in("centre, mm"), contact.centre);
    expect_place(in("closest point, mm"), contact.closest);
  }
  EXPECT_EQ(page.table("contacts").size(), 3U);
  EXPECT_EQ(page.table("contacts-on-one").size(), 2U);
  EXPECT_TRUE(page.says(answers::kSharesOnOneBody));
}

// A number stands in both pictures where its contact is closest.
TEST(BiteHtml, BothPicturesCallAContactByOneNumber) {
  const auto made = full_bite();
  Bite& bite = made->bite;
  // Regions in another order than those of the other body.
  std::swap(bite.moving.surface.regions[0], bite.moving.surface.regions[1]);
  for (ContactRegion& region : bite.fixed.surface.regions) region.faces = 1 - *region.faces;
  bite.number_contacts();
  ASSERT_EQ(bite.fixed.contacts, (std::vector<std::size_t>{1, 2}));
  ASSERT_EQ(bite.moving.contacts, (std::vector<std::size_t>{2, 1}));
  const Page page(bite);
  const cli::BiteViews views = cli::bite_views(bite, 900, 700);
  for (const bool is_fixed : {true, false}) {
    const BiteBody& body = is_fixed ? bite.fixed : bite.moving;
    for (std::size_t k = 0; k < body.contacts.size(); ++k) {
      const Eigen::Vector2d place = cli::place_in(is_fixed ? views.fixed : views.moving, 900, 700,
                                                  body.surface.regions[k].closest);
      const std::string drawn =
          fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"start\">{}</text>",
                      place.x() + 5, place.y() - 4, body.contacts[k]);
      EXPECT_NE(page.content["all"].get<std::string>().find(drawn), std::string::npos) << drawn;
    }
  }
}

TEST(BiteHtml, HoldsAreasAndDepths) {
  const auto& [made, page] = shown();
  const BiteBody &fixed = made->bite.fixed, &moving = made->bite.moving;
  const Rows areas = page.table("areas");
  const auto expect = [&](const std::string& head, double a, double b) {
    expect_numbers(cell(areas, {head}, "fixed, mm²"), {a}, 0.05);
    expect_numbers(cell(areas, {head}, "moving, mm²"), {b}, 0.05);
  };
  const std::string below = ": below the error assumed for scanning";
  const double over_fixed = fixed.surface.penetrating_area,
               over_moving = moving.surface.penetrating_area;
  expect("overlap", over_fixed, over_moving);
  expect("within 9 µm or overlapping" + below, fixed.areas[0], moving.areas[0]);
  expect("within 29 µm or overlapping" + below, fixed.areas[1], moving.areas[1]);
  expect("within 59 µm or overlapping", fixed.areas[2], moving.areas[2]);
  expect("within 149 µm or overlapping", fixed.areas[4], moving.areas[4]);
  expect("within 9 µm, without the overlap" + below, fixed.areas[0] - over_fixed,
         moving.areas[0] - over_moving);
  expect("within 149 µm, without the overlap", fixed.areas[4] - over_fixed,
         moving.areas[4] - over_moving);
  EXPECT_LT(fixed.areas[0], fixed.areas[4]);
  for (const auto& [body, role] : {std::pair(&fixed, "fixed"), {&moving, "moving"}}) {
    const auto in = [&, role = role](const char* heading) {
      return cell(page.table("depths"), {role}, heading);
    };
    expect_numbers(in("depth of the deepest vertex, µm"), {1000 * body->surface.depth_at_vertices},
                   0.5);
    expect_numbers(in("depth, integrated over the overlap (no volume), mm³"),
                   {body->surface.depth_integral}, 0.005);
  }
}

TEST(BiteHtml, HoldsTheFindings) {
  const auto& [made, page] = shown();
  const Rows rows = page.table("findings");
  const auto answer = [&](const char* question) { return cell(rows, {question}, "answer"); };
  EXPECT_EQ(answer("do the surfaces touch"), "yes");
  EXPECT_EQ(answer("pairs of triangles that intersect"), "1234");
  EXPECT_EQ(answer("distance of the surfaces"), "0 µm");
  EXPECT_EQ(answer("penetration depth"), "123 µm to 124 µm");
  expect_numbers(answer("depth of the deepest vertex"),
                 {1000 * *made->bite.findings.depth.at_vertices}, 0.5);
  EXPECT_EQ(answer("area inside the other body, mean of both"), "2.75 mm²");
  EXPECT_EQ(answer("deepest point"), "(1.5, -2.25, 3.13) mm");
  EXPECT_EQ(answer("note"), "a note for people");
  EXPECT_EQ(rows.size(), 9U)
      << "of contact points, which are as coarse as voxels, it tells nothing";
}

TEST(BiteHtml, HoldsSharesBySideAndByTooth) {
  const std::unique_ptr<const MadeBite>& made = shown().made;
  const Page& page = shown().page;
  const auto expect = [&](const char* head, const answers::Balance& balance) {
    const auto in = [&](const char* heading) {
      return cell(page.table("shares"), {head}, heading);
    };
    const auto of = [&](auto member) {
      return std::vector<double>{balance.shares.*member, balance.thinner.*member,
                                 balance.thicker.*member};
    };
    expect_numbers(in("first side, %").substr(3), of(&answers::Balance::Shares::first), 0.05);
    expect_numbers(in("second side, %").substr(3), of(&answers::Balance::Shares::second), 0.05);
    expect_numbers(in("asymmetry, %"), of(&answers::Balance::Shares::asymmetry), 0.05);
    expect_place(in("centre, mm"), balance.centre);
  };
  expect("fixed: +x and -x", *made->bite.fixed.sides);
  expect("fixed: +y and -y", *made->bite.fixed.fore_aft);
  expect("moving: +x and -x", *made->bite.moving.sides);
  expect("moving: +y and -y", *made->bite.moving.fore_aft);
  EXPECT_TRUE(page.says("+x and -x: split at the middle of the fixed body, x = 0 (assumed)"));
  ASSERT_EQ(page.table("teeth").size(), 3U);
  for (const answers::Tooth& tooth : made->bite.fixed.teeth) {
    const auto in = [&](const char* heading) {
      return cell(page.table("teeth"), {std::to_string(tooth.number), "fixed"}, heading);
    };
    expect_numbers(in("area in contact, mm²"), {tooth.area}, 0.05);
    expect_numbers(in("geometric share, %"),
                   {100 * tooth.share, 100 * tooth.share_thinner, 100 * tooth.share_thicker}, 0.05);
    expect_numbers(in("least distance, µm"), {1000 * tooth.least_distance}, 0.5);
  }
  EXPECT_TRUE(page.says("FDI numbers"));
}

TEST(BiteHtml, HoldsInputAndSettings) {
  const auto made = full_bite();
  made->bite.moving.hash.reset();
  made->bite.fixed.surface.vertices[7] = {0.5, Eigen::Vector3d::Zero(), 0, false, false};
  const Page page(made->bite);
  const Rows pose = page.table("pose");
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      double read = 0;
      const std::string& cell =
          pose.at(static_cast<std::size_t>(i) + 1).at(static_cast<std::size_t>(k) + 1);
      std::from_chars(cell.data(), cell.data() + cell.size(), read);
      EXPECT_EQ(read, made->bite.pose.matrix()(i, k)) << "to the last bit";
    }
  }
  const auto of = [&](const char* body, const char* heading) {
    return cell(page.table("bodies"), {body}, heading);
  };
  EXPECT_EQ(of("fixed", "file"), "fixed.stl");
  EXPECT_EQ(of("moving", "file"), "moving.stl");
  EXPECT_EQ(of("fixed", "XXH3 of the file"), "0123456789abcdef");
  EXPECT_EQ(of("moving", "XXH3 of the file"), "–");
  EXPECT_EQ(of("fixed", "triangles"), std::to_string(made->bite.fixed.mesh->triangles.size()));
  expect_numbers(of("fixed", "area, mm²"), {made->bite.fixed.surface.total_area}, 0.05);
  EXPECT_EQ(of("fixed", "closed"), "no: depth is by vertices");
  EXPECT_EQ(of("moving", "closed"), "yes");
  EXPECT_GE(std::stoi(of("fixed", "vertices without a known sign")), 1);
  EXPECT_TRUE(page.says("Unit of the meshes: mm, assumed: the files do not say."));
  EXPECT_TRUE(page.says("biteeye (bands of silicone bites: BiteEye, J Oral Rehabil 2022)"));
  EXPECT_TRUE(page.says("± 50 µm assumed for scanning"));
  EXPECT_TRUE(page.says("a foundation of 100 µm (in brackets: 50 µm; 150 µm)"));
  EXPECT_EQ(page.content["lists"]["checks"],
            (json{"overlap above 0.1 mm: check the bite registration", "a < b & c"}));
  EXPECT_TRUE(page.says("Written by ist 1.2, commit 34."));
  EXPECT_EQ(page.content["title"], "Occlusion of fixed.stl and moving.stl");
}

TEST(BiteHtml, TheLegendHoldsEveryBand) {
  const auto& [made, page] = shown();
  const json& items = page.content["lists"]["legend"];
  const auto bands = answers::map_bands(made->bite);
  ASSERT_EQ(items.size(), bands.size() + 3);
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const std::string end =
        bands[i].below_scan_error ? ", hatched: below the error assumed for scanning" : "";
    EXPECT_EQ(items[i], bands[i].words + end);
  }
}

TEST(BiteHtml, SaysTheCaveatVerbatim) {
  const auto made = sphere_over_plate({0, 0, 0.5});
  const Page page(made->bite);
  EXPECT_NE(page.content["all"].get<std::string>().find(answers::kCaveat), std::string::npos);
  EXPECT_TRUE(page.says(answers::kCaveat));
}

TEST(BiteHtml, NamesSidesOnlyAsTheDivisionsDo) {
  IST_SLOW();
  const auto made = full_bite();
  constexpr const char* kSides = R"(\b(left|right|anterior|posterior|front|back|mesial|distal)\b)";
  EXPECT_FALSE(Page(made->bite).holds(kSides));
  made->bite.sides = {Eigen::Vector3d::UnitX(), 0.5, false, "left", "right"};
  made->bite.fore_aft = {-Eigen::Vector3d::UnitY(), 0, true, "anterior", "posterior"};
  const Page named(made->bite);
  EXPECT_FALSE(row_of(named.table("shares"), {"fixed: left and right"}).empty());
  EXPECT_TRUE(
      named.says("left and right: split at x = 0.5; anterior and posterior: split at the "
                 "middle of the fixed body, y = 0 (assumed)"));
  made->bite.sides.direction = Eigen::Vector3d(0.6, 0.8, 0);
  made->bite.sides.at = 0.00819397;
  EXPECT_TRUE(Page(made->bite).says("left and right: split at 0.6 x + 0.8 y = 0.01"));
  made->bite.sides = {Eigen::Vector3d::UnitX(), 0.5, false, "left", "right"};
  // And at the edges of both pictures, where they lie.
  EXPECT_TRUE(named.holds(R"(x="890\.0" y="350\.0" text-anchor="end">left<)"));
  EXPECT_TRUE(named.holds(R"(x="10\.0" y="350\.0" text-anchor="start">right<)"));
  EXPECT_TRUE(named.holds(R"(y="20\.0" text-anchor="middle">posterior<)")) << "of the fixed body";
  EXPECT_TRUE(named.holds(R"(y="20\.0" text-anchor="middle">anterior<)")) << "of the moving body";
}

TEST(BiteHtml, ClaimsNothingThatItCannotKnow) {
  const Page& page = shown().page;
  for (const char* word : {R"(\bnewtons?\b)", R"(\d N\b)", R"(\bstable\b)", R"(\bbalanced\b)",
                           R"(\bhigh\b)", R"(\bcorrect\b)", R"(\bload)", R"(\bpremature\b)"}) {
    EXPECT_FALSE(std::regex_search(page.text(), std::regex(word))) << word;
  }
}

TEST(BiteHtml, NamesAreEscaped) {
  const auto made = sphere_over_plate({0, 0, -0.05});
  Bite& bite = made->bite;
  bite.fixed.name = "</title><script>alert(\"1\")</script> & 'x'.stl";
  bite.moving.name = "\" onload=\"x\xFF\x01.stl";
  bite.sides.first = "<i>";
  bite.unit = "<b>mm";
  bite.checks = {"<script>"};
  bite.findings.notes = {"<img src=\"http://x\">"};
  const Page page(bite);
  EXPECT_EQ(page.content["title"],
            "Occlusion of " + bite.fixed.name + " and \" onload=\"x\uFFFD\uFFFD.stl");
  EXPECT_EQ(row_of(page.table("bodies"), {"fixed"}).at(1), bite.fixed.name);
  EXPECT_FALSE(page.content["elements"].contains("script"));
  EXPECT_EQ(page.content["elements"]["img"], 2);
  EXPECT_EQ(page.content["outside"], json::array());
  EXPECT_TRUE(page.says("<b>mm"));
}

TEST(BiteHtml, ShowsBothMapsAsPictures) {
  const auto made = sphere_over_plate({0, 0, -0.2});
  const Page page(made->bite);
  ASSERT_EQ(page.content["images"].size(), 2U);
  const auto bands = answers::map_bands(made->bite);
  for (int i = 0; i < 2; ++i) {
    const json& image = page.content["images"][static_cast<std::size_t>(i)];
    EXPECT_EQ(image["width"], "900");
    EXPECT_EQ(image["height"], "700");
    EXPECT_NE(image["alt"].get<std::string>().find(i == 0 ? "fixed.stl" : "moving.stl"),
              std::string::npos);
    const cli::Picture picture = page.picture(i);
    EXPECT_EQ(picture.width, 900);
    EXPECT_EQ(picture.height, 700);
    // Beside the dot in the middle the bodies overlap by 0.2 mm.
    const Colour beside = pixel_at(picture, 450 + 8, 350 + 2);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(beside[c], bands[0].colour[c], 6);
  }
  // Where the sphere is 0.5 mm over the plate, and where it is farther than the reach.
  const auto view = cli::bite_views(made->bite, 900, 700).fixed;
  const auto at = [&](double x) {
    const Eigen::Vector2d place = cli::place_in(view, 900, 700, {x, 0, 0});
    return pixel_at(page.picture(0), static_cast<int>(place.x()), static_cast<int>(place.y()));
  };
  EXPECT_EQ(at(std::sqrt(4.5 * 4.5 - 3.8 * 3.8)), bands[3].colour);
  EXPECT_EQ(at(-5.5), answers::kBareSurface);
  EXPECT_EQ(page.content["elements"]["figure"], 2);
}

TEST(BiteHtml, SaysWhereNothingTouches) {
  const auto made = sphere_over_plate({0, 0, 0.5});
  const Page page(made->bite);
  EXPECT_TRUE(page.table("shares").empty());
  EXPECT_TRUE(page.says("No contacts."));
  EXPECT_TRUE(page.table("teeth").empty());
  EXPECT_EQ(row_of(page.table("findings"), {"do the surfaces touch"}).at(1), "no");
}

TEST(BiteHtml, BeginsWithAWarningInPlaceOfEmptyTables) {
  const auto made = sphere_over_plate({0, 0, 100});
  made->bite.warning = answers::warning_of(made->bite);
  const Page page(made->bite);
  EXPECT_EQ(page.content["lists"]["checks"].at(0),
            "The scans are 100 mm apart: they are probably not in one coordinate system. Register "
            "them first, or give --matrix.");
  for (const char* table : {"areas", "depths", "shares", "contacts"}) {
    EXPECT_TRUE(page.table(table).empty()) << table;
  }
  EXPECT_TRUE(page.says("No contacts."));
}

TEST(BiteHtml, SaysItsRegionAndItsHint) {
  const auto made = sphere_over_plate({0, 0, -0.05});
  made->bite.region = Eigen::AlignedBox3d(Eigen::Vector3d(-5, -4, -3), Eigen::Vector3d(5, 4, 3.5));
  made->bite.hint = "contact 1 is far";
  EXPECT_EQ(Page(made->bite).content["lists"]["checks"],
            (json{"region: areas, contacts, shares, depths of vertices and the deepest point are "
                  "of the triangles with their centroid in x -5 to 5, y -4 to 4, z -3 to 3.5; all "
                  "else is of the "
                  "whole bodies",
                  "hint: contact 1 is far"}));
}

TEST(BiteHtml, TellsTheOverlapOnce) {
  const auto made = sphere_over_plate({0, 0, -0.05});
  made->bite.preset = &answers::presets().front();
  ASSERT_EQ(made->bite.preset->micrometres.front(), 0);
  const Rows rows = Page(made->bite).table("areas");
  EXPECT_EQ(rows.size(), 4U);
  EXPECT_FALSE(row_of(rows, {"overlap"}).empty());
  EXPECT_FALSE(row_of(rows, {"within 100 µm or overlapping"}).empty());
  EXPECT_FALSE(row_of(rows, {"within 100 µm, without the overlap"}).empty());
}

TEST(BiteNumbers, Millimetres_HaveAtMostFourDigits) {
  Bite bite;
  const auto expect = [&](double lower, double upper, const char* words) {
    EXPECT_EQ(answers::BiteNumbers(bite).millimetres(DistanceInterval{lower, upper}), words);
    bite.units_per_mm = 1000;  // micrometres
    EXPECT_EQ(answers::BiteNumbers(bite).millimetres(DistanceInterval{1000 * lower, 1000 * upper}),
              words);
    bite.units_per_mm = 1;
  };
  expect(0.4076, 0.4184, "0.407 to 0.419 mm");
  expect(0.40001, 0.40004, "0.4 mm");
  expect(1449.99, 1450.01, "1450 mm");
  expect(129.99, 130.01, "130 mm");
  expect(47.99, 48.02, "47.99 to 48.02 mm");
  expect(0, 2.172e-11, "less than 0.0001 mm");
  expect(0, 0.0004, "less than 0.001 mm");
  expect(0, 0.0123, "0 to 0.013 mm");
  expect(0, 0, "0 mm");
  EXPECT_EQ(answers::BiteNumbers::in_millimetres(4.6913), "4.691 mm");
  EXPECT_EQ(answers::BiteNumbers::in_millimetres(130), "130 mm");
  EXPECT_EQ(answers::BiteNumbers::in_millimetres(123456.7), "123457 mm");
  EXPECT_EQ(answers::BiteNumbers::in_millimetres(2e-7), "less than 0.0001 mm");
}

TEST(BiteHtml, UnknownDepthOfOpenSurfaces_IsNotZero) {
  const auto made = sphere_over_plate({0, 0, 0.5});
  EXPECT_EQ(row_of(Page(made->bite).table("depths"), {"fixed"}).at(1), "0");
  made->bite.findings.touch = Answer::kYes;
  made->bite.findings.depth.at_vertices.reset();
  const Page page(made->bite);
  EXPECT_EQ(row_of(page.table("depths"), {"fixed"}).at(1), "not known");
  EXPECT_TRUE(page.says("not known (open surface)"));
}

TEST(BiteHtml, OtherUnitsComeToTheSameMicrometres) {
  IST_SLOW();
  const auto made = sphere_over_plate({0, 0, -0.05});
  const Cells in_mm = row_of(Page(made->bite).table("bodies"), {"fixed"});
  made->bite.unit = "µm";  // the same numbers, as if each were a micrometre
  made->bite.units_per_mm = 1000;
  made->bite.fixed.surface.total_area *= 1e6;
  made->bite.fixed.surface.depth_at_vertices *= 1000;
  const Page page(made->bite);
  EXPECT_EQ(row_of(page.table("bodies"), {"fixed"}), in_mm);
  EXPECT_EQ(cell(page.table("depths"), {"fixed"}, "depth of the deepest vertex, µm"), "50");
}

TEST(BiteHtml, IsWholeOrAbsent) {
  const auto made = sphere_over_plate({0, 0, 0.5});
  const TempDir dir;
  EXPECT_EQ(error_name([&] { cli::write_bite_html(made->bite, dir.path() / "no" / "bite.html"); }),
            "file-unwritable");
  EXPECT_EQ(dir.entries(), 0U);
}

}  // namespace
}  // namespace ist::test
