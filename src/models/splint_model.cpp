
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ist/base/float_environment.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "models/jaw/jaw_section.h"
#include "models/splint/clearance_map.h"

namespace ist {
namespace {

// The splint seen from above: a grid of constant width along the dental arch, from molar to molar.
// Its triangles run counterclockwise. Coordinates are floats held as doubles.
class Horseshoe {
 public:
  Horseshoe();

  [[nodiscard]] std::span<const Eigen::Vector2d> points() const { return points_; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }

  // Returns a rectangle of whole millimetres round all points.
  [[nodiscard]] PlaneBox area() const;

  // Joins an upper and a lower face, heights of the points, by walls along the border.
  [[nodiscard]] TriangleMesh close(std::span<const double> upper,
                                   std::span<const double> lower) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> border_;  // counterclockwise
};

// The grid: steps along the arch on each side, and across it; mm.
constexpr std::ptrdiff_t kStepsAlong = 144, kStepsAcross = 28;
constexpr double kStep = 0.375;
// The splint's edge at the tongue; lower teeth stand on the arch, upper teeth 2 to 3 mm outside.
constexpr double kInnerEdge = -4.5;

Horseshoe::Horseshoe() {
  const Arch arch;
  for (std::ptrdiff_t i = -kStepsAlong; i <= kStepsAlong; ++i) {
    const ArchFrame frame = arch.at(static_cast<double>(std::abs(i)) * kStep);
    for (std::ptrdiff_t j = 0; j <= kStepsAcross; ++j) {
      const Eigen::Vector2d p =
          frame.point + (kInnerEdge + static_cast<double>(j) * kStep) * frame.outward;
      points_.push_back(
          Eigen::Vector2d(i < 0 ? -p.x() : p.x(), p.y()).cast<float>().cast<double>());
    }
  }
  const auto at = [](std::ptrdiff_t i, std::ptrdiff_t j) {
    return static_cast<std::uint32_t>(i * (kStepsAcross + 1) + j);
  };
  // From left to right along the arch and from tongue to cheek is clockwise.
  constexpr std::ptrdiff_t kLast = 2 * kStepsAlong;
  for (std::ptrdiff_t i = 0; i < kLast; ++i) {
    for (std::ptrdiff_t j = 0; j < kStepsAcross; ++j) {
      triangles_.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      triangles_.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  for (std::ptrdiff_t j = 0; j < kStepsAcross; ++j) border_.push_back(at(0, j));
  for (std::ptrdiff_t i = 0; i < kLast; ++i) border_.push_back(at(i, kStepsAcross));
  for (std::ptrdiff_t j = kStepsAcross; j > 0; --j) border_.push_back(at(kLast, j));
  for (std::ptrdiff_t i = kLast; i > 0; --i) border_.push_back(at(i, 0));
}

PlaneBox Horseshoe::area() const {
  PlaneBox box{points_[0], points_[0]};
  for (const Eigen::Vector2d& p : points_) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  const auto whole = [](double x, double beyond) {
    return static_cast<double>(static_cast<std::int64_t>(x)) + beyond;
  };
  return {{whole(box.min.x(), -1), whole(box.min.y(), -1)},
          {whole(box.max.x(), 1), whole(box.max.y(), 1)}};
}

TriangleMesh Horseshoe::close(std::span<const double> upper, std::span<const double> lower) const {
  const auto below = static_cast<std::uint32_t>(points_.size());
  TriangleMesh mesh;
  for (const std::span<const double> heights : {upper, lower}) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      mesh.vertices.emplace_back(points_[i].x(), points_[i].y(), heights[i]);
    }
  }
  mesh.triangles = triangles_;
  for (const auto& [a, b, c] : triangles_) {
    mesh.triangles.push_back({below + a, below + c, below + b});
  }
  for (std::size_t i = 0; i < border_.size(); ++i) {
    const std::uint32_t a = border_[i], b = border_[(i + 1) % border_.size()];
    mesh.triangles.push_back({below + a, below + b, b});
    mesh.triangles.push_back({below + a, b, a});
  }
  return mesh;
}

// A triangle is cut into kParts² parts, with sides about as long as the map's cells. A part lies
// below the lowest cell that it meets if its three corners do.
constexpr int kParts = 6;
constexpr std::size_t kPartCorners = (kParts + 1) * (kParts + 2) / 2;

constexpr std::size_t part_corner(int i, int j) {
  const int at = i * (2 * kParts + 3 - i) / 2 + j;
  return static_cast<std::size_t>(at);
}

// The shares of the triangle's corners in a part's corner, in kParts-ths.
using Shares = std::array<int, 3>;
constexpr std::array<Shares, kPartCorners> kShares = [] {
  std::array<Shares, kPartCorners> shares{};
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; i + j <= kParts; ++j) shares[part_corner(i, j)] = {kParts - i - j, i, j};
  }
  return shares;
}();

// How high each corner of the parts of a triangle may be.
using Limits = std::array<double, kPartCorners>;

