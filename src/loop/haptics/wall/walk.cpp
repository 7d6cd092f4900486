#include "loop/haptics/wall/walk.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

constexpr int kHalvings = 6;
// A motion shorter than this part of the trust is not made: a tool at rest keeps its bits.
constexpr double kStill = 1e-6;
// The part of the trust that a fixed body may use by its own motion.
constexpr double kDriftPart = 0.5;
// The part of a way that a step may go, for rounding.
constexpr double kWithin = 0.999;
// A motion that is so many times as long as the wanted one, or as the trust, opens no gap.
constexpr double kLong = 8;
// Ticks without a distance after a held one. A distance takes longer than near pairs.
constexpr int kCareful = 8;
// The least part of the trust in use.
constexpr double kLeastPart = 1.0 / 16;

// Returns the largest part of `step`, at most 1, with |way - part * step| <= most. Returns 0 if
// there is none.
double part_within(const Eigen::Vector3d& way, const Eigen::Vector3d& step, double most) noexcept {
  // A step that is long enough to be cut is too long to underflow.
  if (length_in_order(difference(way, step)) <= most) return 1;
  const double a = square_in_order(step), b = dot_in_order(way, step);
  const double spare = std::max(0.0, most * most - square_in_order(way));
  if (!(a > 0)) return 1;
  return std::clamp((b + std::sqrt(b * b + a * spare)) / a, 0.0, 1.0);
}

}  // namespace

class Walk::Step {
 public:
  // `left` is the rest of the scripts' time in this tick, s.
  Step(const Parts& parts, Placement& tool, double& time, double left) noexcept
      : parts_(parts), tool_(tool), time_(time), part_(left) {
    look_ahead();
  }

  // The most that a fixed body moves against the tool in this step, m.
  [[nodiscard]] double drift() const noexcept { return drift_; }

  // Shortens the step so that no fixed body moves farther than its part of the trust.
  void limit_drift() noexcept {
    const double most = kDriftPart * parts_.wall.trust();
    for (int i = 0; i < 64 && drift_ > most; ++i) {
      part_ *= std::min(0.5, kWithin * most / drift_);
      look_ahead();
    }
    if (drift_ > most) {
      part_ = 0;
      look_ahead();
    }
  }

  // Makes a motion without a proof.
  void go(const Vector6& motion) noexcept {
    tool_ = tool_.moved(motion);
    time_ += part_;
    made_ = motion;
  }

  // Makes a part of a motion if its end is free. Returns whether the tool would meet a body there.
  Answer try_part(double fraction, const Vector6& motion, const Budget& budget) noexcept {
    const Vector6 wanted = push_ + fraction * (motion - push_);
    const double way = parts_.tool.way(wanted);
    if (part_ == 0 && way <= kStill * parts_.wall.settings().trust) return Answer::kNo;
    const Placement there = tool_.moved(wanted);
    place(time_ + part_, 0);
    const Answer meets = parts_.wall.meets(parts_.bodies, there, way + drift_, budget);
    if (meets == Answer::kNo) {
      tool_ = there;
      time_ += part_;
      made_ = wanted;
    } else {
      look_ahead();
    }
    return meets;
  }

  // Returns the part of a motion that the trust allows, at most `part`. Fixed bodies that move push
  // the tool by the least motion that obeys the bounds. The part counts beyond this push.
  double fraction_of(const Vector6& motion, double part) noexcept {
    const double way = parts_.tool.way(motion), most = parts_.wall.trust() - drift_;
    push_.setZero();
    if (way <= most && part == 1) return 1;
    if (drift_ > 0) {
      const double radius = std::max(parts_.tool.radius(), most);
      Matrix6 metric = Matrix6::Identity();
      metric.bottomRightCorner<3, 3>() *= radius * radius;
      NearestMotion& bounds = parts_.wall.bounds();
      if (bounds.solve(metric, Vector6::Zero(), parts_.wall.tolerance())) push_ = bounds.motion();
    }
    if (way <= most) return part;
    const double pushed = parts_.tool.way(push_), left = kWithin * most - pushed;
    if (left > 0) return std::min(part, left / (way - pushed));
    // A wedge pushes the tool farther than it moves itself: it waits for a part of its step.
    const double whole = kWithin * parts_.wall.trust();
    shorten(whole / (pushed + kWithin * drift_));
    return 0;
  }

  // Makes the step of fixed bodies, and the push by it, shorter.
  void shorten(double by) noexcept {
    part_ *= by;
    push_ *= by;
    look_ahead();
  }
  [[nodiscard]] bool is_pushed() const noexcept { return !push_.isZero(0); }

  [[nodiscard]] double part() const noexcept { return part_; }
  // The motion that the tool made.
  [[nodiscard]] const Vector6& made() const noexcept { return made_; }

 private:
  void place(double time, double step) noexcept {
    if (parts_.bodies.has_scripts()) parts_.bodies.set_time(time, step);
  }
  void look_ahead() noexcept {
    place(time_, part_);
    drift_ = 0;
    if (!parts_.bodies.has_scripts()) return;
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
      if (parts_.bodies.is_held(i)) continue;
      drift_ = std::max(drift_, parts_.tool.way(parts_.bodies.drift(i, tool_)));
    }
  }

  const Parts& parts_;
  Placement& tool_;
  double& time_;
  double part_, drift_ = 0;
  Vector6 push_ = Vector6::Zero(), made_ = Vector6::Zero();
};

