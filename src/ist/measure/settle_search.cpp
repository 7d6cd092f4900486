#include "ist/measure/settle_search.h"

#include <algorithm>
#include <cmath>

#include "ist/base/ordered_vector.h"
#include "ist/measure/require.h"
#include "ist/tree/tree_parts.h"

namespace ist {
namespace {

// Lengths in millimetres.
constexpr double kFirstTrust = 0.1, kMostTrust = 0.3;
constexpr double kLastTrust = 0.01;        // at the beginning of the last part
constexpr double kSkins[] = {1e-3, 1e-4};  // gaps that stay open, one part after the other
constexpr double kClearance = 0.05;        // tolerance of a distance
// Parts of the skin: a gain that ends a search, and a trust.
constexpr double kLeastGain = 1e-6, kLeastTrust = 1e-5;
// Near pairs are listed to so many times the trust.
constexpr double kListed = 2;
// Normals of features ascend by so much, a sine. Curved surfaces have features that bind only after
// a part of a step.
constexpr double kSlope = 0.2;
// A step is tried again if it keeps a smaller part of its promise.
constexpr double kKept = 0.1, kPoor = 0.3, kGood = 0.7;
// The pull in the radius of trust grows until the step is this part of the trust.
constexpr double kLong = 0.7;
constexpr double kMostPull = 1e4;
constexpr double kWithin = 0.999;
constexpr std::size_t kSearchPairs = 1 << 14, kMostSearchPairs = 1 << 18;
constexpr std::size_t kFeatures = 4096;

const TriangleMesh& mesh_of(const SphereTree& tree, const char* name) {
  require_triangles(tree, name);
  return parts_of(tree).triangles->mesh;
}

double dot6(const Vector6& a, const Vector6& b) noexcept {
  double sum = 0;
  for (Eigen::Index i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

double length6(const Vector6& a) noexcept { return std::sqrt(dot6(a, a)); }

}  // namespace

detail::SettleBodies::SettleBodies(const Query& query)
    : fixed(mesh_of(query.fixed(), "fixed")), moving(mesh_of(query.moving(), "moving")) {}

SettleSearch::SettleSearch(Query& query, const detail::SettleBodies& bodies,
                           const SettleFrame& frame, const SettleLoad& load)
    : query_(query),
      frame_(frame),
      load_(load),
      pull_(Vector6::Zero()),
      near_(kSearchPairs),
      features_(bodies.fixed, bodies.moving, kFeatures),
      nearest_(kFeatures + 12),
      trust_(kFirstTrust * load.millimetre),
      skin_(kSkins[0] * load.millimetre) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    pull_[i] = load.held[static_cast<std::size_t>(i)] ? 0 : load.closing[i];
  }
  bounds_.reserve(kFeatures);
}

Vector6 SettleSearch::moved(const Vector6& at, const Vector6& motion) const noexcept {
  Vector6 to;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const double change = i < 3 ? motion[i] : motion[i] / load_.radius;
    to[i] = std::clamp(at[i] + change, -load_.limits[i], load_.limits[i]);
  }
  return to;
}

double SettleSearch::missing() const noexcept {
  return near_count_ > 0 ? std::max(0.0, skin_ - near_.front().distance) : 0;
}

// Finds the near pairs. Returns whether the query answered.
bool SettleSearch::look(const Vector6& at) {
  const double margin = kListed * trust_ + skin_;
  for (;;) {
    const NearPairsResult found = query_.near_pairs(frame_.pose_at(at), margin, near_);
    near_count_ = static_cast<std::size_t>(std::min<std::uint64_t>(found.near_pairs, near_.size()));
    if (found.status != QueryStatus::kDone) return false;
    if (!found.truncated || near_.size() >= kMostSearchPairs) return true;
    near_.resize(2 * near_.size());
  }
}

// Makes the bounds that a step within the trust can meet.
void SettleSearch::bound(const Vector6& at, FeatureList::Which which) {
  features_.find(std::span(near_).first(near_count_), frame_.pose_at(at), kListed * trust_ + skin_,
                 which, kSlope);
  const Eigen::Vector3d load = frame_.load_at(at);
  bounds_.clear();
  for (const Feature& feature : features_.features()) {
    const Eigen::Vector3d arm = difference(feature.moving_point, load);
    Bound bound{frame_.bound_at(at, feature.normal, arm), skin_ - feature.gap};
    for (Eigen::Index i = 0; i < 6; ++i) {
      if (i >= 3) bound.along[i] /= load_.radius;
      if (load_.held[static_cast<std::size_t>(i)]) bound.along[i] = 0;
    }
    if (-bound.least < length6(bound.along) * trust_) bounds_.push_back(bound);
  }
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (load_.held[static_cast<std::size_t>(i)]) continue;
    const double scale = i < 3 ? 1 : load_.radius;
    for (const double sign : {1.0, -1.0}) {
      const double left = scale * (load_.limits[i] - sign * at[i]);
      if (!(left < trust_)) continue;
      Bound bound{Vector6::Zero(), -left};
      bound.along[i] = -sign;
      bounds_.push_back(bound);
    }
  }
}

