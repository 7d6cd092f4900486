#include "scaling/footprint.h"

#include <chrono>
#include <map>
#include <memory>
#include <tuple>

#include "ist/query/query.h"
#include "support/bodies.h"
#include "support/peak_memory.h"

namespace ist::bench {
namespace {

using Key = std::pair<SpherePolicy, double>;
using Trees = std::pair<SphereTree, SphereTree>;

struct Kept {
  Key key;
  Trees trees;
};

std::unique_ptr<Kept>& kept() {
  static std::unique_ptr<Kept> last;
  return last;
}

std::map<Key, Footprint>& measured() {
  static std::map<Key, Footprint> footprints;
  return footprints;
}

SphereTree build_large(const TriangleMesh& mesh, const Key& key) {
  BuildOptions options;
  options.spheres = key.first;
  options.voxel_size = key.second;
  options.max_memory = kMaxMemory;
  return build_tree(mesh, options);
}

double megabytes(std::uint64_t bytes) { return 1e-6 * static_cast<double>(bytes); }

void build_jaws(const Key& key) {
  const TriangleMesh &upper = upper_jaw(), &lower = lower_jaw();  // read before the clock runs
  kept().reset();
  reset_peak_memory();
  const double before = peak_memory_mb();
  const auto begin = std::chrono::steady_clock::now();
  // One after the other, as whoever has no more memory than that would.
  SphereTree fixed = build_large(upper, key);
  SphereTree moving = build_large(lower, key);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  const double peak = peak_memory_mb() - before;
  kept() = std::make_unique<Kept>(Kept{key, {std::move(fixed), std::move(moving)}});
  const auto& [a, b] = kept()->trees;
  measured()[key] = {static_cast<double>(a.leaf_count()) + b.leaf_count(),
                     megabytes(a.bytes() + b.bytes()), megabytes(Query(a, b).bytes()), peak,
                     time.count()};
}

}  // namespace

const Trees& jaws(SpherePolicy policy, double voxel_size) {
  const Key key{policy, voxel_size};
  if (kept() == nullptr || kept()->key != key) build_jaws(key);
  return kept()->trees;
}

void forget_jaws() { kept().reset(); }

const Footprint& footprint(SpherePolicy policy, double voxel_size) {
  const Key key{policy, voxel_size};
  if (!measured().contains(key)) build_jaws(key);
  return measured().at(key);
}

}  // namespace ist::bench