Walk::End Walk::run(Placement& tool, double& time, const Goal& goal,
                    ToolContacts& contacts) noexcept {
  const auto& [bodies, wall, body, effects, coupling, dt] = parts_;
  const Placement start = tool;
  Budget rest = goal.budget;
  End end;
  double left = bodies.has_scripts() ? dt : 0;
  wall.drop_contacts();
  // A tick that is replayed makes the same steps, and knows no more. The next ticks ask for less.
  const auto hold = [&] {
    end.held = true;
    near_ = false;
    careful_ = kCareful;
    part_ = std::max(kLeastPart, 0.5 * part_);
    wall.forget();
  };
  const bool asks_distance = careful_ == 0;
  careful_ -= careful_ > 0 ? 1 : 0;
  wall.shorten_steps(part_);
  const double next_part = std::min(1.0, 2 * part_);
  const int most = std::min(goal.steps, wall.settings().steps);
  bool is_done = false;
  while (end.steps < most && !is_done) {
    Step step(parts_, tool, time, left);
    const Vector6 ahead = goal.device_motion - motion_between(start, tool);
    const VirtualCoupling::Stretch stretch{motion_between(tool, goal.device), ahead, dt};
    const Placement here = tool;
    const EffectInput input{here, contacts, goal.proximity, dt};
    const auto motion = [&](NearestMotion* bounds) {
      return body.motion(input, effects, coupling, stretch, bounds, wall.tolerance());
    };

    // Returns the part of a motion that keeps the rate of the coupling's stretch. The stretch
    // changes by the device's way and so many steps of the trust at most. A tool that leaves a
    // contact returns to the hand at this rate.
    const auto part_at_rate = [&](const Vector6& wanted, int steps) {
      const double way = steps * wall.settings().trust;
      const double turn = way / std::max(body.radius(), way);
      const Vector6& device = goal.device_motion;
      return std::min(
          part_within(ahead.head<3>(), wanted.head<3>(), length_in_order(device.head<3>()) + way),
          part_within(ahead.tail<3>(), wanted.tail<3>(), length_in_order(device.tail<3>()) + turn));
    };

    double wanted = 0;
    if (!near_) {
      contacts.clear();
      std::optional<Vector6> freely = motion(nullptr);
      if (!freely) {
        end.finite = false;
        return end;
      }
      *freely *= part_at_rate(*freely, wall.settings().steps);
      wanted = body.way(*freely) + step.drift();
      if (wall.is_clear(bodies, tool, wanted)) {
        step.go(*freely);
        effects.advance(input, *freely);
        ++end.steps;
        part_ = next_part;
        return end;
      }
    }
    const std::uint64_t before = end.search.sphere_tests;
    if (!wall.find(bodies, tool, asks_distance ? wanted : 0, rest, end.search, contacts)) {
      hold();
      return end;
    }
    if (rest.has_tests()) {
      rest.tests -= std::min(rest.tests, end.search.sphere_tests - before);
    }
    near_ = wall.is_near();
    step.limit_drift();

    using Which = FeatureList::Which;
    Answer meets = Answer::kUnknown;
    bool is_whole = false;
    for (const Which which : {Which::kMinima, Which::kAll}) {
      NearestMotion& bounds = wall.bound(bodies, tool, {which});
      std::optional<Vector6> bounded = motion(&bounds);
      // A slot between nearly parallel walls opens by a far too long way along it.
      const double longest = kLong * (body.way(stretch.length) + wall.settings().trust);
      if (bounded && (!bounds.is_feasible() || body.way(*bounded) > longest)) {
        bounded = motion(&wall.bound(bodies, tool, {which, /*asks_for_skin=*/false}));
      }
      if (!bounded) {
        end.finite = false;
        return end;
      }
      if (!bounds.is_feasible() && step.drift() > 0) {  // the tool cannot yield
        hold();
        return end;
      }
      wall.note_contacts(bodies);
      double fraction =
          step.fraction_of(*bounded, near_ ? 1 : part_at_rate(*bounded, end.steps + 1));
      is_whole = fraction == 1;
      meets = step.try_part(fraction, *bounded, rest);
      if (meets == Answer::kYes) {
        is_whole = false;
        if (which == Which::kMinima) continue;
        for (int i = 0; i < kHalvings && meets == Answer::kYes; ++i) {
          fraction *= 0.5;
          meets = step.try_part(fraction, *bounded, rest);
        }
        for (int i = 0; i < kHalvings && meets == Answer::kYes && step.is_pushed(); ++i) {
          step.shorten(0.5);
          meets = step.try_part(0, *bounded, rest);
        }
        // A replay does not make a step that ended nowhere.
        if (meets == Answer::kNo) end.halved = true;
      }
      if (meets == Answer::kNo) effects.advance(input, step.made());
      break;
    }
    if (meets != Answer::kNo) {
      hold();
      return end;
    }
    wall.keep_contacts();
    ++end.steps;
    left -= step.part();
    is_done = is_whole && left <= 0;
  }
  if (most < wall.settings().steps && !is_done) {
    hold();
  } else {
    part_ = next_part;
  }
  return end;
}

}  // namespace ist
