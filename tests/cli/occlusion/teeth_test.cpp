#include <gtest/gtest.h>

#include <cmath>

#include "answers/occlusion/bite.h"
#include "answers/occlusion/bite_hints.h"
#include "answers/occlusion/sides.h"
#include "cli/occlusion/bites.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::teeth_of, answers::ToothLabels;

// Four triangles, six vertices: 0 2 4 / 1 3 5.
const TriangleMesh kStrip = open_strip(2);

TEST(Teeth, SumTheContactsOfTheirTriangles) {
  SurfaceOcclusion surface;
  surface.vertices.resize(6);
  for (std::size_t v = 0; v < 6; ++v) surface.vertices[v].distance = 0.1 * static_cast<double>(v);
  surface.regions.resize(2);
  surface.regions[0].triangles = {{0, 0.5, 3, 0, 8, 0.05}, {1, 0.25, 1, 0, 4, -0.5}};
  surface.regions[1].triangles = {{0, 0.125, 2, 0, 4, 0.1}, {3, 1, 2, 0, 4, 0.05}};
  const auto teeth = teeth_of(surface, kStrip, {12, 11, 13, 0});
  ASSERT_EQ(teeth.size(), 3U);
  EXPECT_EQ(teeth[0].number, 11);
  EXPECT_EQ(teeth[0].least_distance, -0.5) << "between its vertices";
  EXPECT_EQ(teeth[0].area, 0.25);
  EXPECT_EQ(teeth[0].share, 1 / 8.0);
  EXPECT_EQ(teeth[0].share_thicker, 4 / 20.0);
  EXPECT_EQ(teeth[1].number, 12);
  EXPECT_EQ(teeth[1].area, 0.625);
  EXPECT_EQ(teeth[1].share, 5 / 8.0);
  EXPECT_EQ(teeth[1].share_thinner, 0) << "that foundation is not pressed";
  EXPECT_EQ(teeth[1].least_distance, 0);
  EXPECT_EQ(teeth[2].number, 13);
  EXPECT_EQ(teeth[2].share, 0);
  std::uint32_t first = 6;
  for (const std::uint32_t v : kStrip.triangles[2]) first = std::min(first, v);
  EXPECT_EQ(teeth[2].least_distance, 0.1 * first);
}

TEST(Teeth, BeyondTheReachHaveNoDistance) {
  SurfaceOcclusion surface;
  surface.vertices.resize(6);
  for (SurfaceDistance& one : surface.vertices) one.distance = std::nan("");
  const auto teeth = teeth_of(surface, kStrip, {0, 0, 36, 36});
  ASSERT_EQ(teeth.size(), 1U);
  EXPECT_TRUE(std::isnan(teeth[0].least_distance));
  EXPECT_EQ(teeth[0].share, 0);
}

TEST(Teeth, OfABiteShareAllThatIsLabelled) {
  const auto made = sphere_over_plate({1, 0, -0.05});
  const answers::BiteBody& body = made->bite.fixed;
  ToothLabels labels;
  for (const Triangle& t : body.mesh->triangles) {
    labels.push_back(
        (body.mesh->vertices[t[0]] + body.mesh->vertices[t[1]] + body.mesh->vertices[t[2]]).x() > 3
            ? 11
            : 21);
  }
  const auto teeth = teeth_of(body.surface, *body.mesh, labels);
  ASSERT_EQ(teeth.size(), 2U);
  EXPECT_NEAR(teeth[0].share + teeth[1].share, 1, 1e-12);
  EXPECT_NEAR(teeth[0].share, 0.5, 1e-6);
  double area = 0;
  for (const ContactRegion& region : body.surface.regions) area += region.area;
  EXPECT_NEAR(teeth[0].area + teeth[1].area, area, 1e-9);
  EXPECT_EQ(std::min(teeth[0].least_distance, teeth[1].least_distance),
            body.surface.regions[0].least_distance);
}

