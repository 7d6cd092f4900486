#include "stability/sweep.h"

#include <algorithm>
#include <cmath>

#include "ist/query/contacts/contact_reducer.h"
#include "ist/query/query_rules.h"
#include "ist/tree/tree_parts.h"
#include "query/contacts/contact_cases.h"
#include "query/query_cases.h"
#include "stability/hard_pair.h"
#include "support/rigid_pose.h"
#include "verify/read_bounds.h"

namespace ist::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// What angles and lengths of a step are rounded by, in parts of it.
constexpr double kRounded = 1 + 1e-6;

std::string title(const std::string& what, SpherePolicy policy) {
  return what + ", " + std::string(to_string(policy));
}

QueryOptions with(SpherePolicy policy) {
  QueryOptions options;
  options.policy = policy;
  return options;
}

}  // namespace

Path line(const Isometry3d& from, const Vector3d& direction, double step, int steps) {
  return {[=](int k) -> Isometry3d { return shift(step * k * direction) * from; }, steps,
          kRounded* step, kRounded* step, true};
}

Path turn(const Isometry3d& from, const Vector3d& axis, const Vector3d& centre, double lever,
          double reach, double step, int steps) {
  return {[=](int k) -> Isometry3d {
            return from * Eigen::Translation3d(centre) * Eigen::AngleAxisd(step * k / lever, axis) *
                   Eigen::Translation3d(-centre);
          },
          steps, kRounded* step, kRounded* step* reach / lever, false};
}

MotionCases::MotionCases(const std::string& what, SpherePolicy policy)
    : edges("motion", title(what, policy) + ": where pairs come and go",
            "mm that bounds are apart, or overlap"),
      once("motion", title(what, policy) + ": each pair once",
           "mm that bounds overlap where the pair is missing"),
      gap("motion", title(what, policy) + ": gap", "mm of change"),
      sums("motion", title(what, policy) + ": sums", "change over rate and motion"),
      depth("motion", title(what, policy) + ": depth", "mm of change") {}

Sweep::Sweep(const SphereTree& fixed, const SphereTree& moving, const SphereTree& plain_fixed,
             const SphereTree& plain_moving, SpherePolicy policy, MotionCases& cases)
    : fixed_(plain_fixed),
      moving_(plain_moving),
      policy_(policy),
      cases_(cases),
      exact_(fixed, moving, with(policy)),
      plain_(plain_fixed, plain_moving, with(policy)),
      points_(plain_fixed, plain_moving, policy, {.margin = 2}),
      contacts_(plain_fixed, plain_moving, policy, {.margin = 2}) {}

void Sweep::along(const Path& path) {
  last_seen_.clear();
  Step before = look(path.at(0));
  for (const LeafPair& c : before.pairs) last_seen_[std::uint64_t{c.fixed} << 32 | c.moving] = 0;
  for (int k = 1; k <= path.steps; ++k) {
    Step now = look(path.at(k));
    compare_pairs(before, now);
    if (path.straight) find_returns(path, k, now);
    compare_gap(before, now, path.way);
    compare_sums(before, now, path.motion);
    compare_depths(before, now, path.motion);
    before = std::move(now);
  }
}

Sweep::Step Sweep::look(const Isometry3d& pose) {
  FoundPairs answer = ask(plain_, pose);
  static_cast<void>(plain_.contacts(pose, points_));
  const double s = ContactScale(fixed_, moving_).size;
  double stretched = 0;
  for (const Contact& p : points_.points()) stretched += p.weight * (p.depth + 2 * s);
  return {pose,
          answer.result.pad,
          std::move(answer.leaf_pairs),
          points_.sums(),
          stretched,
          exact_.distance(pose, 0).distance,
          plain_.distance(pose, 0).distance};
}

double Sweep::overlap(const LeafPair& pair, const Isometry3d& pose) const {
  return leaf_overlap(fixed_, moving_, policy_, between_frames(pose, fixed_, moving_), pair);
}

