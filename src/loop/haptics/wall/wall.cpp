#include "loop/haptics/wall/wall.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ist/base/ordered_vector.h"

namespace ist {
namespace {

constexpr std::size_t kMostBounds = 4096;
// Friction acts at gaps of so many skins.
constexpr double kGrip = 4;
// Bodies touch at gaps of so many skins.
constexpr double kTouch = 2;
// The most features that share the stiffness of so many whole ones (ToolContact).
constexpr double kFullFeatures = 10;

// The directions of the friction cone, round a circle.
constexpr double kDiagonal = 0.70710678118654752440;
constexpr double kCircle[8][2] = {
    {1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
    {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};

// Two unit vectors across a unit vector and each other. Source: T. Duff et al., Building an
// orthonormal basis, revisited, Journal of Computer Graphics Techniques 6(1), 2017.
std::pair<Eigen::Vector3d, Eigen::Vector3d> across(const Eigen::Vector3d& n) noexcept {
  const double sign = n[2] < 0 ? -1 : 1;
  const double a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
  return {{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}, {b, sign + n[1] * n[1] * a, -n[1]}};
}

}  // namespace

Wall::Wall(const WallSettings& settings)
    : settings_(settings), step_(settings.trust), motion_(kMostBounds) {
  bounds_.reserve(kMostBounds);
  contacts_.reserve(Tick::kMostPoints);
  noted_.reserve(Tick::kMostPoints);
}

void Wall::add(const HandPair& bodies, std::unique_ptr<WallPair> pair) {
  pairs_.push_back({bodies, std::move(pair), false});
}

void Wall::add_far(const HandPair& bodies) { far_.push_back(bodies); }

std::size_t Wall::bytes() const noexcept {
  std::size_t bytes = motion_.bytes() + bounds_.capacity() * sizeof(BoundOf);
  for (const Pair& pair : pairs_) bytes += pair.pair->bytes();
  return bytes;
}

// Returns a length that the distance of two bodies is not below, m.
double Wall::clearance(const HandBodies& bodies, const Pair& pair,
                       const Placement& tool) const noexcept {
  const auto [fixed, held] = pair.bodies;
  const double apart = bodies.gap(fixed, held, tool);
  if (apart > margin()) return apart;
  const BodyFrames frames = bodies.frames(fixed, held);
  return std::max(apart, frames.unit * pair.pair->clearance(frames.query_pose(tool)));
}

bool Wall::is_clear(const HandBodies& bodies, const Placement& tool, double way) const noexcept {
  const double needed = way + margin();
  const auto may_touch = [&](const HandPair& pair) {
    return bodies.may_touch(pair.fixed, pair.held);
  };
  return std::all_of(pairs_.begin(), pairs_.end(),
                     [&](const Pair& pair) {
                       return !may_touch(pair.bodies) || clearance(bodies, pair, tool) > needed;
                     }) &&
         std::all_of(far_.begin(), far_.end(), [&](const HandPair& pair) {
           return !may_touch(pair) || bodies.gap(pair.fixed, pair.held, tool) > needed;
         });
}

bool Wall::find(const HandBodies& bodies, const Placement& tool, double wanted,
                const Budget& budget, QueryResult& result, ToolContacts& contacts) noexcept {
  contacts.clear();
  trust_ = HUGE_VAL;
  DistanceInterval gaps{HUGE_VAL, HUGE_VAL};  // m
  Budget rest = budget;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    pair.asked = false;
    if (!bodies.may_touch(pair.bodies.fixed, pair.bodies.held)) continue;
    const double clear = clearance(bodies, pair, tool);
    if (clear > wanted + margin()) {
      gaps.lower = std::min(gaps.lower, clear);
      trust_ = std::min(trust_, clear - settings_.skin);
      continue;
    }
    pair.asked = true;
    const BodyFrames frames = bodies.frames(pair.bodies.fixed, pair.bodies.held);
    // Near pairs alone allow all steps of the trust. Only a longer way needs the distance.
    const double in_steps = settings_.steps * step_;
    const double beyond = wanted > in_steps ? wanted + margin() : 0;
    const WallPair::Search search = pair.pair->find(frames.query_pose(tool), margin() / frames.unit,
                                                    beyond / frames.unit, rest);
    result.sphere_tests += search.tests;
    if (search.found == Found::kFresh) result.found = Found::kFresh;
    if (result.found == Found::kClear) result.found = search.found;
    if (!search.complete) {
      result.complete = false;
      return false;
    }
    if (rest.has_tests()) rest.tests -= std::min(rest.tests, search.tests);
    const double gap = frames.unit * pair.pair->least_gap();
    gaps.lower = std::min(gaps.lower, gap);
    if (pair.pair->is_near()) gaps.upper = std::min(gaps.upper, gap);
    trust_ = std::min(trust_, pair.pair->is_near() ? step_ : gap - settings_.skin);
    pair.pair->list(FeatureList::Which::kMinima);
    contacts.begin_pair(i);
    contacts.pairs().back().drift = bodies.drift(pair.bodies.fixed, tool);
    add_to(contacts, pair, frames, tool);
  }
  for (const HandPair& pair : far_) {
    if (!bodies.may_touch(pair.fixed, pair.held)) continue;
    const double apart = bodies.gap(pair.fixed, pair.held, tool);
    gaps.lower = std::min(gaps.lower, apart);
    trust_ = std::min(trust_, apart - settings_.skin);
  }
  result.distance = {std::max(gaps.lower, 0.0) / bodies.unit(), gaps.upper / bodies.unit()};
  return trust_ > 0;
}

// Gives the nearest features to effects. A feature's part of the stiffness grows as its gap
// narrows, so that it appears without a jump.
void Wall::add_to(ToolContacts& contacts, const Pair& pair, const BodyFrames& frames,
                  const Placement& tool) const noexcept {
  const std::span<const Feature> features = pair.pair->features();
  const double share = 1 / std::max(1.0, static_cast<double>(features.size()) / kFullFeatures);
  for (const Feature& feature : features) {
    const double gap = frames.unit * feature.gap;
    if (gap <= kTouch * settings_.skin) contacts.count += 1;
    const double part = std::clamp((margin() - gap) / step_, 0.0, 1.0);
    contacts.add({frames.to_scene(feature.moving_point) - tool.translation,
                  frames.fixed.rotation * feature.normal, margin() - gap, share * part});
  }
}

bool Wall::is_near() const noexcept {
  return std::any_of(pairs_.begin(), pairs_.end(),
                     [](const Pair& pair) { return pair.asked && pair.pair->is_near(); });
}

void Wall::bound(const BoundOf& of, const Eigen::Vector3d& arm, double least,
                 const Vector6& drift) noexcept {
  Vector6 along;
  along.head<3>() = of.along;
  along.tail<3>() = cross_in_order(arm, of.along);
  double by_drift = 0;
  for (Eigen::Index i = 0; i < 6; ++i) by_drift += along[i] * drift[i];
  if (motion_.add(along, least + by_drift)) bounds_.push_back(of);
}

NearestMotion& Wall::bound(const HandBodies& bodies, const Placement& tool,
                           const Bounding& how) noexcept {
  motion_.clear();
  bounds_.clear();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    if (!pair.asked) continue;
    if (how.features == FeatureList::Which::kAll) pair.pair->list(how.features);
    const BodyFrames frames = bodies.frames(pair.bodies.fixed, pair.bodies.held);
    const Vector6 drift = bodies.drift(pair.bodies.fixed, tool);
    const std::span<const Feature> features = pair.pair->features();
    for (std::size_t k = 0; k < features.size(); ++k) {
      const Feature& feature = features[k];
      const double gap = frames.unit * feature.gap;
      const Eigen::Vector3d normal = frames.fixed.rotation * feature.normal;
      const Eigen::Vector3d arm = frames.to_scene(feature.moving_point) - tool.translation;
      double least = settings_.skin - gap;
      if (!how.asks_for_skin) least = std::min(least, 0.0);
      if (settings_.friction > 0 && gap <= kGrip * settings_.skin) {
        const auto [u, v] = across(normal);
        for (const auto& [a, b] : kCircle) {
          const Eigen::Vector3d slope =
              sum(normal, scaled(settings_.friction, sum(scaled(a, u), scaled(b, v))));
          bound({i, k, slope}, arm, least, drift);
        }
      } else {
        bound({i, k, normal}, arm, least, drift);
      }
    }
  }
  return motion_;
}

Answer Wall::meets(const HandBodies& bodies, const Placement& tool, double way,
                   const Budget& budget) noexcept {
  Answer answer = Answer::kNo;
  for (Pair& pair : pairs_) {
    if (!pair.asked) continue;
    const BodyFrames frames = bodies.frames(pair.bodies.fixed, pair.bodies.held);
    const Answer found = pair.pair->meets(frames.query_pose(tool), way / frames.unit, budget);
    if (found == Answer::kYes) return found;
    if (found != Answer::kNo) answer = found;
  }
  return answer;
}

void Wall::note_contacts(const HandBodies& bodies) noexcept {
  noted_.clear();
  const std::span<const NearestMotion::Push> pushes = motion_.pushes();
  std::size_t contact_of[Tick::kMostPoints];  // of a push
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    contact_of[i] = Tick::kMostPoints;
    if (!(pushes[i].force > 0)) continue;
    const BoundOf& of = bounds_[pushes[i].bound];
    // The directions of a feature's friction cone push at one contact.
    for (std::size_t k = 0; k < i; ++k) {
      const BoundOf& other = bounds_[pushes[k].bound];
      if (other.pair == of.pair && other.feature == of.feature) contact_of[i] = contact_of[k];
    }
    const Eigen::Vector3d force = scaled(pushes[i].force, of.along);
    if (contact_of[i] < Tick::kMostPoints) {
      noted_[contact_of[i]].force = sum(noted_[contact_of[i]].force, force);
      continue;
    }
    const Pair& pair = pairs_[of.pair];
    const BodyFrames frames = bodies.frames(pair.bodies.fixed, pair.bodies.held);
    const Feature& feature = pair.pair->features()[of.feature];
    contact_of[i] = noted_.size();
    noted_.push_back({frames.to_scene(feature.fixed_point), frames.fixed.rotation * feature.normal,
                      force, frames.unit * feature.gap, feature.triangles, pair.bodies.fixed,
                      pair.bodies.held});
  }
}