using answers::Balance, answers::balance_of, answers::Division;
using Vector = Eigen::Vector3d;

const Division kAcross{Vector::UnitX(), 0, false, "+x", "-x"};

// Four triangles whose middles are at x = 3, 1, -1, and 0, and a contact in each.
struct Few {
  TriangleMesh mesh;
  SurfaceOcclusion surface;

  explicit Few(const std::vector<double>& pressed) {
    for (const double x : {3.0, 1.0, -1.0, 0.0}) {
      const auto at = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {{x - 1, 0, 0}, {x + 1, 0, 0}, {x, 3, 0}});
      mesh.triangles.push_back({at, at + 1, at + 2});
    }
    surface.regions.resize(2);
    for (std::uint32_t i = 0; i < pressed.size(); ++i) {
      // Of a thinner foundation the first triangle alone.
      surface.regions[i % 2].triangles.push_back(
          {i, 1, pressed[i], i == 0 ? pressed[i] : 0, 2 * pressed[i]});
    }
  }
  [[nodiscard]] std::optional<Balance> about(
      const Division& division,
      const Eigen::Isometry3d& to_fixed = Eigen::Isometry3d::Identity()) const {
    return balance_of(surface, mesh, to_fixed, division);
  }
};

TEST(Balance, SharesAreSumsBySideAndTheAsymmetryIsTheirDifference) {
  const auto found = Few({2, 1, 5}).about(kAcross);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->shares.first, 100 * 3 / 8.0);
  EXPECT_DOUBLE_EQ(found->shares.second, 100 * 5 / 8.0);
  EXPECT_DOUBLE_EQ(found->shares.asymmetry, 100 * 2 / 8.0);
  EXPECT_DOUBLE_EQ(found->thinner.first, 100);
  EXPECT_DOUBLE_EQ(found->thinner.asymmetry, 100);
  EXPECT_DOUBLE_EQ(found->thicker.second, 100 * 5 / 8.0);
  EXPECT_TRUE(found->centre.isApprox(Vector((2 * 3 + 1 - 5) / 8.0, 1, 0)));
}

TEST(Balance, ATriangleOnThePlaneIsHalfOnEachSide) {
  const auto found = Few({0, 3, 3, 4}).about(kAcross);
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->shares.first, 50);
  EXPECT_DOUBLE_EQ(found->shares.asymmetry, 0);
  EXPECT_DOUBLE_EQ(found->thinner.first + found->thinner.second, 0);  // it is not pressed
}

TEST(Balance, CountsInFixedCoordinatesFromThePlane) {
  Eigen::Isometry3d to_fixed(Eigen::AngleAxisd(std::acos(-1.0), Vector::UnitZ()));
  to_fixed.translation() = Vector(0, 0, 7);
  const Few few({2, 1, 5});
  EXPECT_DOUBLE_EQ(few.about(kAcross, to_fixed)->shares.first, 100 * 5 / 8.0);
  EXPECT_TRUE(few.about(kAcross, to_fixed)->centre.isApprox(Vector(-0.25, -1, 7)));
  const Division beyond{Vector::UnitX(), 2, false, "a", "b"};
  EXPECT_DOUBLE_EQ(few.about(beyond)->shares.first, 25);
}

TEST(Balance, NothingIsWhereNothingIsPressed) {
  EXPECT_FALSE(Few({}).about(kAcross));
  EXPECT_FALSE(Few({0, 0, 0}).about(kAcross));
}

