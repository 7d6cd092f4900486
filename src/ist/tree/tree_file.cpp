#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/base/float_environment.h"
#include "ist/base/platform/bit_cast.h"
#include "ist/mesh/bounding_box.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/outer_balls_file.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "ist/tree/tree_stream.h"
#include "ist/voxel/triangle_bins.h"

// The tree file, `.ist`, version 5. Little-endian, packed, in this order:
//
//     8 bytes   magic 89 49 53 54 0D 0A 1A 0A
//     u32       version
//     u32       0x01020304, which shows another byte order
//     u64       bytes in the file
//     u64       XXH3-64 of all bytes that follow
//     f64 × 3   the grid's corner      f64  voxel size
//     u32       cells an axis          u32  depth
//     u32       orientation            u32  sections: 1 balls, 2 triangles, 4 proximity, 8 slabs,
//                                           16 outer balls
//     u64       hash of the mesh's file, 0 if unknown
//     u8        unit: 0 unknown, 1 millimetre, 2 metre, 3 inch, 4 micrometre
//     u8        frame: 0 unknown, 1 RAS, 2 LPS
//     u16       0
//     u32, u8 … bytes in the name of the mesh's file, at most 255; the name (MeshSource)
//     u32 × depth, u32                 nodes at levels 1 … depth; leaves
//     u8 …      masks of level 1, 2 … depth
//     u32 …     normals, one a leaf (PackedNormal)
//     balls:      i16 × 3, u16 …       centre, radius, of the nodes of level 0, 1 … depth
//     slabs:      i8 × 4, u8 …         normal, offset, half width, in the order of the balls
//     triangles:  u64 × 3              vertices, triangles, list entries
//                 f64 × 3 …, u32 × 3 … vertices, triangles
//                 u32 …, u32 …         the lists' beginnings (leaves + 1), their entries
//     proximity:  u32, u32 × depth, u32, u8 …   depth, nodes, leaves, masks
//     of triangles too: f64 × 9, f64    axes of their clusters, one after the other; grid
//                 NodeBlock …           bounds of the clusters, of the nodes above …
//                 TriangleCluster …     the clusters
//     outer balls: outer_balls_file.h
//
// A file whose voxel size and cells are 0 is of a tree without voxels. Its corner, depth and list
// entries are 0 too, its sections are triangles and outer balls, and it lacks the nodes, masks,
// normals and lists.
//
// Children's indices and cubes are not stored: they follow from the masks. Balls and slabs hold the
// numbers of PackedBall and PackedSlab.
namespace ist {
namespace {

enum Section : std::uint32_t {
  kBallsSection = 1,
  kTrianglesSection = 2,
  kProximitySection = 4,
  kSlabsSection = 8,
  kOuterBallsSection = 16
};

struct Header {
  std::array<double, 3> corner;
  double voxel_size;
  std::uint32_t cells, depth, orientation, sections;
  std::uint64_t hash;
  std::uint8_t unit, frame;
  std::uint16_t zero;
  std::uint32_t name_bytes;
};
static_assert(sizeof(Header) == 64);

void write_octree(TreeWriter& writer, const LinearOctree& octree) {
  for (int level = 1; level <= octree.depth(); ++level) writer.value(octree.node_count(level));
  writer.value(octree.leaf_count());
  for (int level = 1; level <= octree.depth(); ++level) writer.array(octree.masks(level));
}

// Writes one bound a node, in the order of the nodes, without the blocks' empty slots.
template <typename Packed, typename Block>
void write_bounds(TreeWriter& writer, const LinearOctree& octree,
                  const std::vector<std::vector<Block>>& blocks) {
  for (int level = 0; level <= octree.depth(); ++level) {
    const std::vector<Block>& here = blocks[static_cast<std::size_t>(level)];
    std::vector<Packed> packed;
    packed.reserve(octree.node_count(level));
    for (std::uint32_t parent = 0; parent < here.size(); ++parent) {
      for (int slot = 0; slot < octree.child_count(level + 1, parent); ++slot) {
        packed.push_back(here[parent][slot]);
      }
    }
    writer.array(packed);
  }
}

using Masks = std::vector<std::vector<std::uint8_t>>;

struct StoredOctree {
  std::vector<std::uint32_t> nodes;  // at levels 1 … depth
  std::uint32_t leaves;
  Masks masks;
};

StoredOctree read_octree(TreeReader& reader, std::uint32_t depth) {
  constexpr std::uint32_t kMaxDepth = 17;  // 2^16 cells and a margin round the cells
  reader.require(depth <= kMaxDepth, "its depth is out of range");
  StoredOctree stored{reader.array<std::uint32_t>(depth), reader.value<std::uint32_t>(), {}};
  for (const std::uint32_t count : stored.nodes) {
    stored.masks.push_back(reader.array<std::uint8_t>(count));
  }
  return stored;
}

LinearOctree verified(const TreeReader& reader, StoredOctree stored) {
  reader.require(LinearOctree::is_tree(stored.masks), "its levels do not form a tree");
  LinearOctree octree(std::move(stored.masks));
  reader.require(octree.leaf_count() == stored.leaves, "its leaf count does not match its masks");
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

// Verifies the length of the name. verify_source() verifies the rest.
MeshSource read_source(TreeReader& reader, const Header& header) {
  reader.require(header.name_bytes <= kMaxSourceName, "the mesh's name is longer than 255 bytes");
  const std::vector<char> name = reader.array<char>(header.name_bytes);
  return {{name.begin(), name.end()}, header.hash, static_cast<LengthUnit>(header.unit)};
}

void verify_source(const TreeReader& reader, const Header& header, const MeshSource& source) {
  reader.require(header.unit <= kLengthUnits.size() && header.zero == 0,
                 "the unit of length is out of range");
  reader.require(header.frame <= kPatientFrames.size(), "the patient's frame is out of range");
  if (const char* flaw = source_flaw(source)) reader.require(false, flaw);
}

void verify_lattice(const TreeReader& reader, const Lattice& lattice) {
  reader.require(all_finite(lattice.corner.data(), 3), "the grid's corner is not finite");
  reader.require(lattice.voxel_size > 0 && std::isfinite(lattice.voxel_size),
                 "the voxel size is not a positive number");
  reader.require(lattice.cells >= 1 && lattice.cells <= Lattice::kMaxCells,
                 "the number of voxels an axis is out of range");
  constexpr double kLargestExtent = 1e15;
  reader.require(lattice.voxel_size * lattice.cells <= Lattice::kMaxRelativeSize * kLargestExtent,
                 "the grid is larger than any mesh may be");
  constexpr double kSmallestExtent = 1e-12;  // half, because cells times size may round down
  reader.require(lattice.voxel_size * lattice.cells >= 0.5 * kSmallestExtent,
                 "the grid is smaller than any mesh may be");
  reader.require(lattice.depth == static_cast<int>(std::bit_width(lattice.cells - 1)),
                 "its depth does not fit its voxels");
}

bool is_valid(const PackedBall& ball) { return ball.r > 0; }

bool is_valid(const PackedSlab& slab) {
  const auto x = static_cast<int>(slab.nx), y = static_cast<int>(slab.ny),
             z = static_cast<int>(slab.nz);
  return x >= -127 && y >= -127 && z >= -127 && x * x + y * y + z * z <= 128 * 128 &&
         slab.offset >= -127 && slab.half > 0;
}

template <typename Packed>
using Levels = std::vector<std::vector<Packed>>;

template <typename Packed>
Levels<Packed> read_bounds(TreeReader& reader, const StoredOctree& stored) {
  Levels<Packed> levels{reader.array<Packed>(stored.leaves)};
  for (const std::uint32_t nodes : stored.nodes) levels.push_back(reader.array<Packed>(nodes));
  return levels;
}

template <typename Block, typename Packed>
std::vector<std::vector<Block>> verified(const TreeReader& reader, const LinearOctree& octree,
                                         Levels<Packed> levels, const char* otherwise) {
  std::vector<std::vector<Block>> blocks(levels.size());
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const int above = static_cast<int>(level) + 1;
    blocks[level].resize(octree.nodes(above).size() - 1);
    auto packed = levels[level].begin();
    for (std::uint32_t parent = 0; parent < blocks[level].size(); ++parent) {
      for (int slot = 0; slot < octree.child_count(above, parent); ++slot, ++packed) {
        reader.require(is_valid(*packed), otherwise);
        blocks[level][parent].set(slot, *packed);
      }
    }
    levels[level] = {};
  }
  return blocks;
}

// Verifies the triangles of any tree.
void verify_mesh(const TreeReader& reader, const TriangleMesh& mesh) {
  reader.require(
      mesh.vertices.empty() || all_finite(mesh.vertices.front().data(), 3 * mesh.vertices.size()),
      "a vertex is not finite");
  for (const Triangle& triangle : mesh.triangles) {
    cancellation_point();
    for (const std::uint32_t vertex : triangle) {
      reader.require(vertex < mesh.vertices.size(),
                     "a triangle refers to a vertex that does not exist");
    }
  }
}

// Bit by bit, so that a file is written as it was read.
bool is_zero(double number) { return bit_cast<std::uint64_t>(number) == 0; }

bool is_without_voxels(const Header& header) {
  return is_zero(header.voxel_size) && header.cells == 0;
}

// The clusters of a mesh, as they are stored.
struct StoredClusters {
  std::array<double, 9> axes;
  double grid;
  std::vector<std::vector<NodeBlock>> levels;
  std::vector<TriangleCluster> clusters;
};

StoredClusters read_clusters(TreeReader& reader, std::size_t triangles) {
  reader.require(triangles <= kMaxTriangles, "it has too many triangles");
  StoredClusters stored{reader.value<std::array<double, 9>>(), reader.value<double>(), {}, {}};
  const auto counts = TriangleClusters::node_counts(static_cast<std::uint32_t>(triangles));
  for (const std::uint32_t nodes : counts) {
    stored.levels.push_back(reader.array<NodeBlock>(TriangleClusters::block_count(nodes)));
  }
  stored.clusters = reader.array<TriangleCluster>(counts[0]);
  return stored;
}

TriangleClusters verified(const TreeReader& reader, StoredClusters stored, std::size_t triangles,
                          const Eigen::Vector3d& origin) {
  constexpr const char* kFlaw = "its clusters have a number that is out of range";
  constexpr double kLargest = 1 + 0x1p-20;
  int exponent = 0;
  reader.require(std::frexp(stored.grid, &exponent) == 0.5, kFlaw);  // a power of two
  for (const double component : stored.axes) {
    reader.require(std::abs(component) <= kLargest, kFlaw);
  }
  for (const std::vector<NodeBlock>& level : stored.levels) {
    for (const NodeBlock& block : level) {
      reader.require(all_finite(&block.centre[0][0], sizeof(block) / sizeof(float)), kFlaw);
    }
  }
  for (const TriangleCluster& cluster : stored.clusters) {
    cancellation_point();
    reader.require(all_finite(&cluster.corner[0][0][0], std::size_t{9} * kClusterWidth) &&
                       all_finite(&cluster.axis[0][0], 9) && all_finite(cluster.low, 3) &&
                       all_finite(cluster.high, 3) && cluster.zero == 0,
                   kFlaw);
    for (const std::uint32_t id : cluster.id) {
      reader.require(id < triangles, "a cluster refers to a triangle that does not exist");
    }
  }
  return {static_cast<std::uint32_t>(triangles),
          origin,
          Eigen::Matrix3d(stored.axes.data()),
          stored.grid,
          std::move(stored.levels),
          std::move(stored.clusters)};
}

// Verifies the header and the triangles of a tree without voxels.
void verify_no_voxels(const TreeReader& reader, const Header& header, const TriangleMesh& mesh) {
  reader.require((header.sections & ~kOuterBallsSection) == kTrianglesSection,
                 "without voxels it has other sections");
  reader.require(
      std::all_of(header.corner.begin(), header.corner.end(), is_zero) && header.depth == 0,
      "it has a grid without a voxel size");
  verify_mesh(reader, mesh);
  reader.require(has_usable_extent(bounding_box(mesh)), "its extent is none that a mesh may have");
}

// A grid of make_lattice holds its mesh exactly, because both functions round alike.
bool is_in_grid(const Lattice& lattice, const Eigen::Vector3d& vertex) {
  const Eigen::Vector3d place = lattice.to_lattice(vertex);
  return place.minCoeff() >= 0 && place.maxCoeff() <= lattice.cells;
}

void verify_triangles(const TreeReader& reader, const Lattice& lattice, const TriangleMesh& mesh,
                      const TriangleLists& lists) {
  verify_mesh(reader, mesh);
  for (const Triangle& triangle : mesh.triangles) {
    cancellation_point();
    for (const std::uint32_t vertex : triangle) {
      reader.require(is_in_grid(lattice, mesh.vertices[vertex]), "a triangle leaves the grid");
    }
  }
  reader.require(lists.first.front() == 0 && lists.first.back() == lists.ids.size(),
                 "the triangle lists do not cover their entries");
  for (std::size_t leaf = 0; leaf < lists.size(); ++leaf) {
    cancellation_point();
    reader.require(
        lists.first[leaf] < lists.first[leaf + 1] && lists.first[leaf + 1] <= lists.ids.size(),
        "a leaf's triangle list is out of range");
    for (std::uint32_t i = lists.first[leaf]; i < lists.first[leaf + 1]; ++i) {
      reader.require(lists.ids[i] < mesh.triangles.size(),
                     "a leaf refers to a triangle that does not exist");
      reader.require(i == lists.first[leaf] || lists.ids[i - 1] < lists.ids[i],
                     "a leaf's triangles are not in order");
    }
  }
}

const OuterBalls* outer_balls_of(const SphereTree& tree) {
  const auto& triangles = parts_of(tree).triangles;
  return triangles ? triangles->outer_balls() : nullptr;
}

Header header_of(const SphereTree& tree, const OuterBalls* balls) {
  const Lattice lattice =
      tree.has_voxels() ? voxels_of(tree).lattice : Lattice{.voxel_size = 0, .cells = 0};
  const MeshSource& source = tree.source();
  const std::uint32_t sections = (tree.has(SpherePolicy::kTight) ? kBallsSection : 0u) |
                                 (tree.has(SpherePolicy::kSlab) ? kSlabsSection : 0u) |
                                 (tree.triangles() ? kTrianglesSection : 0u) |
                                 (tree.has_proximity() ? kProximitySection : 0u) |
                                 (balls != nullptr ? kOuterBallsSection : 0u);
  return {lattice.corner,
          lattice.voxel_size,
          lattice.cells,
          static_cast<std::uint32_t>(lattice.depth),
          static_cast<std::uint32_t>(tree.orientation()),
          sections,
          source.hash,
          static_cast<std::uint8_t>(source.unit),
          static_cast<std::uint8_t>(tree.frame()),
          0,
          static_cast<std::uint32_t>(source.name.size())};
}

void write_mesh(TreeWriter& writer, const TriangleMesh& mesh, const TriangleLists& lists) {
  writer.value(std::uint64_t{mesh.vertices.size()});
  writer.value(std::uint64_t{mesh.triangles.size()});
  writer.value(std::uint64_t{lists.ids.size()});
  writer.array(
      std::span(reinterpret_cast<const double*>(mesh.vertices.data()), 3 * mesh.vertices.size()));
  writer.array(mesh.triangles);
  writer.array(lists.first);
  writer.array(lists.ids);
}

void write_clusters(TreeWriter& writer, const TriangleClusters& clusters) {
  writer.array(std::span(clusters.axes().data(), 9));
  writer.value(clusters.grid());
  for (int level = 0; level <= clusters.root_level(); ++level) {
    writer.array(clusters.bounds(level));
  }
  writer.array(clusters.clusters());
}

// `balls` are the tree's outer balls, or null.
std::uint64_t write(const SphereTree& tree, const OuterBalls* balls, TreeWriter writer) {
  const ScopedFloatEnvironment environment;
  writer.value(header_of(tree, balls));
  writer.array(tree.source().name);
  if (!tree.has_voxels()) {
    write_mesh(writer, *tree.triangles(), {});
    write_clusters(writer, parts_of(tree).triangles->clusters);
    if (balls != nullptr) write_outer_balls(writer, *balls);
    return writer.commit();
  }
  const TreeVoxels& voxels = voxels_of(tree);
  write_octree(writer, voxels.octree);
  writer.array(voxels.normals);
  if (tree.has(SpherePolicy::kTight)) {
    write_bounds<PackedBall>(writer, voxels.octree, voxels.bounds.balls);
  }
  if (tree.has(SpherePolicy::kSlab)) {
    write_bounds<PackedSlab>(writer, voxels.octree, voxels.bounds.slabs);
  }
  if (tree.triangles() != nullptr) write_mesh(writer, *tree.triangles(), voxels.lists);
  if (voxels.proximity) {
    writer.value(static_cast<std::uint32_t>(voxels.proximity->octree.depth()));
    write_octree(writer, voxels.proximity->octree);
  }
  if (tree.triangles() != nullptr) write_clusters(writer, parts_of(tree).triangles->clusters);
  if (balls != nullptr) write_outer_balls(writer, *balls);
  return writer.commit();
}

using MeshAndLists = std::pair<TriangleMesh, TriangleLists>;

// Reads the triangles, with one list for each of `leaves`, or without lists.
MeshAndLists read_mesh(TreeReader& reader, const Header& header,
                       std::optional<std::uint32_t> leaves) {
  MeshAndLists read;
  auto& [mesh, lists] = read;
  const auto counts = reader.value<std::array<std::uint64_t, 3>>();
  mesh.vertices = reader.points(counts[0]);
  mesh.triangles = reader.array<Triangle>(counts[1]);
  mesh.frame = static_cast<PatientFrame>(header.frame);
  mesh.unit = static_cast<LengthUnit>(header.unit);
  if (leaves) lists.first = reader.array<std::uint32_t>(std::uint64_t{*leaves} + 1);
  lists.ids = reader.array<std::uint32_t>(counts[2]);
  return read;
}

void verify_header(TreeReader& reader, const Header& header, const MeshSource& source) {
  reader.verify_checksum();
  reader.require(header.sections <= 31, "it lists an unknown section");
  reader.require(header.orientation <= static_cast<std::uint32_t>(Orientation::kAssumed),
                 "its orientation is unknown");
  verify_source(reader, header, source);
}

TreeParts parts_with(const Header& header, MeshSource source) {
  TreeParts parts;
  parts.orientation = static_cast<Orientation>(header.orientation);
  parts.source = std::move(source);
  parts.frame = static_cast<PatientFrame>(header.frame);
  return parts;
}

std::optional<OuterBalls> read_balls(TreeReader& reader, const Header& header) {
  if ((header.sections & kOuterBallsSection) == 0) return std::nullopt;
  return read_outer_balls(reader);
}

void keep(std::optional<OuterBalls> balls, const TreeParts& parts) {
  if (balls) parts.triangles->keep_outer_balls(std::move(*balls));
}

SphereTree read_without_voxels(TreeReader& reader, const Header& header, MeshSource source) {
  auto [mesh, lists] = read_mesh(reader, header, std::nullopt);
  StoredClusters clusters = read_clusters(reader, mesh.triangles.size());
  std::optional<OuterBalls> balls = read_balls(reader, header);
  verify_header(reader, header, source);
  verify_no_voxels(reader, header, mesh);
  reader.require(lists.ids.empty(), "it has leaves' triangles without voxels");
  if (balls) verify_outer_balls(reader, *balls);
  TreeParts parts = parts_with(header, std::move(source));
  const Eigen::Vector3d origin = middle_of(mesh);
  TriangleClusters made = verified(reader, std::move(clusters), mesh.triangles.size(), origin);
  parts.triangles.emplace(std::move(mesh), std::move(made));
  keep(std::move(balls), parts);
  return tree_from(std::move(parts));
}

SphereTree read(TreeReader reader) {
  const ScopedFloatEnvironment environment;
  const auto header = reader.value<Header>();
  const auto sections = header.sections;
  MeshSource source = read_source(reader, header);
  if (is_without_voxels(header)) return read_without_voxels(reader, header, std::move(source));
  const Lattice lattice{header.corner, header.voxel_size, header.cells,
                        static_cast<int>(header.depth)};
  StoredOctree stored = read_octree(reader, header.depth);
  std::vector<PackedNormal> normals = reader.array<PackedNormal>(stored.leaves);

  Levels<PackedBall> balls;
  if ((sections & kBallsSection) != 0) balls = read_bounds<PackedBall>(reader, stored);
  Levels<PackedSlab> slabs;
  if ((sections & kSlabsSection) != 0) slabs = read_bounds<PackedSlab>(reader, stored);
  std::optional<MeshAndLists> triangles;
  if ((sections & kTrianglesSection) != 0) triangles = read_mesh(reader, header, stored.leaves);
  std::optional<StoredOctree> proximity;
  if ((sections & kProximitySection) != 0) {
    const auto proximity_depth = reader.value<std::uint32_t>();
    proximity = read_octree(reader, proximity_depth);
  }
  StoredClusters clusters;
  if (triangles) clusters = read_clusters(reader, triangles->first.triangles.size());
  std::optional<OuterBalls> outer_balls = read_balls(reader, header);

  verify_header(reader, header, source);
  reader.require(slabs.empty() || !balls.empty(), "it has slabs without balls");
  reader.require(!outer_balls || triangles, "it has outer balls without triangles");
  if (outer_balls) verify_outer_balls(reader, *outer_balls);
  verify_lattice(reader, lattice);
  if (triangles) verify_triangles(reader, lattice, triangles->first, triangles->second);
  TreeParts parts = parts_with(header, std::move(source));
  TreeVoxels& voxels = parts.voxels.emplace(
      TreeVoxels{lattice, verified(reader, std::move(stored)), std::move(normals)});
  if (triangles) {
    TriangleMesh& mesh = triangles->first;
    TriangleClusters made =
        verified(reader, std::move(clusters), mesh.triangles.size(), lattice.origin());
    parts.triangles.emplace(std::move(mesh), std::move(made));
    voxels.lists = std::move(triangles->second);
    keep(std::move(outer_balls), parts);
  }
  voxels.bounds.balls =
      verified<BallBlock>(reader, voxels.octree, std::move(balls), "a ball has no radius");
  voxels.bounds.slabs = verified<SlabBlock>(reader, voxels.octree, std::move(slabs),
                                            "a slab's numbers are out of range");
  if (proximity) voxels.proximity = ProximityTree{verified(reader, std::move(*proximity))};
  return tree_from(std::move(parts));
}

}  // namespace

std::uint64_t write_tree(const SphereTree& tree, const std::filesystem::path& file) {
  const OuterBalls* balls = outer_balls_of(tree);
  return write(tree, balls, TreeWriter(file));
}

std::vector<std::byte> tree_to_bytes(const SphereTree& tree) {
  std::vector<std::byte> bytes;
  const OuterBalls* balls = outer_balls_of(tree);
  write(tree, balls, TreeWriter(bytes));
  return bytes;
}

SphereTree read_tree(const std::filesystem::path& file) { return read(TreeReader(file)); }

SphereTree tree_from_bytes(std::span<const std::byte> bytes, const std::string& name) {
  return read(TreeReader(bytes, name));
}

bool is_tree_file(const std::filesystem::path& file) {
  InputFile input(file);
  std::array<unsigned char, kTreeFileMagic.size()> magic{};
  return input.read(magic.data(), magic.size()) == magic.size() && magic == kTreeFileMagic;
}

}  // namespace ist
