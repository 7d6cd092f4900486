#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/models/jaw/jaw_section.h"
#include "ist/models/models.h"
#include "ist/models/splint/clearance_map.h"
#include "ist/models/splint/height_fit.h"
#include "ist/models/splint/horseshoe.h"

namespace ist {
namespace {

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
    throw Error(ErrorCode::kArgumentInvalid,
                fmt::format("a splint for jaws {} mm open: give an opening from 0 to {} mm",
                            opening, kWidestOpening));
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
    throw Error(ErrorCode::kArgumentInvalid,
                fmt::format("a splint between the jaws of seed {} at an opening of {} mm would be "
                            "{:.2f} mm thick at its thinnest: give an opening of {:.2f} mm or more",
                            seed, opening, std::max(thickness, 0.0),
                            opening + kLeastThickness - thickness + 0.005));
  }
  return horseshoe.close(top, bottom);
}

}  // namespace ist