TEST(Balance, OfASphereOnAPlateIsEvenAndMovesWithTheSphere) {
  const auto even = sphere_over_plate({0, 0, -0.05});
  ASSERT_TRUE(even->bite.fixed.sides && even->bite.moving.sides);
  EXPECT_NEAR(even->bite.fixed.sides->shares.first, 50, 1e-6);
  EXPECT_NEAR(even->bite.fixed.fore_aft->shares.first, 50, 1e-6);
  EXPECT_NEAR(even->bite.moving.sides->shares.first, 50, 1e-6);
  EXPECT_LT(even->bite.fixed.sides->centre.norm(), 1e-2);
  const auto aside = sphere_over_plate({0.5, 0, -0.05});
  EXPECT_GT(aside->bite.fixed.sides->shares.first, 65);
  EXPECT_GT(aside->bite.moving.sides->shares.first, 65);
  EXPECT_NEAR(aside->bite.fixed.fore_aft->shares.first, 50, 1e-6);
  EXPECT_NEAR(aside->bite.fixed.sides->centre.x(), 0.5, 0.02);
  const auto beyond = sphere_over_plate({-5, 3, -0.05});
  EXPECT_EQ(beyond->bite.fixed.sides->shares.first, 0);
  EXPECT_EQ(beyond->bite.fixed.sides->shares.asymmetry, 100);
  EXPECT_EQ(beyond->bite.moving.fore_aft->shares.first, 100);
}

using answers::BiteContact, answers::contacts_of;
using Regions = std::vector<ContactRegion>;
using Indices = std::vector<std::uint32_t>;

// A region of an area, which faces one of the other body.
ContactRegion region(double area, std::optional<std::uint32_t> faces, double least = 0) {
  ContactRegion made;
  made.area = area;
  made.centre = made.closest = Vector(area, least, 0);
  made.least_distance = least;
  made.share = 0.1 * area;
  made.faces = faces;
  return made;
}

TEST(BiteContacts, ThoseOnBothBodiesComeFirstByArea) {
  const Regions fixed{region(9, {}), region(1, 1), region(4, 0)},
      moving{region(5, 2), region(2, 1), region(7, {})};
  const std::vector<BiteContact> contacts = contacts_of(fixed, moving);
  ASSERT_EQ(contacts.size(), 4U);
  EXPECT_EQ(contacts[0].fixed, Indices{2});
  EXPECT_EQ(contacts[0].moving, Indices{0});
  EXPECT_EQ(contacts[0].area, 4.5) << "the mean of both";
  EXPECT_EQ(contacts[0].share, 0.45);
  EXPECT_EQ(contacts[1].fixed, Indices{1});
  EXPECT_EQ(contacts[1].moving, Indices{1});
  EXPECT_EQ(contacts[2].fixed, Indices{0});
  EXPECT_FALSE(contacts[2].on_both());
  EXPECT_EQ(contacts[2].area, 9);
  EXPECT_EQ(contacts[3].moving, Indices{2});
  EXPECT_EQ(contacts[3].area, 7);
}

// One region under two: a dentist sees one contact, and both marks have its number.
TEST(BiteContacts, ARegionThatFacesTwoMakesOneContactWithBoth) {
  const Regions fixed{region(3, 0, -0.1), region(1, 0, -0.3)}, moving{region(5, 0, -0.2)};
  const std::vector<BiteContact> contacts = contacts_of(fixed, moving);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].fixed, (Indices{0, 1}));
  EXPECT_EQ(contacts[0].moving, Indices{0});
  EXPECT_EQ(contacts[0].area, 4.5);
  EXPECT_EQ(contacts[0].least_distance, -0.3);
  EXPECT_EQ(contacts[0].closest, fixed[1].closest);
  EXPECT_EQ(contacts[0].centre.x(), (3 * 3 + 1 * 1 + 5 * 5) / 9.0);
  answers::Bite bite;
  bite.fixed.surface.regions = fixed;
  bite.moving.surface.regions = moving;
  bite.number_contacts();
  EXPECT_EQ(bite.fixed.contacts, (std::vector<std::size_t>{1, 1}));
  EXPECT_EQ(bite.moving.contacts, (std::vector<std::size_t>{1}));
}

