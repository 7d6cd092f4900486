#include "ist/query/exact/triangle_pairs.h"

#include <algorithm>
#include <cmath>

#include "ist/query/exact/triangle_distance.h"

namespace ist {
namespace {

// Fewer candidates would only cost more passes.
constexpr std::size_t kFewest = 1 << 12;

// Returns a hash that assigns a pair to one of several passes.
std::uint64_t part_of(std::uint32_t fixed, std::uint32_t moving) {
  const std::uint64_t mixed = fixed * 0x9E3779B97F4A7C15U + moving * 0xD6E8FEB86659FD93U;
  return mixed >> 32;
}

double longest_edge(const NodeTriangles& triangles) {
  double squared = 0;
  for (std::uint32_t i = 0; i < triangles.count(); ++i) {
    const TriangleCorners& t = triangles.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      squared = std::max(squared, (t[k] - t[(k + 1) % 3]).squaredNorm());
    }
  }
  return std::sqrt(squared);
}

// Returns the distance of two boxes along the axis that separates them most; negative where they
// overlap.
float apart(const FloatBox& a, const FloatBox& b) {
  float most = a.low[0] - b.high[0];
  for (std::size_t i = 0; i < 3; ++i) {
    most = std::max({most, a.low[i] - b.high[i], b.low[i] - a.high[i]});
  }
  return most;
}

// The number of moving triangles tested against the lanes at a time.
constexpr std::size_t kAtATime = 64;

}  // namespace

TrianglePairs::TrianglePairs(const SphereTree& fixed, const SphereTree& moving,
                             FindNearFunction find_near, std::size_t candidates)
    : fixed_(fixed),
      moving_(moving),
      find_near_(find_near),
      origin_(fixed.origin()),
      seen_(std::max(candidates, kFewest)),
      moved_corners_(moving_.count()),
      moved_bounds_(moving_.count()),
      moved_(moving_.count()),
      last_seen_(moving_.count()),
      near_(moving_.count()),
      found_(kAtATime * TriangleLanes::kSize + kNearSlack),
      longest_edge_(std::max(longest_edge(fixed_), longest_edge(moving_))) {
  fixed_bounds_.reserve(fixed_.count());
  for (std::uint32_t i = 0; i < fixed_.count(); ++i) {
    fixed_bounds_.push_back(bounds_of(fixed_.corners(i), origin_));
  }
}

void TrianglePairs::begin(const Eigen::Isometry3d& pose) noexcept {
  rotation_ = pose.linear();
  translation_ = pose.translation();
  out_ = {};
  count_ = 0;
  full_ = false;
  passes_ = 1;
  pass_ = 0;
  seen_.clear();
  moved_count_ = 0;
  first_turn_ = turn_ + 1;
}

void TrianglePairs::begin(const Eigen::Isometry3d& pose, std::span<TrianglePair> out) noexcept {
  begin(pose);
  out_ = out;
  wanted_ = Wanted::kAll;
}

void TrianglePairs::begin_any(const Eigen::Isometry3d& pose) noexcept {
  begin(pose);
  wanted_ = Wanted::kAny;
}

void TrianglePairs::begin_nearest(const Eigen::Isometry3d& pose, double limit,
                                  double tolerance) noexcept {
  begin(pose);
  wanted_ = Wanted::kNearest;
  nearest_ = limit;
  tolerance_ = tolerance > 0 ? tolerance : 0;  // a NaN too
}

bool TrianglePairs::next_pass() noexcept {
  if (!full_) {
    if (++pass_ == passes_) return false;
  } else {  // begin again, in more passes
    passes_ *= 2;
    pass_ = 0;
    count_ = 0;
    full_ = false;
  }
  seen_.clear();
  return true;
}

bool TrianglePairs::take(std::span<const LeafPair> leaf_pairs) noexcept {
  for (std::size_t i = 0; i < leaf_pairs.size();) {
    const std::uint32_t node = leaf_pairs[i].fixed;
    const FloatBox cube = fixed_.cube(node);
    const float distance = reach();
    next_turn();
    for (; i < leaf_pairs.size() && leaf_pairs[i].fixed == node; ++i) {
      take_moving(leaf_pairs[i].moving, cube, distance);
    }
    std::span<const std::uint32_t> fixed = fixed_[node];
    while (near_count_ > 0 && !fixed.empty()) {
      const std::size_t count = std::min(fixed.size(), TriangleLanes::kSize);
      if (!try_lanes(fixed.first(count), cube)) return false;
      fixed = fixed.subspan(count);
    }
  }
  return true;
}

// Begins a turn in which no triangle was seen yet; turns of a query are consecutive.
void TrianglePairs::next_turn() noexcept {
  near_count_ = 0;
  if (++turn_ != 0) return;
  std::fill(last_seen_.begin(), last_seen_.end(), Seen());
  turn_ = first_turn_ = 1;
  moved_count_ = 0;
}

// Returns the search distance, rounded up to float and by the rounding of differences of floats.
float TrianglePairs::reach() const noexcept {
  return wanted_ == Wanted::kNearest ? static_cast<float>(within() * (1 + 0x1p-20)) : 0;
}

