#include "fuzz/measure_checks.h"

#include <cmath>
#include <functional>
#include <vector>

#include "fuzz/fuzz_target.h"
#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/measure/first_contact.h"
#include "ist/measure/occlusion.h"
#include "ist/measure/penetration.h"
#include "ist/measure/signed_distance.h"

namespace ist::test {
namespace {

// Farther away a number of 100 bodies' sizes has no digits left for the bodies.
constexpr double kFar = 1e9;
constexpr Budget kFewPoints{4'000}, kFewDistances{200};

// Whether it measures; false where it says why not.
bool measures(const std::function<void()>& measure, ErrorCode excuse) {
  try {
    measure();
  } catch (const Error& error) {
    if (error.code() != excuse) throw;
    return false;
  }
  return true;
}

Eigen::Isometry3d shifted(Eigen::Isometry3d pose, const Eigen::Vector3d& by) {
  pose.translation() += by;
  return pose;
}

}  // namespace

MeasureChecks::MeasureChecks(const SphereTree& fixed, const SphereTree& moving,
                             QueryChecks::Trees trees)
    : fixed_(fixed),
      moving_(moving),
      built_(trees == QueryChecks::Trees::kBuilt),
      size_(fixed.bounding_radius() + moving.bounding_radius()),
      query_(fixed, moving) {}

void MeasureChecks::at(const Eigen::Isometry3d& pose) {
  const auto rigid = project_to_rigid(pose);
  if (!rigid) return check_invalid(pose);
  if (!(rigid->translation().cwiseAbs().maxCoeff() <= kFar * size_)) return;
  const IntersectionResult verdict = query_.intersects(pose);
  check_map(moving_, fixed_, *rigid);
  check_map(fixed_, moving_, rigid->inverse(Eigen::Isometry));
  check_depth(pose, verdict);
  check_first_contact(pose, verdict);
  check_occlusion(pose);
}

void MeasureChecks::check_invalid(const Eigen::Isometry3d& pose) {
  require(penetration(query_, pose, 0.1).status == Penetration::Status::kInvalidPose ||
              fixed_.orientation() != Orientation::kOutward ||
              moving_.orientation() != Orientation::kOutward,
          "a pose that is none has a depth");
  const auto refused = [&](const std::function<void()>& measure) {
    require(!measures(measure, ErrorCode::kPoseInvalid), "a pose that is none is measured");
  };
  refused([&] { (void)distance_map(moving_, fixed_, pose, 1); });
  refused([&] { (void)occlusion(query_, pose); });
  refused([&] { (void)first_contact(query_, pose, Eigen::Isometry3d::Identity(), 0.1); });
  refused([&] { (void)first_contact(query_, Eigen::Isometry3d::Identity(), pose, 0.1); });
}

void MeasureChecks::check_map(const SphereTree& body, const SphereTree& other,
                              const Eigen::Isometry3d& pose) {
  const double reach = 0.25 * size_;
  const auto all = distance_map(body, other, pose, std::numeric_limits<double>::infinity());
  const auto near = distance_map(body, other, pose, reach);
  require(all.size() == near.size(), "a map leaves out vertices");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double distance = all[i].distance;
    require(!(distance < 0) || all[i].is_signed, "an unknown side is inside");
    if (!built_) continue;
    require(std::isfinite(distance) && all[i].closest.allFinite(), "a distance is no number");
    const bool within = std::abs(distance) <= reach;
    require(within == !std::isnan(near[i].distance), "the reach cuts elsewhere");
    require(!within || (near[i].distance == distance && near[i].triangle == all[i].triangle),
            "the reach changes a distance");
  }
}

void MeasureChecks::check_depth(const Eigen::Isometry3d& pose, const IntersectionResult& verdict) {
  const Penetration coarse = penetration(query_, pose, 0.1 * size_, {.budget = kFewPoints});
  const Penetration depth =
      penetration(query_, pose, 1e-3 * size_, {.last = &coarse, .budget = kFewPoints});
  require(depth.status == coarse.status, "the tolerance changes whether there is a depth");
  if (depth.status != Penetration::Status::kDone) {
    require(depth.upper == HUGE_VAL && depth.lower == 0, "there is no depth, and it is bounded");
    return;
  }
  if (!built_) return;
  for (const Penetration& each : {coarse, depth}) {
    require(std::isfinite(each.upper) && 0 <= each.lower && each.lower <= each.upper,
            "the depth is no interval");
    require(each.upper <= size_ * (1 + 1e-9), "bodies are deeper in each other than they are big");
  }
  const double rounding = 1e-12 * (size_ + pose.translation().cwiseAbs().maxCoeff());
  require(std::max(depth.lower, coarse.lower) <= std::min(depth.upper, coarse.upper) + rounding,
          "two depths of one pose do not intersect");
  if (verdict.answer != Answer::kNo || depth.lower <= rounding) return;
  require(query_.distance(pose, 0).distance.upper > 0 || depth.narrowest > 0,
          "bodies are in each other and touch nowhere");
}

void MeasureChecks::check_first_contact(const Eigen::Isometry3d& pose,
                                        const IntersectionResult& verdict) {
  const Motion motion = Motion::between(shifted(pose, Eigen::Vector3d(0.5, 1, 1.5) * size_), pose);
  const FirstContact first = first_contact(query_, motion, 1e-3 * size_, {.budget = kFewDistances});
  require(0 <= first.lower && first.lower <= first.upper && first.upper <= 1,
          "the first contact is not on the motion");
  if (!built_) return;
  const bool met = query_.intersects(motion.at(1)).answer == Answer::kYes;
  require(!met || first.status != FirstContact::Status::kNone, "a contact is passed through");
  require(
      verdict.answer != Answer::kYes || met || !motion.at(1).matrix().isApprox(pose.matrix(), 0),
      "a motion does not end at its end");
  if (first.status == FirstContact::Status::kContact) {
    require(query_.intersects(motion.at(first.upper)).answer == Answer::kYes,
            "there is no contact where the first one is");
  }
  require(!first.place || (first.place->distance >= first.distance.lower &&
                           first.place->distance <= first.distance.upper),
          "the place of the first contact has another distance");
  if (first.status == FirstContact::Status::kTouchesAtStart) return;
  for (const double part : {0.0, 0.25, 0.75, 0.96875}) {
    require(
        first.lower == 0 || query_.intersects(motion.at(part * first.lower)).answer != Answer::kYes,
        "there is a contact before the first one");
  }
}

void MeasureChecks::check_occlusion(const Eigen::Isometry3d& pose) {
  OcclusionOptions options;
  options.reach = 0.25 * size_;
  options.limits = {0.125 * size_, 0.0625 * size_, 0.1875 * size_};
  options.contact = options.foundation = 0.0625 * size_;
  options.change = 0.5 * options.foundation;
  options.least_area = 0;
  options.longest_edge = 0.125 * size_;
  Occlusion bite;
  if (!measures([&] { bite = occlusion(query_, pose, options); }, ErrorCode::kMemoryLimit)) {
    require(!built_, "small bodies need much memory");
    return;
  }
  require(bite.complete, "nobody stopped the occlusion");
  for (const SurfaceOcclusion* side : {&bite.fixed, &bite.moving}) {
    if (!built_) continue;
    const double rounding = 1e-9 * side->total_area;
    require(side->areas.size() == 3 && side->areas[1] <= side->areas[0] + rounding &&
                side->areas[0] <= side->areas[2] + rounding &&
                side->areas[2] <= side->total_area + rounding && 0 <= side->penetrating_area &&
                side->penetrating_area <= side->areas[1] + rounding,
            "a larger distance holds a smaller area");
    double share = 0, area = 0;
    for (const ContactRegion& region : side->regions) {
      require(region.centre.allFinite() && region.closest.allFinite(), "a region is nowhere");
      share += region.share;
      area += region.area;
    }
    require(side->regions.empty() || share == 0 || std::abs(share - 1) <= 1e-9,
            "shares are not the whole");
    require(std::abs(area - side->areas[1]) <= rounding, "regions are not the area in contact");
  }
}

}  // namespace ist::test
