#include "ist/tree/tree_io.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/base/input_file.h"
#include "ist/base/output_file.h"

namespace ist {
namespace {

static_assert(std::endian::native == std::endian::little,
              "arrays are written as they lie in memory");

constexpr std::array<unsigned char, 8> kMagic = {0x89, 'I', 'S', 'T', 0x0D, 0x0A, 0x1A, 0x0A};
constexpr std::uint32_t kByteOrder = 0x01020304;

struct Preamble {
  std::array<unsigned char, 8> magic = kMagic;
  std::uint32_t version = kTreeFileVersion;
  std::uint32_t byte_order = kByteOrder;
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;
};
static_assert(sizeof(Preamble) == 32 && std::is_trivially_copyable_v<Preamble>);

enum Section : std::uint32_t {
  kBallsSection = 1,
  kTrianglesSection = 2,
  kProximitySection = 4,
  kSlabsSection = 8
};

class Checksum {
 public:
  Checksum() : state_(XXH3_createState()) { XXH3_64bits_reset(state_.get()); }
  void add(const void* data, std::size_t bytes) { XXH3_64bits_update(state_.get(), data, bytes); }
  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

class Writer {
 public:
  explicit Writer(const std::filesystem::path& file) : file_(file) {
    const Preamble later;
    file_.write(&later, sizeof(later));
  }

  template <typename T>
  void value(const T& value) {
    array(std::span<const T>(&value, 1));
  }
  template <typename T>
  void array(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    file_.write(values.data(), values.size_bytes());
    checksum_.add(values.data(), values.size_bytes());
    bytes_ += values.size_bytes();
  }
  template <typename T>
  void array(const std::vector<T>& values) {
    array(std::span<const T>(values));
  }

  std::uint64_t commit() {
    Preamble preamble;
    preamble.bytes = sizeof(preamble) + bytes_;
    preamble.checksum = checksum_.value();
    file_.write_at(0, &preamble, sizeof(preamble));
    file_.commit();
    return preamble.bytes;
  }

 private:
  OutputFile file_;
  Checksum checksum_;
  std::uint64_t bytes_ = 0;
};

void write_octree(Writer& writer, const LinearOctree& octree) {
  for (int level = 1; level <= octree.depth(); ++level) writer.value(octree.node_count(level));
  writer.value(octree.leaf_count());
  for (int level = 1; level <= octree.depth(); ++level) writer.array(octree.masks(level));
}

// One bound a node, in the order of the nodes, without the blocks' empty slots.
template <typename Packed, typename Block>
void write_bounds(Writer& writer, const LinearOctree& octree,
                  const std::vector<std::vector<Block>>& blocks) {
  for (int level = 0; level <= octree.depth(); ++level) {
    const std::span<const OctreeNode> parents = octree.nodes(level + 1);
    std::vector<Packed> packed;
    packed.reserve(octree.node_count(level));
    for (std::size_t parent = 0; parent + 1 < parents.size(); ++parent) {
      const auto children =
          static_cast<int>(parents[parent + 1].first_child - parents[parent].first_child);
      for (int slot = 0; slot < children; ++slot) {
        packed.push_back(blocks[static_cast<std::size_t>(level)][parent][slot]);
      }
    }
    writer.array(packed);
  }
}

// Reads straight into the arrays that the tree will own. A count is believed only as far as the
// file is long; what the arrays hold is believed only after verify_checksum().
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file), left_(file_.size()) {
    Preamble preamble;
    const std::size_t got = file_.read(&preamble, sizeof(preamble));
    if (got < sizeof(kMagic) || preamble.magic != kMagic) {
      fail(ErrorCode::kNotATree, "it is no tree file: make one with ist build");
    }
    if (got < sizeof(preamble)) truncated();
    if (preamble.byte_order != kByteOrder) {
      fail(ErrorCode::kNotATree, "it was written in another byte order: build it again here");
    }
    if (preamble.version != kTreeFileVersion) {
      fail(ErrorCode::kTreeVersion,
           fmt::format("it is of version {}, and this program reads version {}: build it again",
                       preamble.version, kTreeFileVersion));
    }
    if (preamble.bytes != file_.size()) {
      fail(ErrorCode::kTreeTruncated,
           fmt::format("it has {} bytes and should have {}: copy or build it again", file_.size(),
                       preamble.bytes));
    }
    expected_ = preamble.checksum;
    left_ -= sizeof(preamble);
  }