bool SettleSearch::solve(double pull, bool restores) {
  nearest_.clear();
  for (const Bound& bound : bounds_) {
    nearest_.add(bound.along, restores ? bound.least : std::min(bound.least, 0.0));
  }
  return nearest_.solve(Matrix6::Identity(), pull * pull_, 1e-7 * trust_);
}

// Returns the step within the trust that closes farthest.
SettleSearch::Step SettleSearch::step(double missing) {
  Step step;
  step.motion.setZero();
  step.restores = missing > 0;
  double low = 0, high = 0, pull = trust_;
  for (int i = 0; i < 24; ++i) {
    if (!solve(pull, step.restores)) {
      if (!step.restores || low > 0) break;
      step.restores = false;
      continue;
    }
    const Vector6 motion = nearest_.motion();
    const double length = length6(motion);
    if (length > trust_) {
      high = pull;
      if (low == 0 && i > 8) {  // restoring alone is longer than the trust
        step.motion = (trust_ / length) * motion;
        break;
      }
      pull = low > 0 ? 0.5 * (low + high) : 0.25 * pull;
      continue;
    }
    step.motion = motion;
    low = pull;
    double force = 0;
    for (const NearestMotion::Push& push : nearest_.pushes()) force += push.force;
    penalty_ = std::max(penalty_, std::min(2 * force / pull, 1e3));
    if (length > kLong * trust_ || pull >= kMostPull * trust_) break;
    pull = high > 0 ? 0.5 * (low + high) : 4 * pull;
  }
  step.gain = dot6(pull_, step.motion);
  step.length = length6(step.motion);
  return step;
}

// Moves along the load while the surfaces are farther apart than the trust.
SettleSearch::End SettleSearch::close_gap(Vector6& at, bool& moved_on) {
  moved_on = false;
  const DistanceResult distance =
      query_.distance(frame_.pose_at(at), kClearance * load_.millimetre);
  if (distance.status != QueryStatus::kDone) return End::kBusy;
  const double way = kWithin * (distance.distance.lower - skin_) / length6(pull_);
  if (!(way > trust_)) return End::kDone;
  const Vector6 to = moved(at, way * pull_);
  moved_on = dot6(pull_, to - at) > 0.5 * trust_;
  if (moved_on) at = to;
  return End::kDone;
}

SettleSearch::End SettleSearch::run(Vector6& at, int most_steps, const Proceed& proceed) {
  std::size_t part = 0;
  bool is_seen = false;
  for (; steps_ < most_steps; ++steps_) {
    if (proceed && !proceed(static_cast<double>(steps_) / most_steps)) return End::kStopped;
    if (!is_seen) {
      if (!look(at)) return End::kBusy;
      is_seen = true;
    }
    if (near_count_ == 0) {
      bool moved_on = false;
      if (const End end = close_gap(at, moved_on); end != End::kDone) return end;
      if (moved_on) {
        is_seen = false;
        continue;
      }
    }
    const double before = missing();
    bool is_made = false;
    for (const FeatureList::Which which : {FeatureList::Which::kMinima, FeatureList::Which::kAll}) {
      bound(at, which);
      const Step made = step(before);
      const double promised = made.gain + (made.restores ? penalty_ * before : 0);
      if (!(promised > kLeastGain * skin_) || trust_ < kLeastTrust * skin_) {
        if (++part == std::size(kSkins)) return End::kDone;
        skin_ = kSkins[part] * load_.millimetre;
        trust_ = std::max(trust_, kLastTrust * load_.millimetre);
        is_seen = false;
        is_made = true;
        break;
      }
      const Vector6 to = moved(at, made.motion);
      const Answer meets = query_.intersects(frame_.pose_at(to)).answer;
      if (meets == Answer::kUnknown) return End::kBusy;
      if (meets == Answer::kYes) continue;
      if (!look(to)) return End::kBusy;
      is_made = true;
      const double gained = dot6(pull_, to - at) + penalty_ * (before - missing());
      if (gained < kKept * promised) {
        trust_ = 0.25 * std::min(trust_, made.length);
        is_seen = false;
      } else {
        at = to;
        if (gained < kPoor * promised) trust_ *= 0.5;
        const double most = kMostTrust * load_.millimetre;
        if (gained > kGood * promised && made.length > kLong * trust_ && trust_ < most) {
          trust_ = std::min(2 * trust_, most);
          is_seen = false;
        }
      }
      break;
    }
    if (!is_made) trust_ *= 0.5;
  }
  return End::kStopped;
}

}  // namespace ist