// A pair is in an answer only if nothing over it is farther apart than the pad, and is out of one
// only if something is apart.
void Sweep::compare_pairs(const Step& before, const Step& now) {
  const double doubles = pad_in_double(fixed_.bounding_radius() + moving_.bounding_radius(),
                                       fixed_.bounding_radius() + moving_.bounding_radius());
  for (const bool left : {true, false}) {
    const Step &in = left ? before : now, &out = left ? now : before;
    std::vector<LeafPair> changed;
    std::set_difference(in.pairs.begin(), in.pairs.end(), out.pairs.begin(), out.pairs.end(),
                        std::back_inserter(changed));
    for (const LeafPair& pair : changed) {
      cases_.edges.sample(std::max(0.0, -overlap(pair, in.pose)), in.pad, "in");
      cases_.edges.sample(std::max(0.0, overlap(pair, out.pose)), doubles, "out");
    }
    changes_ += changed.size();
  }
}

void Sweep::find_returns(const Path& path, int step, const Step& now) {
  double worst = 0;
  for (const LeafPair& pair : now.pairs) {
    const auto [seen, is_new] =
        last_seen_.try_emplace(std::uint64_t{pair.fixed} << 32 | pair.moving, step);
    for (int missing = seen->second + 1; missing < step; ++missing) {
      worst = std::max(worst, std::abs(overlap(pair, path.at(missing))));
    }
    seen->second = step;
  }
  cases_.once.samples_of(std::max<std::size_t>(now.pairs.size(), 1), worst, now.pad);
}

void Sweep::compare_gap(const Step& before, const Step& now, double way) {
  const auto middle = [](const DistanceInterval& gap) { return 0.5 * (gap.lower + gap.upper); };
  const auto half = [](const DistanceInterval& gap) { return 0.5 * (gap.upper - gap.lower); };
  cases_.gap.sample(std::abs(middle(now.exact) - middle(before.exact)),
                    way + half(now.exact) + half(before.exact));
  // Those without triangles are wide: no farther apart, then.
  cases_.gap.sample(
      std::max({0.0, now.plain.lower - before.plain.upper, before.plain.lower - now.plain.upper}),
      way, "without triangles");
  cases_.gap.sample(
      std::max({0.0, now.plain.lower - now.exact.upper, now.exact.lower - now.plain.upper}), 0,
      "between both");
}

void Sweep::compare_sums(const Step& before, const Step& now, double motion) {
  const ContactSums &a = before.sums, &b = now.sums;
  const auto pairs = static_cast<double>(a.pairs + b.pairs);
  if (a.pairs + b.pairs == 0) return;
  const ContactRates& rates = points_.rates();
  motion += 2 * rounding_of(fixed_, points_);
  const auto sample = [&](double change, double rate, const char* what) {
    cases_.sums.sample(change / (rate * motion * pairs), 1, what);
  };
  sample(std::abs(b.weight - a.weight), rates.weight, "weight");
  sample((b.pressure.force - a.pressure.force).norm(), rates.pressure_force, "pressure");
  sample((b.pressure.torque - a.pressure.torque).norm(), rates.pressure_torque, "its torque");
  sample((b.spring.force - a.spring.force).norm(), rates.spring_force, "spring");
  sample((b.spring.torque - a.spring.torque).norm(), rates.spring_torque, "its torque");
  sample(std::abs(now.stretched - before.stretched), rates.spring_force, "depth by weight");
}

void Sweep::compare_depths(const Step& before, const Step& now, double motion) {
  const ContactScale scale(fixed_, moving_, 2);
  for (std::size_t i = 0; i < now.pairs.size(); i += 1 + now.pairs.size() / 8) {
    const PlainPair a = contacts_.at(now.pairs[i], before.pose),
                    b = contacts_.at(now.pairs[i], now.pose);
    const double mean_normal = std::min(a.mean_normal, b.mean_normal);
    if (!(mean_normal > 0)) continue;  // no direction, no weight, no depth
    cases_.depth.sample(std::abs(b.depth - a.depth),
                        motion * depth_rate(scale, points_.rates().lever, mean_normal));
  }
}

}  // namespace ist::test
