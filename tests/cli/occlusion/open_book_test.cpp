#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "answers/occlusion/bite_direction.h"
#include "answers/occlusion/bite_surfaces.h"
#include "cli/occlusion/bites.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using answers::Bite, answers::BiteBody, answers::BookLayout, answers::OpenedBook;
using Vector = Eigen::Vector3d;

Vector between(const MadeBite& made) {
  return answers::direction_between(made.bite.fixed, made.bite.moving, made.bite.reach);
}

// The arch of an upper jaw as a scan has it: open, its teeth at z = 0 look down, its front is -y.
TriangleMesh upper_arch() {
  TriangleMesh arch = plate(10, 0.5), kept;
  kept.vertices = arch.vertices;
  for (const Triangle& t : arch.triangles) {
    const Vector& at = arch.vertices[t[0]];
    if (std::abs(at.x()) > 5 || at.y() < -5) kept.triangles.push_back(t);
  }
  return inside_out(kept);
}

// A whole mandible of boxes: its teeth are 0.1 below the arch, and its rami end 15 above them.
TriangleMesh mandible() {
  const TriangleMesh body = box({-10, -10, -3}, {10, 10, -0.1});
  return joined(body, joined(box({-11, 10, -3}, {-8, 22, 15}), box({8, 10, -3}, {11, 22, 15})));
}

// Maps x, y, z to x, z, -y: what was up is along y.
Eigen::Matrix3d y_up() {
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

TEST(BiteDirection, ScanAgainstWholeMandible_CrossesTheTeeth) {
  EXPECT_EQ(between(*bite_of(upper_arch(), mandible())), -Vector::UnitZ());
  EXPECT_EQ(between(*bite_of(mandible(), upper_arch())), Vector::UnitZ());
  // The middle of the mandible's box lies behind the arch's, and above it.
  EXPECT_EQ(between(*bite_of(turned(upper_arch(), y_up()), turned(mandible(), y_up()))),
            -Vector::UnitY());
}

TEST(BiteDirection, ParallelPlates_CrossesTheGap) {
  const TriangleMesh lower = plate(10, 0.5), upper = inside_out(moved(lower, {8, 0, 1}));
  EXPECT_EQ(between(*bite_of(lower, upper)), Vector::UnitZ());
  EXPECT_EQ(between(*bite_of(upper, lower)), -Vector::UnitZ());
  // Wound alike, their normals cancel out; their middles differ most along x.
  EXPECT_EQ(between(*bite_of(lower, inside_out(upper))), Vector::UnitZ());
  EXPECT_EQ(between(*bite_of(inside_out(upper), lower)), -Vector::UnitZ());
  // Of thin ones both sides are within the reach.
  const TriangleMesh below = joined(lower, inside_out(moved(lower, {0, 0, -0.4}))),
                     above = moved(below, {8, 0, 1.2});
  EXPECT_EQ(between(*bite_of(below, above)), Vector::UnitZ());
  EXPECT_EQ(between(*bite_of(above, below)), -Vector::UnitZ());
}

TEST(BiteDirection, OutOfReach_GoesByTheBoxes) {
  EXPECT_EQ(between(*bite_of(plate(10, 1), moved(plate(10, 1), {8, 0, 30}))), Vector::UnitZ());
}

TEST(BiteDirection, FrontIsTheNarrowerEnd) {
  auto made = bite_of(upper_arch(), mandible());
  EXPECT_EQ(answers::directions_of(made->bite).front, -Vector::UnitY());
  EXPECT_EQ(answers::directions_of(made->bite).across, Vector::UnitX());
  made->bite.fore_aft.first = "anterior";  // as the user names it
  EXPECT_EQ(answers::directions_of(made->bite).front, Vector::UnitY());
  const Eigen::Matrix3d about = Eigen::AngleAxisd(M_PI, Vector::UnitZ()).toRotationMatrix();
  const auto back = bite_of(turned(upper_arch(), about), turned(mandible(), about));
  EXPECT_EQ(answers::directions_of(back->bite).front, Vector::UnitY());
  const auto lying = bite_of(turned(upper_arch(), y_up()), turned(mandible(), y_up()));
  EXPECT_TRUE(answers::directions_of(lying->bite).front.isApprox(Vector::UnitZ(), 1e-12));
  const auto round = sphere_over_plate({0, 0, -0.05});  // both ends are as wide
  EXPECT_EQ(answers::directions_of(round->bite).front, -Vector::UnitY());
}

struct Seen {
  Vector normal = Vector::Zero();  // of what is near the other body, the mean by area
  double low = 1e9, high = -1e9;   // of the whole body along `towards`
};

Seen seen(const BiteBody& body, const Eigen::Isometry3d& place, const Vector& towards) {
  Seen all;
  for (const answers::NearTriangle& one : answers::near_triangles(body)) {
    all.normal += place.linear() * one.area;
  }
  all.normal.normalize();
  for (const Vector& v : body.mesh->vertices) {
    const double at = towards.dot(place * (body.to_fixed * v));
    all.low = std::min(all.low, at), all.high = std::max(all.high, at);
  }
  return all;
}

// Whatever is up in the mesh, and wherever the middles of the boxes are.
TEST(OpenBook, OcclusalFacesLookAtTheViewer) {
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.7, Vector(1, 2, 2) / 3).toRotationMatrix();
  for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), y_up(), tilt}) {
    const auto made = bite_of(turned(upper_arch(), turn), turned(mandible(), turn));
    const Vector towards = answers::directions_of(made->bite).towards;
    for (const BookLayout layout : {BookLayout::kBeside, BookLayout::kAbove}) {
      const OpenedBook book = answers::opened(made->bite, 3, layout);
      const Seen fixed = seen(made->bite.fixed, book.fixed, towards),
                 moving = seen(made->bite.moving, book.moving, towards);
      EXPECT_GT(fixed.normal.dot(book.viewer), 0.999);
      EXPECT_GT(moving.normal.dot(book.viewer), 0.999);
      EXPECT_NEAR(moving.low - fixed.high, 3, 1e-6) << "apart by the gap";
      EXPECT_NEAR(book.viewer.dot(book.up), 0, 1e-12);
      EXPECT_TRUE(book.fixed.linear().isUnitary(1e-12));
      EXPECT_GT(book.moving.linear().determinant(), 0.999) << "no mirror";
    }
  }
}

