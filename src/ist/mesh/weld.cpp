#include "ist/mesh/weld.h"

#include <bit>

#include "ist/base/platform/bit_cast.h"
#include "ist/mesh/mesh.h"

namespace ist {
namespace {

std::size_t hash_of(const Eigen::Vector3d& point) {
  std::uint64_t hash = 0;
  for (const double coordinate : point) {
    hash = (hash ^ bit_cast<std::uint64_t>(coordinate + 0.0)) * 0x9E3779B97F4A7C15u;  // no -0
    hash ^= hash >> 32;
  }
  return hash;
}

}  // namespace

std::uint32_t& PositionTable::slot_of(const Eigen::Vector3d& point,
                                      std::span<const Eigen::Vector3d> vertices) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(point) & mask;
  while (slots_[slot] != kNoVertex && vertices[slots_[slot]] != point) slot = (slot + 1) & mask;
  return slots_[slot];
}

void PositionTable::reset(std::size_t positions) {
  slots_ = {};  // freed first
  slots_.assign(std::bit_ceil(positions + positions / 3 + 4), kNoVertex);
}

std::vector<std::uint32_t> first_at_position(std::span<const Eigen::Vector3d> points) {
  PositionTable table(points.size());
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    std::uint32_t& slot = table.slot_of(points[v], points);
    if (slot == PositionTable::kNoVertex) slot = v;
    first[v] = slot;
  }
  return first;
}

void weld(TriangleMesh& mesh) {
  if (!mesh.triangles.empty()) require_valid(mesh);
  const std::vector<std::uint32_t> first = first_at_position(mesh.vertices);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = first[v];
  }
}

}  // namespace ist
