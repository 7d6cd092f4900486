#include "answers/comparison/change_map.h"

#include <algorithm>
#include <cmath>

#include "ist/measure/comparison.h"

namespace ist::answers {
namespace {

std::vector<float> as_floats(const std::vector<double>& numbers) {
  std::vector<float> floats;
  for (const double number : numbers) floats.push_back(static_cast<float>(number));
  return floats;
}

std::vector<float> distances(const BiteBody& body) {
  std::vector<float> floats;
  for (const SurfaceDistance& one : body.surface.vertices) {
    floats.push_back(static_cast<float>(one.distance));
  }
  return floats;
}

NamedPolyData changed_body(const Bite& after, const BiteBody& body) {
  PolyData data = poly_data(*body.mesh);
  for (Eigen::Vector3d& point : data.points) point = body.to_fixed * point;
  data.frame = after.frame;
  data.texts = {{"Unit", after.unit_words()}, {"Caveat", kCaveat}};
  return {body.name, std::move(data)};
}

}  // namespace

double ChangeMap::most() const {
  double most = 0;
  for (const std::vector<double>* body : {&fixed, &moving}) {
    for (const double change : *body) most = std::fmax(most, std::abs(change));  // no NaN
  }
  return most;
}

ChangeMap change_map(const Bite& before, const Bite& after) {
  return {distance_change(before.fixed.surface.vertices, after.fixed.surface.vertices),
          distance_change(before.moving.surface.vertices, after.moving.surface.vertices)};
}

std::vector<NamedPolyData> change_arrays(const Bite& before, const Bite& after,
                                         const ChangeMap& map) {
  std::vector<NamedPolyData> out;
  for (const bool fixed : {true, false}) {
    const BiteBody &first = fixed ? before.fixed : before.moving,
                   &second = fixed ? after.fixed : after.moving;
    NamedPolyData& body = out.emplace_back(changed_body(after, second));
    body.data.point_arrays = {{"Before", distances(first)},
                              {"After", distances(second)},
                              {"Change", as_floats(fixed ? map.fixed : map.moving)}};
  }
  return out;
}

std::vector<NamedPolyData> change_surfaces(const Bite& after, const ChangeMap& map,
                                           const MapScale& scale) {
  std::vector<NamedPolyData> out;
  for (const bool fixed : {true, false}) {
    const std::vector<double>& change = fixed ? map.fixed : map.moving;
    NamedPolyData& body = out.emplace_back(changed_body(after, fixed ? after.fixed : after.moving));
    body.data.point_arrays = {{"Change", as_floats(change)}};
    for (const double one : change) body.data.colours.push_back(scale.colour(one));
  }
  return out;
}

}  // namespace ist::answers