  template <typename T>
  T value() {
    T value;
    bytes(&value, sizeof(value));
    return value;
  }
  template <typename T>
  std::vector<T> array(std::uint64_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > left_ / sizeof(T)) truncated();
    std::vector<T> values(count);
    bytes(values.data(), count * sizeof(T));
    return values;
  }

  void verify_checksum() const {
    if (left_ != 0) corrupt("there is more in it than it lists");
    if (checksum_.value() != expected_) corrupt("its checksum does not match its content");
  }
  void require(bool holds, const char* otherwise) const {
    if (!holds) corrupt(otherwise);
  }

 private:
  void bytes(void* data, std::uint64_t count) {
    if (count > left_ || file_.read(data, count) != count) truncated();
    checksum_.add(data, count);
    left_ -= count;
  }
  [[noreturn]] void truncated() const {
    fail(ErrorCode::kTreeTruncated, "it ends before its content does: copy or build it again");
  }
  [[noreturn]] void corrupt(const char* what) const {
    fail(ErrorCode::kTreeCorrupt, fmt::format("{}: build it again", what));
  }
  [[noreturn]] void fail(ErrorCode code, const std::string& what) const {
    throw Error(code, fmt::format("{}: {}", file_.path().string(), what));
  }

  InputFile file_;
  Checksum checksum_;
  std::uint64_t expected_ = 0, left_;
};

using Masks = std::vector<std::vector<std::uint8_t>>;

struct StoredOctree {
  std::vector<std::uint32_t> nodes;  // at levels 1 … depth
  std::uint32_t leaves;
  Masks masks;
};

StoredOctree read_octree(Reader& reader, std::uint32_t depth) {
  constexpr std::uint32_t kMaxDepth = 17;  // 2^16 cells, and a margin round them
  reader.require(depth <= kMaxDepth, "its depth is out of range");
  StoredOctree stored{reader.array<std::uint32_t>(depth), reader.value<std::uint32_t>(), {}};
  for (const std::uint32_t count : stored.nodes) {
    stored.masks.push_back(reader.array<std::uint8_t>(count));
  }
  return stored;
}

LinearOctree verified(const Reader& reader, StoredOctree stored) {
  reader.require(LinearOctree::is_tree(stored.masks), "its levels do not form a tree");
  LinearOctree octree(std::move(stored.masks));
  reader.require(octree.leaf_count() == stored.leaves, "its leaves are miscounted");
  return octree;
}

template <typename Float>
bool all_finite(const Float* values, std::size_t count) {
  unsigned bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bad |= static_cast<unsigned>(!(std::abs(values[i]) <= std::numeric_limits<Float>::max()));
  }
  return bad == 0;
}

void verify_lattice(const Reader& reader, const Lattice& lattice) {
  reader.require(all_finite(lattice.corner.data(), 3), "the grid's corner is not finite");
  reader.require(lattice.voxel_size > 0 && std::isfinite(lattice.voxel_size),
                 "the voxel size is not a positive number");
  reader.require(lattice.cells >= 1 && lattice.cells <= Lattice::kMaxCells,
                 "the number of voxels an axis is out of range");
  constexpr double kLargestExtent = 1e15;
  reader.require(lattice.voxel_size * lattice.cells <= Lattice::kMaxRelativeSize * kLargestExtent,
                 "the grid is larger than any mesh may be");
  reader.require(lattice.depth == static_cast<int>(std::bit_width(lattice.cells - 1)),
                 "its depth does not fit its voxels");
}

