#include "ist/tree/outer_balls_file.h"

#include <cmath>

namespace ist {
namespace {

struct FieldHeader {
  std::array<double, 3> middle;
  double unit;
  float cell;
  std::array<float, 3> half;
  std::array<std::uint32_t, 3> groups;
  std::uint32_t balls;
};
static_assert(sizeof(FieldHeader) == 64);

// Of all groups together.
constexpr std::uint64_t kMostGroups = std::uint64_t{1} << 28;

std::uint64_t group_count(const std::array<std::uint32_t, 3>& groups) {
  std::uint64_t count = 1;
  for (const std::uint32_t along : groups) {
    if (along == 0 || along > kMostGroups) return kMostGroups + 1;
    count *= along;
    if (count > kMostGroups) return count;
  }
  return count;
}

bool is_power_of_two(double number) {
  int exponent = 0;
  return std::isfinite(number) && std::frexp(number, &exponent) == 0.5 && std::abs(exponent) < 100;
}

}  // namespace

void write_outer_balls(TreeWriter& writer, const OuterBalls& field) {
  const Eigen::Vector3d& middle = field.middle;
  writer.value(FieldHeader{{middle[0], middle[1], middle[2]},
                           field.unit,
                           field.cell,
                           field.half,
                           field.groups,
                           static_cast<std::uint32_t>(field.balls.size())});
  writer.array(field.first);
  writer.array(field.balls);
}

OuterBalls read_outer_balls(TreeReader& reader) {
  const auto header = reader.value<FieldHeader>();
  const std::uint64_t groups = group_count(header.groups);
  reader.require(groups <= kMostGroups, "its outer balls have too many groups");
  OuterBalls field;
  field.middle = {header.middle[0], header.middle[1], header.middle[2]};
  field.unit = header.unit;
  field.cell = header.cell;
  field.half = header.half;
  field.groups = header.groups;
  field.first = reader.array<std::int32_t>(groups);
  field.balls = reader.array<OuterBall>(header.balls);
  return field;
}

void verify_outer_balls(const TreeReader& reader, const OuterBalls& field) {
  bool is_finite = field.middle.allFinite() && std::isfinite(field.cell) && field.cell > 0;
  for (const float half : field.half) is_finite = is_finite && std::isfinite(half) && half >= 0;
  reader.require(is_finite && is_power_of_two(field.unit),
                 "a length of its outer balls is out of range");
  std::uint64_t count = 0;
  for (const std::int32_t entry : field.first) {
    reader.require(entry >= 0 && static_cast<std::uint64_t>(entry) / 2 == count,
                   "its outer balls are not in order");
    count += entry % 2 != 0 ? OuterBalls::kGroupCells : 1;
  }
  reader.require(count == field.balls.size(), "its groups have other outer balls");
}

}  // namespace ist
