#include <gtest/gtest.h>

#include "answers/occlusion/bite.h"
#include "answers/occlusion/bite_hints.h"
#include "cli/occlusion/bites.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::BiteContact, answers::contacts_of;
using Regions = std::vector<ContactRegion>;
using Indices = std::vector<std::uint32_t>;
using Vector = Eigen::Vector3d;

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
  // The other side of an arch is no joint, however far, nor is what is near.
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
