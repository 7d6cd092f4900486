#include "ist/voxel/voxelizer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/mesh/bounding_box.h"
#include "ist/voxel/triangle_bins.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {
namespace {

constexpr double kMaxCount = 4294967294.0;  // limit of voxels and of pairs: indices have 32 bits

// A voxel's position in its block: x in bits 0 to 3, y in 4 to 7, z in 8 to 11; ascending along x
// first.
using BlockCell = std::uint16_t;

std::size_t morton_in_block(BlockCell cell) {
  // The spread bits of 0 … 15 reduce a cell's code to three look-ups.
  static constexpr std::array<std::uint16_t, TriangleBins::kEdge> kSpread = [] {
    std::array<std::uint16_t, TriangleBins::kEdge> spread{};
    for (std::uint32_t i = 0; i < spread.size(); ++i) {
      spread[i] = static_cast<std::uint16_t>(spread_bits(i));
    }
    return spread;
  }();
  return static_cast<std::size_t>(kSpread[cell & 15] | kSpread[cell >> 4 & 15] << 1 |
                                  kSpread[cell >> 8] << 2);
}

// Returns the pad of the tests: a little less than the guaranteed pad, so that rounding cannot
// exceed the guarantee.
double inner_pad(const Lattice& lattice) { return lattice.pad() * (1 - 1.0 / 1024); }

// Calls visit(cell) for each voxel of the block that intersects the triangle, ascending.
template <typename Visit>
void for_each_voxel(const TriangleBox& triangle, const Cell& block, const Lattice& lattice,
                    const Visit& visit) {
  const double pad = inner_pad(lattice);
  const Eigen::Vector3d low = triangle.min().array() - 1 - pad;
  const Eigen::Vector3d high = (triangle.max().array() + pad).min(lattice.cells - 1.0);
  for_each_cell(block, low, high, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (triangle.meets_within_bounds(x + 0.5, y + 0.5, z + 0.5, 0.5 + pad))
      visit(static_cast<BlockCell>((x & 15) | (y & 15) << 4 | (z & 15) << 8));
  });
}

// The occupied voxels of one block and the triangles in them.
struct BlockSurvey {
  std::array<std::uint64_t, TriangleBins::kBlockCells / 64>
      occupied{};                       // bit by Morton code in the block
  std::vector<BlockCell> cells;         // voxels of the first triangle, of the second …
  std::vector<std::uint16_t> cells_of;  // number of voxels of each triangle
};

// The bytes of one block: its survey and its entries in the prefix sums.
constexpr double kBlockBytes = sizeof(BlockSurvey) + 2 * sizeof(std::uint64_t);

// All voxels and pairs of voxel and triangle, before any result is allocated.
struct Survey {
  TriangleBins bins;
  std::size_t triangles;  // number in the mesh
  std::vector<BlockSurvey> blocks;
  std::vector<std::uint64_t> first_voxel;  // index of each block's first voxel, and the total
  std::vector<std::uint64_t> first_pair;   // index of each block's first pair, and the total
  [[nodiscard]] std::uint64_t voxels() const { return first_voxel.back(); }
  [[nodiscard]] std::uint64_t pairs() const { return first_pair.back(); }
};