bool is_valid(const PackedBall& ball) { return ball.r > 0; }

bool is_valid(const PackedSlab& slab) {
  const int x = slab.nx, y = slab.ny, z = slab.nz;
  return std::abs(x) <= 126 && std::abs(y) <= 126 && std::abs(z) <= 126 &&
         x * x + y * y + z * z <= 128 * 128 && slab.offset >= -127 && slab.half > 0;
}

template <typename Packed>
using Levels = std::vector<std::vector<Packed>>;

template <typename Packed>
Levels<Packed> read_bounds(Reader& reader, const StoredOctree& stored) {
  Levels<Packed> levels{reader.array<Packed>(stored.leaves)};
  for (const std::uint32_t nodes : stored.nodes) levels.push_back(reader.array<Packed>(nodes));
  return levels;
}

template <typename Block, typename Packed>
std::vector<std::vector<Block>> verified(const Reader& reader, const LinearOctree& octree,
                                         Levels<Packed> levels, const char* otherwise) {
  std::vector<std::vector<Block>> blocks(levels.size());
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const std::span<const OctreeNode> parents = octree.nodes(static_cast<int>(level) + 1);
    blocks[level].resize(parents.size() - 1);
    for (std::size_t parent = 0; parent + 1 < parents.size(); ++parent) {
      const std::uint32_t first = parents[parent].first_child;
      for (std::uint32_t node = first; node < parents[parent + 1].first_child; ++node) {
        reader.require(is_valid(levels[level][node]), otherwise);
        blocks[level][parent].set(static_cast<int>(node - first), levels[level][node]);
      }
    }
    levels[level] = {};
  }
  return blocks;
}

void verify_triangles(const Reader& reader, const LeafTriangles& leaves) {
  const auto& [mesh, lists] = leaves;
  reader.require(
      mesh.vertices.empty() || all_finite(mesh.vertices.front().data(), 3 * mesh.vertices.size()),
      "a vertex is not finite");
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      reader.require(vertex < mesh.vertices.size(), "a triangle names a vertex that is not there");
    }
  }
  reader.require(lists.first.front() == 0 && lists.first.back() == lists.ids.size(),
                 "the triangle lists do not cover their entries");
  for (std::size_t leaf = 0; leaf < lists.size(); ++leaf) {
    reader.require(
        lists.first[leaf] < lists.first[leaf + 1] && lists.first[leaf + 1] <= lists.ids.size(),
        "a leaf's triangle list is out of range");
    for (std::uint32_t i = lists.first[leaf]; i < lists.first[leaf + 1]; ++i) {
      reader.require(lists.ids[i] < mesh.triangles.size(),
                     "a leaf names a triangle that is not there");
      reader.require(i == lists.first[leaf] || lists.ids[i - 1] < lists.ids[i],
                     "a leaf's triangles are not in order");
    }
  }
}

}  // namespace

std::uint64_t write_tree(const SphereTree& tree, const std::filesystem::path& file) {
  const Lattice& lattice = tree.lattice();
  Writer writer(file);
  writer.value(lattice.corner);
  writer.value(lattice.voxel_size);
  writer.value(lattice.cells);
  writer.value(static_cast<std::uint32_t>(lattice.depth));
  writer.value(static_cast<std::uint32_t>(tree.orientation()));
  const std::uint32_t sections = (tree.has(SpherePolicy::kTight) ? kBallsSection : 0u) |
                                 (tree.has(SpherePolicy::kSlab) ? kSlabsSection : 0u) |
                                 (tree.triangles() ? kTrianglesSection : 0u) |
                                 (tree.proximity() ? kProximitySection : 0u);
  writer.value(sections);
  write_octree(writer, tree.octree());
  writer.array(tree.normals());
  if (tree.has(SpherePolicy::kTight)) {
    write_bounds<PackedBall>(writer, tree.octree(), tree.bounds().balls);
  }
  if (tree.has(SpherePolicy::kSlab)) {
    write_bounds<PackedSlab>(writer, tree.octree(), tree.bounds().slabs);
  }
  if (tree.triangles()) {
    const auto& [mesh, lists] = *tree.triangles();
    writer.value(std::uint64_t{mesh.vertices.size()});
    writer.value(std::uint64_t{mesh.triangles.size()});
    writer.value(std::uint64_t{lists.ids.size()});
    writer.array(
        std::span(reinterpret_cast<const double*>(mesh.vertices.data()), 3 * mesh.vertices.size()));
    writer.array(mesh.triangles);
    writer.array(lists.first);
    writer.array(lists.ids);
  }
  if (tree.proximity()) {
    writer.value(static_cast<std::uint32_t>(tree.proximity()->octree.depth()));
    write_octree(writer, tree.proximity()->octree);
  }
  return writer.commit();
}

