#include "answers/occlusion/bite_direction.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ist::answers {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kCosine25 = 0.906;
// Part of the area within the reach. A smaller sum of normals is noise.
constexpr double kCancelled = 1e-3;
// Part of the widths of both ends. A smaller difference is none.
constexpr double kAsWide = 0.05;

Vector middle_of(const FacingBody& body) {
  Eigen::AlignedBox3d box;
  for (const Vector& v : body.mesh.vertices) box.extend(body.to_fixed * v);
  return box.center();
}

Eigen::Index largest_of(const Vector& vector) {
  Eigen::Index largest = 0;
  vector.cwiseAbs().maxCoeff(&largest);
  return largest;
}

Vector signed_axis(Eigen::Index axis, double sign) {
  Vector direction = Vector::Zero();
  direction[axis] = sign < 0 ? -1 : 1;
  return direction;
}

Vector direction_across(const Vector& towards, const Division& sides, const Division& fore_aft) {
  const std::array<Vector, 4> choice{sides.direction, fore_aft.direction, Vector::UnitX(),
                                     Vector::UnitY()};
  for (const Vector& direction : choice) {
    const Vector across = direction - towards.dot(direction) * towards;
    if (across.norm() > 0.5) return across.normalized();
  }
  return Vector::UnitZ().cross(towards).normalized();
}

// A weighted point of a surface: how far along a direction, and how far across.
struct Mass {
  double along, across, weight;
};

using Pair = std::array<const FacingBody*, 2>;

std::vector<Mass> masses_of(const Pair& bodies, const Vector& along, const Vector& across) {
  std::vector<Mass> masses;
  for (const FacingBody* body : bodies) {
    for (const NearTriangle& one : near_triangles(*body)) {
      masses.push_back({along.dot(one.corner), across.dot(one.corner), one.area.norm()});
    }
  }
  if (!masses.empty()) return masses;
  for (const FacingBody* body : bodies) {
    for (const Vector& v : body->mesh.vertices) {
      const Vector point = body->to_fixed * v;
      masses.push_back({along.dot(point), across.dot(point), 1});
    }
  }
  return masses;
}

struct Moments {
  double weight = 0, first = 0, second = 0;
  void add(double at, double mass) {
    weight += mass;
    first += mass * at;
    second += mass * at * at;
  }
  [[nodiscard]] double mean() const { return weight > 0 ? first / weight : 0; }
  [[nodiscard]] double width() const {
    return weight > 0 ? std::sqrt(std::max(0.0, second / weight - mean() * mean())) : 0;
  }
};

// Returns the width of the end in the direction `along` minus the width of the other end, divided
// by the sum of both widths.
double widening(const std::vector<Mass>& masses, double middle) {
  std::array<Moments, 2> ends;
  for (const Mass& one : masses) ends[one.along > middle ? 1 : 0].add(one.across, one.weight);
  const double both = ends[0].width() + ends[1].width();
  return both > 0 ? (ends[1].width() - ends[0].width()) / both : 0;
}

Vector front_of(const Pair& bodies, const Vector& towards, const Vector& across,
                const Division& fore_aft) {
  const Vector along = towards.cross(across);
  const double named = along.dot(fore_aft.direction);
  if (fore_aft.first == "anterior" && named != 0) return named < 0 ? Vector(-along) : along;
  const std::vector<Mass> masses = masses_of(bodies, along, across);
  Moments place;
  for (const Mass& one : masses) place.add(one.along, one.weight);
  const double wider = widening(masses, place.mean());
  const double backwards = std::abs(wider) > kAsWide ? wider : named;
  return backwards > 0 ? Vector(-along) : along;
}

}  // namespace

std::vector<NearTriangle> near_triangles(const FacingBody& body) {
  std::vector<NearTriangle> near;
  for (const Triangle& t : body.mesh.triangles) {
    const std::array<double, 3> distances{
        body.vertices[t[0]].distance, body.vertices[t[1]].distance, body.vertices[t[2]].distance};
    if (std::any_of(distances.begin(), distances.end(), [](double d) { return std::isnan(d); })) {
      continue;
    }
    const Vector& a = body.mesh.vertices[t[0]];
    const Vector area = (body.mesh.vertices[t[1]] - a).cross(body.mesh.vertices[t[2]] - a);
    near.push_back({body.to_fixed * a, body.to_fixed.linear() * area,
                    *std::min_element(distances.begin(), distances.end())});
  }
  return near;
}

Vector direction_between(const FacingBody& fixed, const FacingBody& moving, double reach) {
  Vector normal = Vector::Zero(), sizes = Vector::Zero();
  for (const FacingBody* body : {&fixed, &moving}) {
    for (const NearTriangle& one : near_triangles(*body)) {
      const Vector area = (1 - std::max(one.distance, 0.0) / reach) * one.area;
      normal += body == &fixed ? area : Vector(-area);
      sizes += area.cwiseAbs();
    }
  }
  if (normal.norm() > kCancelled * sizes.norm()) {
    const Vector direction = normal.normalized();
    const Eigen::Index axis = largest_of(direction);
    return std::abs(direction[axis]) > kCosine25 ? signed_axis(axis, direction[axis]) : direction;
  }
  const Vector way = middle_of(moving) - middle_of(fixed);
  const Eigen::Index axis = largest_of(sizes.norm() > 0 ? sizes : way);
  return signed_axis(axis, way[axis]);
}

BiteDirections directions_of(const FacingBody& fixed, const FacingBody& moving, double reach,
                             const Division& sides, const Division& fore_aft) {
  BiteDirections directions;
  directions.towards = direction_between(fixed, moving, reach);
  directions.across = direction_across(directions.towards, sides, fore_aft);
  directions.front = front_of({&fixed, &moving}, directions.towards, directions.across, fore_aft);
  return directions;
}

BiteDirections directions_of(const Bite& bite) {
  return directions_of(bite.fixed, bite.moving, bite.reach, bite.sides, bite.fore_aft);
}

}  // namespace ist::answers
