#include "ist/query/exact/triangle_pairs.h"

#include <algorithm>
#include <cmath>

#include "ist/base/assert.h"
#include "ist/query/exact/triangle_distance.h"

namespace ist {
namespace {

// The corners' bounding boxes; closed, and no rounding in it.
bool boxes_apart(const TriangleCorners& a, const TriangleCorners& b) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto [a_low, a_high] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b_low, b_high] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (a_high < b_low || b_high < a_low) return true;
  }
  return false;
}

// Fewer would only make for more passes.
constexpr std::size_t kFewest = 1 << 12;

// Which of some passes a pair belongs to.
std::uint64_t part_of(std::uint32_t fixed, std::uint32_t moving) {
  const std::uint64_t mixed = fixed * 0x9E3779B97F4A7C15U + moving * 0xD6E8FEB86659FD93U;
  return mixed >> 32;
}

// A number that is none of the stamps.
void next(std::uint32_t& stamp, std::vector<std::uint32_t>& stamps) {
  if (++stamp != 0) return;
  std::fill(stamps.begin(), stamps.end(), 0);
  stamp = 1;
}

double longest_edge(const TriangleMesh& mesh) {
  double squared = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      squared =
          std::max(squared, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).squaredNorm());
    }
  }
  return std::sqrt(squared);
}

const LeafTriangles& triangles_of(const SphereTree& tree) {
  IST_ASSERT(tree.triangles().has_value());
  return *tree.triangles();
}

}  // namespace

TrianglePairs::TrianglePairs(const SphereTree& fixed, const SphereTree& moving,
                             std::size_t candidates)
    : fixed_(triangles_of(fixed)),
      moving_(triangles_of(moving)),
      seen_(std::max(candidates, kFewest)),
      moved_(moving_.mesh.vertices.size()),
      moved_in_(moving_.mesh.vertices.size(), 0),
      near_(moving_.mesh.triangles.size() + 1),
      near_leaf_(moving_.mesh.triangles.size(), 0),
      longest_edge_(std::max(longest_edge(fixed_.mesh), longest_edge(moving_.mesh))) {}

void TrianglePairs::begin(const Eigen::Isometry3d& pose) noexcept {
  pose_ = pose;
  out_ = {};
  count_ = 0;
  full_ = false;
  passes_ = 1;
  pass_ = 0;
  seen_.clear();
  next(query_, moved_in_);
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

void TrianglePairs::begin_nearest(const Eigen::Isometry3d& pose, double limit) noexcept {
  begin(pose);
  wanted_ = Wanted::kNearest;
  nearest_ = limit;
}

bool TrianglePairs::next_pass() noexcept {
  if (!full_) {
    if (++pass_ == passes_) return false;
  } else {  // from the beginning, in more parts
    passes_ *= 2;
    pass_ = 0;
    count_ = 0;
    full_ = false;
  }
  seen_.clear();
  return true;
}

bool TrianglePairs::take(std::span<const Contact> contacts) noexcept {
  for (std::size_t i = 0; i < contacts.size();) {
    const std::uint32_t leaf = contacts[i].fixed;
    next(leaf_, near_leaf_);
    std::size_t count = 0;
    for (; i < contacts.size() && contacts[i].fixed == leaf; ++i) {
      for (const std::uint32_t moving : moving_.lists[contacts[i].moving]) {
        near_[count] = moving;
        count += near_leaf_[moving] != leaf_ ? 1U : 0U;
        near_leaf_[moving] = leaf_;
      }
    }
    for (const std::uint32_t fixed : fixed_.lists[leaf]) {
      for (std::size_t k = 0; k < count; ++k) {
        if (!try_pair(fixed, near_[k])) return false;
      }
    }
  }
  return true;
}

// Whether more pairs are wanted.
bool TrianglePairs::try_pair(std::uint32_t fixed, std::uint32_t moving) noexcept {
  if (passes_ > 1 && (part_of(fixed, moving) & (passes_ - 1)) != pass_) return true;
  switch (seen_.insert(fixed, moving)) {
    case PairSet::Insertion::kKnown:
      return true;
    case PairSet::Insertion::kFull:
      if (wanted_ == Wanted::kAll) {
        full_ = true;
        return false;
      }
      seen_.clear();  // tested twice at worst
      break;
    case PairSet::Insertion::kNew:
      break;
  }
  const TriangleMesh &a = fixed_.mesh, &b = moving_.mesh;
  const Triangle &in_a = a.triangles[fixed], &in_b = b.triangles[moving];
  const TriangleCorners corners_a = {a.vertices[in_a[0]], a.vertices[in_a[1]], a.vertices[in_a[2]]};
  const TriangleCorners corners_b = {moved(in_b[0]), moved(in_b[1]), moved(in_b[2])};
  if (wanted_ == Wanted::kNearest) {
    measure(corners_a, corners_b);
    return nearest_ > 0;
  }
  if (boxes_apart(corners_a, corners_b) || !triangles_meet(corners_a, corners_b)) return true;
  add({fixed, moving});
  return wanted_ == Wanted::kAll;
}

const Eigen::Vector3d& TrianglePairs::moved(std::uint32_t vertex) noexcept {
  Eigen::Vector3d& x = moved_[vertex];
  if (moved_in_[vertex] != query_) {
    moved_in_[vertex] = query_;
    const Eigen::Vector3d& v = moving_.mesh.vertices[vertex];
    const auto& m = pose_.matrix();
    for (Eigen::Index i = 0; i < 3; ++i) {
      x[i] = ((m(i, 0) * v[0] + m(i, 1) * v[1]) + m(i, 2) * v[2]) + m(i, 3);
    }
  }
  return x;
}

// Where the span is full it is a heap of the first pairs seen so far, the last of them on top.
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
  if (boxes >= nearest_ * nearest_) return;
  if (boxes == 0 && triangles_meet(a, b)) {
    nearest_ = 0;
    return;
  }
  nearest_ = std::min(nearest_, std::sqrt(distance_squared(a, b)));
}

double TrianglePairs::distance_error() const noexcept {
  return nearest_ > 0 ? kTriangleDistanceError * (longest_edge_ + nearest_) : 0;
}

void TrianglePairs::finish() noexcept {
  const auto found = out_.first(std::min<std::uint64_t>(count_, out_.size()));
  std::sort(found.begin(), found.end());
}

std::size_t TrianglePairs::bytes() const noexcept {
  return seen_.bytes() + moved_.size() * (sizeof(Eigen::Vector3d) + sizeof(std::uint32_t)) +
         (near_.size() + near_leaf_.size()) * sizeof(std::uint32_t);
}

}  // namespace ist
