#include "ist/mesh/clusters/triangle_order.h"

#include <algorithm>
#include <array>
#include <span>

#include "ist/base/parallel.h"

namespace ist {
namespace {

constexpr std::size_t kWidth = 16;
// Parts of so many triangles are ordered side by side.
constexpr std::size_t kPart = kWidth * kWidth * kWidth;

struct Item {
  std::array<float, 3> centre;
  std::uint32_t triangle;
};

std::size_t longest_axis(std::span<const Item> items) {
  std::array<float, 3> low = items[0].centre, high = low;
  for (const Item& item : items) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], item.centre[i]);
      high[i] = std::max(high[i], item.centre[i]);
    }
  }
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (high[i] - low[i] > high[longest] - low[longest]) longest = i;
  }
  return longest;
}

// Orders the items until parts of `smallest` are left. Positions of equal centres are those of
// their indices, so that the parts do not depend on the library's selection.
void halve(std::span<Item> items, std::size_t smallest) {
  while (items.size() > smallest) {
    std::size_t part = smallest;
    while (part * kWidth < items.size()) part *= kWidth;
    const std::size_t parts = (items.size() + part - 1) / part;
    const std::size_t middle = part * (parts / 2);
    const std::size_t axis = longest_axis(items);
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle),
                     items.end(), [axis](const Item& a, const Item& b) {
                       if (a.centre[axis] != b.centre[axis]) {
                         return a.centre[axis] < b.centre[axis];
                       }
                       return a.triangle < b.triangle;
                     });
    halve(items.first(middle), smallest);
    items = items.subspan(middle);
  }
}

}  // namespace

std::vector<std::uint32_t> triangle_order(std::span<const Eigen::Vector3d> corners) {
  std::vector<Item> items(corners.size() / 3);
  for (std::uint32_t k = 0; k < items.size(); ++k) {
    const Eigen::Vector3d* const p = &corners[std::size_t{3} * k];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      items[k].centre[i] = static_cast<float>((p[0][axis] + p[1][axis]) + p[2][axis]);
    }
    items[k].triangle = k;
  }
  halve(items, kPart);
  parallel_for((items.size() + kPart - 1) / kPart, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      const std::size_t first = part * kPart;
      halve(std::span(items).subspan(first, std::min(kPart, items.size() - first)), kWidth);
    }
  });
  std::vector<std::uint32_t> order(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) order[k] = items[k].triangle;
  for (std::size_t first = 0; first < order.size(); first += kWidth) {
    const std::size_t last = std::min(first + kWidth, order.size());
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first),
              order.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return order;
}

}  // namespace ist