void Wall::forget() noexcept {
  for (Pair& pair : pairs_) pair.pair->forget();
}

Wall::Touch Wall::touch(const HandBodies& bodies, const Placement& tool, std::size_t body,
                        const Budget& budget) noexcept {
  Touch most = Touch::kApart;
  Budget rest = budget;
  for (Pair& pair : pairs_) {
    const auto [fixed, held] = pair.bodies;
    if (!bodies.may_touch(fixed, held) || (fixed != body && held != body)) continue;
    const BodyFrames frames = bodies.frames(fixed, held);
    const double reach = kTouch * settings_.skin / frames.unit;
    const WallPair::Search search = pair.pair->find(frames.query_pose(tool), reach, 0, rest);
    pair.pair->forget();
    pair.asked = false;
    if (!search.complete) return Touch::kUnknown;
    if (rest.has_tests()) rest.tests -= std::min(rest.tests, search.tests);
    if (!pair.pair->is_near()) continue;
    most = std::max(most, pair.pair->least_gap() > 0 ? Touch::kTouching : Touch::kMeeting);
  }
  for (const HandPair& pair : far_) {
    if (!bodies.may_touch(pair.fixed, pair.held) || (pair.fixed != body && pair.held != body)) {
      continue;
    }
    if (!(bodies.gap(pair.fixed, pair.held, tool) > 0)) return Touch::kUnknown;
  }
  return most;
}

}  // namespace ist