// Finds all voxels and pairs. Returns nullopt if the blocks alone need more than `max_bytes`.
std::optional<Survey> survey(const LatticeMesh& mesh, const Lattice& lattice, double max_bytes,
                             Progress& progress) {
  progress.begin_stage("sorting triangles into blocks", 0);
  Survey result{
      bin_triangles(mesh, lattice.cells, lattice.pad()), mesh.triangle_count(), {}, {}, {}};
  const std::size_t blocks = result.bins.codes.size();
  if (static_cast<double>(blocks) * kBlockBytes > max_bytes) return std::nullopt;
  progress.begin_stage("finding surface voxels", blocks);
  result.blocks.resize(blocks);
  result.first_voxel.resize(blocks + 1);
  result.first_pair.resize(blocks + 1);
  parallel_for(blocks, TriangleBins::kBlocksARange, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<BlockCell> cells;
    for (std::size_t b = begin; b < end; ++b) {
      BlockSurvey& block = result.blocks[b];
      const Cell place = morton_decode(result.bins.codes[b]);
      cells.clear();
      for (const std::uint32_t t : result.bins.triangles[b]) {
        const std::size_t before = cells.size();
        for_each_voxel(mesh.box(t), place, lattice, [&](BlockCell cell) {
          const std::size_t code = morton_in_block(cell);
          block.occupied[code / 64] |= std::uint64_t{1} << code % 64;
          cells.push_back(cell);
        });
        block.cells_of.push_back(static_cast<std::uint16_t>(cells.size() - before));
      }
      block.cells.assign(cells.begin(), cells.end());
      std::uint64_t voxels = 0;
      for (const std::uint64_t word : block.occupied) {
        voxels += static_cast<std::uint64_t>(std::popcount(word));
      }
      result.first_voxel[b + 1] = voxels;
      result.first_pair[b + 1] = cells.size();
    }
    progress.add(end - begin);
  });
  for (std::size_t b = 0; b < blocks; ++b) {
    result.first_voxel[b + 1] += result.first_voxel[b];
    result.first_pair[b + 1] += result.first_pair[b];
  }
  return result;
}

double bytes_needed(const Survey& survey, const VoxelizerOptions& options) {
  const auto voxels = static_cast<double>(survey.voxels());
  const auto pairs = static_cast<double>(survey.pairs());
  if (voxels > kMaxCount || pairs > kMaxCount) return HUGE_VAL;
  const double own = sizeof(std::uint64_t) + sizeof(PackedNormal) +
                     (options.keep_triangles ? sizeof(std::uint32_t) : 0);
  const double own_pairs = options.keep_triangles ? sizeof(std::uint32_t) : 0;
  return static_cast<double>(survey.blocks.size()) * kBlockBytes +
         voxels * (own + static_cast<double>(options.bytes_per_voxel)) +
         pairs * (sizeof(BlockCell) + own_pairs) +
         static_cast<double>(survey.triangles) * static_cast<double>(options.bytes_per_triangle);
}

// Estimates the survey's memory, before the survey is made: keys of the bins, stored twice while
// they are joined, and a cell for each pair.
double survey_bytes(const TriangleMesh& mesh, double voxel_size) {
  return 3 * sizeof(std::uint64_t) * expected_pairs(mesh, voxel_size * TriangleBins::kEdge) +
         sizeof(BlockCell) * expected_pairs(mesh, voxel_size);
}

// Returns the survey at one voxel size, or nullopt if the voxels would not fit.
std::optional<Survey> fitting_survey(const TriangleMesh& mesh, const Lattice& lattice,
                                     const VoxelizerOptions& options, Progress& progress) {
  const auto limit = static_cast<double>(options.max_memory);
  if (survey_bytes(mesh, lattice.voxel_size) > limit) return std::nullopt;
  const LatticeMesh lattice_mesh(mesh, lattice);
  std::optional<Survey> result = survey(lattice_mesh, lattice, limit, progress);
  if (result && bytes_needed(*result, options) > limit) result.reset();
  return result;
}