TEST(OpenBook, MidlineIsUpright) {
  const auto made = bite_of(upper_arch(), mandible());
  const answers::BiteDirections way = answers::directions_of(made->bite);
  const OpenedBook beside = answers::opened(made->bite, 3),
                   above = answers::opened(made->bite, 3, BookLayout::kAbove);
  EXPECT_TRUE((beside.fixed.linear() * way.front).isApprox(beside.up, 1e-12));
  EXPECT_TRUE((beside.moving.linear() * way.front).isApprox(beside.up, 1e-12));
  EXPECT_TRUE((above.fixed.linear() * way.front).isApprox(above.up, 1e-12));
  EXPECT_TRUE((above.moving.linear() * way.front).isApprox(-above.up, 1e-12));
  // A point of both bodies, as they bite: in front, on the right.
  const Vector point(4, -7, 0);
  const auto apart = [&](const OpenedBook& book) {
    return Vector(book.moving * point - book.fixed * point);
  };
  const auto right = [](const OpenedBook& book) { return Vector(book.up.cross(book.viewer)); };
  EXPECT_GT(apart(beside).dot(right(beside)), 5) << "the fixed body is on the left";
  EXPECT_NEAR(apart(beside).dot(beside.up), 0, 1e-6);
  EXPECT_LT(apart(above).dot(above.up), -5) << "the fixed body is above";
  EXPECT_NEAR(apart(above).dot(right(above)), 0, 1e-6);
}

}  // namespace
}  // namespace ist::test