SphereTree read_tree(const std::filesystem::path& file) {
  Reader reader(file);
  Lattice lattice;
  lattice.corner = reader.value<std::array<double, 3>>();
  lattice.voxel_size = reader.value<double>();
  lattice.cells = reader.value<std::uint32_t>();
  const auto depth = reader.value<std::uint32_t>();
  lattice.depth = static_cast<int>(depth);
  const auto orientation = reader.value<std::uint32_t>();
  const auto sections = reader.value<std::uint32_t>();
  StoredOctree stored = read_octree(reader, depth);
  std::vector<PackedNormal> normals = reader.array<PackedNormal>(stored.leaves);

  Levels<PackedBall> balls;
  if ((sections & kBallsSection) != 0) balls = read_bounds<PackedBall>(reader, stored);
  Levels<PackedSlab> slabs;
  if ((sections & kSlabsSection) != 0) slabs = read_bounds<PackedSlab>(reader, stored);
  std::optional<LeafTriangles> triangles;
  if ((sections & kTrianglesSection) != 0) {
    const auto counts = reader.value<std::array<std::uint64_t, 3>>();
    triangles.emplace();
    const auto coordinates = reader.array<std::array<double, 3>>(counts[0]);
    for (const auto& [x, y, z] : coordinates) triangles->mesh.vertices.emplace_back(x, y, z);
    triangles->mesh.triangles = reader.array<Triangle>(counts[1]);
    triangles->lists.first = reader.array<std::uint32_t>(std::uint64_t{stored.leaves} + 1);
    triangles->lists.ids = reader.array<std::uint32_t>(counts[2]);
  }
  std::optional<StoredOctree> proximity;
  if ((sections & kProximitySection) != 0) {
    const auto proximity_depth = reader.value<std::uint32_t>();
    proximity = read_octree(reader, proximity_depth);
  }

  reader.verify_checksum();
  reader.require(sections <= 15, "it lists a section that is not known");
  reader.require(slabs.empty() || !balls.empty(), "it has slabs without balls");
  reader.require(orientation <= static_cast<std::uint32_t>(Orientation::kAssumed),
                 "its orientation is not known");
  verify_lattice(reader, lattice);
  if (triangles) verify_triangles(reader, *triangles);
  SphereTree::Parts parts{lattice,
                          verified(reader, std::move(stored)),
                          static_cast<Orientation>(orientation),
                          std::move(normals),
                          {},
                          std::move(triangles),
                          std::nullopt};
  parts.bounds.balls =
      verified<BallBlock>(reader, parts.octree, std::move(balls), "a ball has no radius");
  parts.bounds.slabs = verified<SlabBlock>(reader, parts.octree, std::move(slabs),
                                           "a slab's numbers are out of range");
  if (proximity) parts.proximity = ProximityTree{verified(reader, std::move(*proximity))};
  return SphereTree(std::move(parts));
}

bool is_tree_file(const std::filesystem::path& file) {
  InputFile input(file);
  std::array<unsigned char, 8> magic{};
  return input.read(magic.data(), magic.size()) == magic.size() && magic == kMagic;
}

}  // namespace ist