[[noreturn]] void refuse(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box,
                         const VoxelizerOptions& options, Progress& progress) {
  const auto fits = [&](double size) {
    const Lattice lattice = make_lattice(box.min(), box.max(), size);
    return fitting_survey(mesh, lattice, options, progress).has_value();
  };
  const double one_voxel = box.sizes().maxCoeff();
  double too_small = options.voxel_size, enough = too_small;
  while (enough < one_voxel && !fits(enough = std::min(one_voxel, 2 * enough))) too_small = enough;
  if (!fits(enough)) {
    throw Error(
        ErrorCode::kMemoryLimit,
        fmt::format("the mesh has {} triangles, and needs more than the allowed {} bytes of "
                    "memory with voxels of any size: allow more memory, or simplify it",
                    mesh.triangles.size(), options.max_memory));
  }
  for (int step = 0; step < 6; ++step) {
    const double middle = std::sqrt(too_small * enough);
    (fits(middle) ? enough : too_small) = middle;
  }
  double named = round_up_for_people(enough);
  while (!fits(named)) named = round_up_for_people(1.01 * named);
  throw Error(
      ErrorCode::kMemoryLimit,
      fmt::format(
          "voxel size {} needs more than the allowed {} bytes of memory, or more than 2^32 "
          "voxels or pairs of voxel and triangle: allow more memory, or use a voxel size of "
          "{} or larger",
          options.voxel_size, options.max_memory, named));
}

// Sums the normals in the voxels of one block, and writes the voxels to their places.
class BlockWriter {
 public:
  BlockWriter(const LatticeMesh& mesh, const Survey& survey, VoxelSet& set)
      : mesh_(mesh), survey_(survey), set_(set) {}

  void write(std::size_t b) {
    const BlockSurvey& block = survey_.blocks[b];
    const std::uint64_t code = survey_.bins.codes[b];
    std::uint16_t voxels = 0;
    for (std::size_t word = 0; word < block.occupied.size(); ++word) {
      for (std::uint64_t bits = block.occupied[word]; bits != 0; bits &= bits - 1) {
        const std::size_t in_block = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
        rank_[in_block] = voxels;
        set_.codes[survey_.first_voxel[b] + voxels++] = code * TriangleBins::kBlockCells + in_block;
      }
    }
    sums_.assign(voxels, {});
    ranks_.clear();
    std::size_t next = 0;
    const auto triangles = survey_.bins.triangles[b];
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const std::size_t count = block.cells_of[i];
      add(triangles[i], morton_decode(code), {block.cells.data() + next, count});
      next += count;
    }
    for (std::uint32_t i = 0; i < voxels; ++i) {
      set_.normals[survey_.first_voxel[b] + i] = PackedNormal(sums_[i].normal, sums_[i].area);
    }
    if (!set_.triangles.empty()) write_lists(b);
  }

 private:
  struct Sum {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double area = 0;
    std::uint32_t triangles = 0;
  };

  void add(std::uint32_t t, const Cell& block, std::span<const BlockCell> cells) {
    // The minimum weight, so that a triangle with no area in the voxel counts, but less than any
    // other.
    constexpr double kTouch = 1e-6;
    const auto corners = mesh_.corners(t);
    const std::optional<Eigen::Vector3d> normal = unit_normal(corners);
    Eigen::Index steepest = 0;
    const double slope = normal ? normal->cwiseAbs().maxCoeff(&steepest) : 1;
    TriangleSlicer slicer(corners, set_.lattice.pad());
    for (const BlockCell cell : cells) {
      const std::uint16_t rank = rank_[morton_in_block(cell)];
      ranks_.push_back(rank);
      Sum& sum = sums_[rank];
      ++sum.triangles;
      if (!normal) continue;
      const ClippedTriangle& inside =
          slicer.cube(block[0] * TriangleBins::kEdge + (cell & 15u),
                      block[1] * TriangleBins::kEdge + (cell >> 4 & 15u),
                      block[2] * TriangleBins::kEdge + (cell >> 8 & 15u));
      const double area = kTouch + inside.projected_area(static_cast<int>(steepest)) / slope;
      sum.normal += area * *normal;
      sum.area += area;
    }
  }

  void write_lists(std::size_t b) {
    std::uint64_t next = survey_.first_pair[b];
    std::uint32_t* first = set_.triangles.first.data() + survey_.first_voxel[b];
    for (Sum& sum : sums_) {
      *first++ = static_cast<std::uint32_t>(next);
      next += sum.triangles;
      sum.triangles = 0;
    }
    first -= sums_.size();
    const BlockSurvey& block = survey_.blocks[b];
    const auto triangles = survey_.bins.triangles[b];
    std::size_t pair = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (std::uint16_t count = block.cells_of[i]; count > 0; --count, ++pair) {
        const std::uint16_t rank = ranks_[pair];
        set_.triangles.ids[first[rank] + sums_[rank].triangles++] = triangles[i];
      }
    }
  }

  static std::optional<Eigen::Vector3d> unit_normal(const std::array<Eigen::Vector3d, 3>& corners) {
    const Eigen::Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
    const Eigen::Vector3d twice_area = ab.cross(ac);
    const double square = square_in_order(twice_area);
    // Scale-free: compares the area with the square of the longest edge, an upper bound.
    const double longest =
        std::max({square_in_order(ab), square_in_order(ac), square_in_order(ab - ac)});
    if (!(square > 1e-24 * longest * longest)) return std::nullopt;
    return twice_area / std::sqrt(square);
  }

  const LatticeMesh& mesh_;
  const Survey& survey_;
  VoxelSet& set_;
  std::array<std::uint16_t, TriangleBins::kBlockCells> rank_{};  // rank of each voxel in its block
  std::vector<std::uint16_t> ranks_;                             // rank of each pair's voxel
  std::vector<Sum> sums_;
};

}  // namespace

