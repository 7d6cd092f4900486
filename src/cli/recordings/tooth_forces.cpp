#include "cli/recordings/tooth_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace ist::cli {
namespace {

constexpr std::uint32_t kNoTooth = std::numeric_limits<std::uint32_t>::max();

}  // namespace

ToothForces::ToothForces(std::vector<answers::ToothLabels> labels) : tooth_of_(labels.size()) {
  for (std::size_t body = 0; body < labels.size(); ++body) {
    std::set<int> numbers(labels[body].begin(), labels[body].end());
    numbers.erase(0);
    const auto first = static_cast<std::ptrdiff_t>(teeth_.size());
    for (const int number : numbers) teeth_.push_back({body, number});
    tooth_of_[body].reserve(labels[body].size());
    for (const int number : labels[body]) {
      const auto found = std::find_if(teeth_.begin() + first, teeth_.end(),
                                      [&](const Tooth& tooth) { return tooth.number == number; });
      tooth_of_[body].push_back(
          found != teeth_.end() ? static_cast<std::uint32_t>(found - teeth_.begin()) : kNoTooth);
    }
  }
}

void ToothForces::add(std::uint32_t body, std::uint32_t triangle,
                      const std::array<double, 3>& force) noexcept {
  if (tooth_of_[body].empty()) return;
  const std::uint32_t tooth = tooth_of_[body][triangle];
  if (tooth == kNoTooth) return;
  const auto end = touched_.begin() + static_cast<std::ptrdiff_t>(touched_count_);
  const auto at =
      static_cast<std::size_t>(std::find(touched_.begin(), end, tooth) - touched_.begin());
  if (at == touched_count_) {
    touched_[touched_count_] = tooth;
    force_[touched_count_++] = {};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) force_[at][axis] += force[axis];
}

void ToothForces::take(const TickRecord& record) noexcept {
  touched_count_ = 0;
  for (const ContactRecord& point : std::span(record.points).first(record.point_count)) {
    add(point.fixed, point.fixed_triangle, point.force);
    add(point.held, point.held_triangle, point.force);
  }
  for (std::size_t i = 0; i < touched_count_; ++i) {
    const auto [x, y, z] = force_[i];
    const double length = std::sqrt(x * x + y * y + z * z);
    Tooth& tooth = teeth_[touched_[i]];
    ++tooth.ticks;
    tooth.sum += length;
    tooth.largest = std::max(tooth.largest, length);
  }
}

}  // namespace ist::cli