// A strip of bumps that touch a plate, and one more on a step of the plate.
std::unique_ptr<MadeBite> with_bump_at(const Vector& at) {
  TriangleMesh arch, bumps;
  for (int i = 0; i < 4; ++i) {
    arch = joined(arch, moved(plate(2, 0.25), {5.0 * i, 0, 0}));
    bumps = joined(bumps, moved(icosphere(3, 1), {5.0 * i, 0, 0.9}));
  }
  return bite_of(joined(arch, moved(plate(1.5, 0.25), at)),
                 joined(bumps, moved(icosphere(3, 1), at + Vector(0, 0, 0.94))));
}

TEST(BiteHints, NameContactsFarAboveTheArchAndTheRegionWithoutThem) {
  const auto made = with_bump_at({5, 14, 10});
  ASSERT_EQ(made->bite.contacts.size(), 5U);
  const std::optional<std::string> hint = answers::hint_of(made->bite);
  ASSERT_TRUE(hint);
  EXPECT_TRUE(
      hint->starts_with("contact 5 lies 17 mm or more from the others, perhaps in the "
                        "joints: --region "))
      << *hint;
  EXPECT_TRUE(hint->ends_with(" leaves it out")) << *hint;
  const std::string far = answers::hint_of(with_bump_at({5, 105, 78})->bite).value_or("");
  EXPECT_TRUE(far.starts_with("contact 5 lies 130 mm or more from the others")) << far;
  // Neither the other side of an arch nor a near place is a joint.
  EXPECT_FALSE(answers::hint_of(with_bump_at({5, 20, 0.5})->bite));
  EXPECT_FALSE(answers::hint_of(with_bump_at({5, 4, 4})->bite));
  EXPECT_FALSE(answers::hint_of(sphere_over_plate({0, 0, -0.05})->bite));
}

TEST(BiteHints, WarnOfBodiesThatAreHardlyInOneCoordinateSystem) {
  const auto warning = [](double height) {
    return answers::warning_of(sphere_over_plate({0, 0, height})->bite);
  };
  EXPECT_FALSE(warning(-0.05));
  EXPECT_FALSE(warning(3.5)) << "an open bite";
  ASSERT_TRUE(warning(30));
  EXPECT_TRUE(
      warning(30)->starts_with("The scans are 30 mm apart: they are probably not in one "
                               "coordinate system."));
}

TEST(BiteHints, WarnOfAnOverlapThatIsNoBite) {
  const auto made = sphere_over_plate({0, 0, -0.5});
  made->bite.findings.depth.certain = DistanceInterval{4.6913, 4.7};
  EXPECT_EQ(answers::warning_of(made->bite),
            "The scans overlap by 4.691 mm, more than a bite does: check that they are the upper "
            "and the lower jaw of one patient, in one coordinate system.");
  made->bite.findings.depth.certain = DistanceInterval{1.99, 2.01};
  EXPECT_FALSE(answers::warning_of(made->bite));
  made->bite.findings.depth.certain.reset();
  EXPECT_FALSE(answers::warning_of(made->bite));
  made->bite.findings.depth.at_vertices = 2.05;
  EXPECT_TRUE(answers::warning_of(made->bite)
                  .value_or("")
                  .starts_with("The scans overlap by at least 2.05 mm, "));
}

// Two scans of one jaw, one of them a little lower.
TEST(BiteHints, WarnOfScansThatFaceTheSameWay) {
  const TriangleMesh up = plate(5, 1), down = inside_out(up);
  const auto warning = [&](const TriangleMesh& moving, double height) {
    const Eigen::Isometry3d pose(Eigen::Translation3d(0, 0, height));
    return answers::warning_of(bite_of(up, moving, pose)->bite);
  };
  for (const double height : {-0.1, 0.1, 1.0}) {
    EXPECT_FALSE(warning(down, height)) << height;
    ASSERT_TRUE(warning(up, height)) << height;
    EXPECT_TRUE(warning(up, height)->starts_with("The scans face the same way"));
  }
}

}  // namespace
}  // namespace ist::test