Limits limits_of(const ClearanceMap& map, const std::array<Eigen::Vector2d, 3>& triangle,
                 double highest) {
  Limits limits;
  limits.fill(highest);
  const auto meet = [&](const std::array<std::size_t, 3>& part) {
    PlaneBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [a, b, c] = kShares[part[k]];
      const Eigen::Vector2d p = (a * triangle[0] + b * triangle[1] + c * triangle[2]) / kParts;
      box.min = k == 0 ? p : box.min.cwiseMin(p);
      box.max = k == 0 ? p : box.max.cwiseMax(p);
    }
    const double lowest = map.lowest(box);
    for (const std::size_t corner : part) limits[corner] = std::min(limits[corner], lowest);
  };
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; i + j < kParts; ++j) {
      meet({part_corner(i, j), part_corner(i + 1, j), part_corner(i, j + 1)});
      if (i + j + 1 == kParts) continue;
      meet({part_corner(i + 1, j), part_corner(i + 1, j + 1), part_corner(i, j + 1)});
    }
  }
  return limits;
}

// Returns how high corner `own` of a triangle may be while its other two stay where they are.
double most_at(std::size_t own, const Limits& limits, const std::array<double, 3>& heights) {
  const std::size_t next = (own + 1) % 3, last = (own + 2) % 3;
  double most = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < kPartCorners; ++i) {
    const Shares& shares = kShares[i];
    if (shares[own] == 0) continue;
    const double others = shares[next] * heights[next] + shares[last] * heights[last];
    most = std::min(most, (kParts * limits[i] - others) / shares[own]);
  }
  return most;
}

// Returns heights of the horseshoe's points, at most `highest`, such that its triangles lie below
// the heights of the map all over: the highest, in that no point can rise while the others stay.
//
// Each point starts at the lowest cell that its triangles meet, so that these lie below the map.
// Then each rises once as far as the triangles round it allow, the points of low cells first: where
// the map drops between two points, the lower one gets close to it, and the higher one stays
// behind.
std::vector<double> fit_below(const ClearanceMap& map, const Horseshoe& horseshoe, double highest) {
  const std::span<const Eigen::Vector2d> points = horseshoe.points();
  const std::span<const Triangle> triangles = horseshoe.triangles();
  std::vector<Limits> limits;
  std::vector<double> heights(points.size(), highest);
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> around(points.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    limits.push_back(limits_of(map, {points[a], points[b], points[c]}, highest));
    const double lowest = *std::min_element(limits[t].begin(), limits[t].end());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t point = triangles[t][k];
      heights[point] = std::min(heights[point], lowest);
      around[point].emplace_back(t, k);
    }
  }
  std::vector<std::pair<double, std::uint32_t>> order;  // no two are equal
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    order.emplace_back(map.lowest({points[i], points[i]}), i);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [cell, point] : order) {
    double most = highest;
    for (const auto& [t, k] : around[point]) {
      const auto& [a, b, c] = triangles[t];
      most = std::min(most, most_at(k, limits[t], {heights[a], heights[b], heights[c]}));
    }
    heights[point] = std::max(heights[point], most);
  }
  return heights;
}

// How far the splint reaches beyond the occlusal plane of either arch where no tooth is above it,
// and the least thickness that is made; mm.
constexpr double kRim = 1.5, kLeastThickness = 0.5;
constexpr double kWidestOpening = 20;

// Turns a mesh upside down, so that what is above it is below: a map of it then has the negative
// heights above which a solid may be.
TriangleMesh upside_down(TriangleMesh mesh) {
  for (Eigen::Vector3d& v : mesh.vertices) v.z() = -v.z();
  return mesh;
}

// Rounds down to a multiple of 2^-10 mm, which a float holds.
double round_down(double height) {
  constexpr double kStepsPerMm = 1024;
  const double scaled = height * kStepsPerMm;
  auto steps = static_cast<std::int64_t>(scaled);
  if (static_cast<double>(steps) > scaled) --steps;
  return static_cast<double>(steps) / kStepsPerMm;
}

}  // namespace

TriangleMesh make_splint(std::uint64_t seed, double opening) {
  const ScopedFloatEnvironment environment;
  if (!(opening >= 0 && opening <= kWidestOpening)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "a splint for jaws {} mm open: give an opening from 0 to {} mm", opening,
                kWidestOpening);
  }
  const Horseshoe horseshoe;
  const ClearanceMap upper(make_jaw(Jaw::kUpper, seed), horseshoe.area());
  const ClearanceMap lower(upside_down(make_jaw(Jaw::kLower, seed)), horseshoe.area());
  std::vector<double> top = fit_below(upper, horseshoe, kOcclusalPlane + kRim);
  std::vector<double> bottom = fit_below(lower, horseshoe, kRim - kOcclusalPlane);
  double thickness = kWidestOpening;
  for (std::size_t i = 0; i < top.size(); ++i) {
    top[i] = round_down(top[i]);
    bottom[i] = -round_down(bottom[i] + opening);
    thickness = std::min(thickness, top[i] - bottom[i]);
  }
  if (thickness < kLeastThickness) {
    throw_error(ErrorCode::kArgumentInvalid,
                "a splint between the jaws of seed {} at an opening of {} mm would be "
                "{:.2f} mm thick at its thinnest: give an opening of {:.2f} mm or more",
                seed, opening, std::max(thickness, 0.0),
                opening + kLeastThickness - thickness + 0.005);
  }
  return horseshoe.close(top, bottom);
}

}  // namespace ist