void TrianglePairs::take_moving(std::uint32_t node, const FloatBox& cube, float distance) noexcept {
  for (const std::uint32_t triangle : moving_[node]) {
    Seen& seen = last_seen_[triangle];
    if (seen.turn == turn_) continue;
    if (seen.turn < first_turn_) {
      seen.place = moved_count_++;
      moved_[seen.place] = triangle;
      moved_corners_[seen.place] = moved(moving_.corners(triangle));
      moved_bounds_[seen.place] = bounds_of(moved_corners_[seen.place], origin_);
    }
    seen.turn = turn_;
    near_[near_count_] = seen.place;
    near_count_ += apart(moved_bounds_[seen.place].box, cube) > distance ? 0U : 1U;
  }
}

// Tests some triangles of a fixed node against all that are near. Triangles that intersect do so in
// one of the fixed triangle's cubes, so only the part inside this cube is tested. Returns whether
// more pairs are wanted.
bool TrianglePairs::try_lanes(std::span<const std::uint32_t> fixed, const FloatBox& cube) noexcept {
  lanes_.count = 0;
  for (const std::uint32_t triangle : fixed) {
    TriangleBounds bounds = fixed_bounds_[triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      bounds.box.low[i] = std::max(bounds.box.low[i], cube.low[i]);
      bounds.box.high[i] = std::min(bounds.box.high[i], cube.high[i]);
    }
    lanes_.add(bounds);
  }
  for (std::size_t begin = 0; begin < near_count_; begin += kAtATime) {
    const std::size_t found =
        find_near_(lanes_, moved_bounds_.data(), near_.data() + begin,
                   std::min(kAtATime, near_count_ - begin), reach(), found_.data());
    for (std::size_t k = 0; k < found; ++k) {
      if (!try_pair(fixed[found_[k].lane], found_[k].triangle)) return false;
    }
  }
  return true;
}

// Tests a fixed triangle and the moving one at `place`. Returns whether more pairs are wanted.
bool TrianglePairs::try_pair(std::uint32_t fixed, std::uint32_t place) noexcept {
  const std::uint32_t moving = moved_[place];
  if (passes_ > 1 && (part_of(fixed, moving) & (passes_ - 1)) != pass_) return true;
  if (!remember(fixed, moving)) return !full_;
  const TriangleCorners &a = fixed_.corners(fixed), &b = moved_corners_[place];
  if (wanted_ == Wanted::kNearest) {
    measure(a, b);
    return nearest_ > 0;
  }
  if (!triangles_meet(a, b)) return true;
  add({fixed_.index(fixed), moving_.index(moving)});
  return wanted_ == Wanted::kAll;
}

// Returns whether a pair must be tested: it is new, as far as the set remembers.
bool TrianglePairs::remember(std::uint32_t fixed, std::uint32_t moving) noexcept {
  switch (seen_.insert(fixed, moving)) {
    case PairSet::Insertion::kNew:
      return true;
    case PairSet::Insertion::kKnown:
      return false;
    case PairSet::Insertion::kFull:
      break;
  }
  full_ = wanted_ == Wanted::kAll;
  if (!full_) seen_.clear();  // at worst a pair is tested twice
  return !full_;
}

TriangleCorners TrianglePairs::moved(const TriangleCorners& corners) const noexcept {
  const Eigen::Matrix3d& r = rotation_;
  TriangleCorners moved;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& v = corners[k];
    for (Eigen::Index i = 0; i < 3; ++i) {
      moved[k][i] = ((r(i, 0) * v[0] + r(i, 1) * v[1]) + r(i, 2) * v[2]) + translation_[i];
    }
  }
  return moved;
}

// A full span is a heap of the first pairs seen so far, with the last of them on top.
void TrianglePairs::add(TrianglePair pair) noexcept {
  const std::uint64_t room = out_.size();
  if (count_ < room) {
    out_[count_++] = pair;
    if (count_ == room) std::make_heap(out_.begin(), out_.end());
    return;
  }
  ++count_;
  if (room == 0 || !(pair < out_[0])) return;
  std::pop_heap(out_.begin(), out_.end());
  out_.back() = pair;
  std::push_heap(out_.begin(), out_.end());
}

void TrianglePairs::measure(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  const double boxes = box_distance_squared(a, b);
  const double enough = within();
  if (boxes > enough * enough || surely_farther(a, b, enough)) return;
  if (boxes == 0 && triangles_meet(a, b)) {
    nearest_ = 0;
    return;
  }
  nearest_ = std::min(nearest_, std::sqrt(distance_squared(a, b)));
}

double TrianglePairs::within() const noexcept {
  return std::max(0.0, nearest_ + 2 * distance_error() - tolerance_);
}

double TrianglePairs::distance_error() const noexcept {
  return nearest_ > 0 ? kTriangleDistanceError * (longest_edge_ + nearest_) : 0;
}

void TrianglePairs::finish() noexcept {
  const auto found = out_.first(std::min<std::uint64_t>(count_, out_.size()));
  std::sort(found.begin(), found.end());
}

std::size_t TrianglePairs::bytes() const noexcept {
  return fixed_.bytes() + moving_.bytes() + seen_.bytes() +
         (fixed_bounds_.size() + moved_bounds_.size()) * sizeof(TriangleBounds) +
         moved_corners_.size() * sizeof(TriangleCorners) + last_seen_.size() * sizeof(Seen) +
         (moved_.size() + near_.size()) * sizeof(std::uint32_t) + found_.size() * sizeof(NearPair);
}

}  // namespace ist