Lattice lattice_of(const TriangleMesh& mesh, double voxel_size) {
  const ScopedFloatEnvironment environment;
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  return make_lattice(box.min(), box.max(), voxel_size);
}

std::optional<Error> lattice_flaw(const TriangleMesh& mesh, double voxel_size) {
  const ScopedFloatEnvironment environment;
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  return lattice_flaw(box.min(), box.max(), voxel_size);
}

VoxelSet voxelize(const TriangleMesh& mesh, const VoxelizerOptions& options, Progress* progress) {
  const ScopedFloatEnvironment environment;
  Progress unseen;
  Progress& shown = progress != nullptr ? *progress : unseen;
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  if (mesh.triangles.size() > kMaxTriangles) {
    throw Error(ErrorCode::kMemoryLimit,
                fmt::format("the mesh has {} triangles, and the limit is {}: simplify the mesh",
                            mesh.triangles.size(), kMaxTriangles));
  }
  VoxelSet set;
  set.lattice = make_lattice(box.min(), box.max(), options.voxel_size);
  const std::optional<Survey> found = fitting_survey(mesh, set.lattice, options, shown);
  if (!found) refuse(mesh, box, options, shown);

  const LatticeMesh lattice_mesh(mesh, set.lattice);
  const std::size_t blocks = found->bins.codes.size();
  shown.begin_stage("writing voxels and normals", blocks);
  set.codes.resize(found->voxels());
  set.normals.resize(found->voxels());
  if (options.keep_triangles) {
    set.triangles.first.resize(found->voxels() + 1);
    set.triangles.first.back() = static_cast<std::uint32_t>(found->pairs());
    set.triangles.ids.resize(found->pairs());
  }
  parallel_for(blocks, TriangleBins::kBlocksARange, [&](std::size_t begin, std::size_t end) {
    shown.check();
    const auto writer = std::make_unique<BlockWriter>(lattice_mesh, *found, set);
    for (std::size_t b = begin; b < end; ++b) writer->write(b);
    shown.add(end - begin);
  });
  return set;
}

bool can_voxelize(const TriangleMesh& mesh, const VoxelizerOptions& options, Progress* progress) {
  const ScopedFloatEnvironment environment;
  Progress unseen;
  const Eigen::AlignedBox3d box = bounding_box(mesh);
  if (mesh.triangles.size() > kMaxTriangles) return false;
  if (lattice_flaw(box.min(), box.max(), options.voxel_size)) return false;
  return fitting_survey(mesh, make_lattice(box.min(), box.max(), options.voxel_size), options,
                        progress != nullptr ? *progress : unseen)
      .has_value();
}

}  // namespace ist
