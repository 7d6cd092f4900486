#include "ist/voxel/voxelizer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "ist/base/error.h"
#include "ist/base/float_environment.h"
#include "ist/base/ordered_vector.h"
#include "ist/base/parallel.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/bounding_box.h"
#include "ist/mesh/nearest_point.h"
#include "ist/voxel/triangle_bins.h"
#include "ist/voxel/triangle_clip.h"

namespace ist {
namespace {

constexpr double kMaxCount = 4294967294.0;  // limit of voxels and of pairs: indices have 32 bits

// A voxel's position in its block: x in bits 0 to 3, y in 4 to 7, z in 8 to 11.
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

// Calls visit(cell) for each voxel of the block that intersects the triangle, in the order of a
// TriangleSlicer.
template <typename Visit>
void for_each_voxel(const TriangleBox& triangle, const Cell& block, const Lattice& lattice,
                    const Visit& visit) {
  const double pad = inner_pad(lattice);
  const Eigen::Vector3d low = triangle.min().array() - 1 - pad;
  const Eigen::Vector3d high = (triangle.max().array() + pad).min(lattice.cells - 1.0);
  const double half = 0.5 + pad;
  const auto enter = [&](std::uint32_t x, std::uint32_t y) {
    return triangle.meets_column(x + 0.5, y + 0.5, half);
  };
  for_each_cell(block, low, high, enter, [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (triangle.meets_in_column(x + 0.5, y + 0.5, z + 0.5, half))
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

// Returns the number of nodes above the voxels of a block: eight voxels of one node are a byte.
std::uint64_t parents_of(std::span<const std::uint64_t> occupied) {
  constexpr std::uint64_t kLowBits = 0x7F7F7F7F7F7F7F7F;
  std::uint64_t parents = 0;
  for (const std::uint64_t word : occupied) {
    const std::uint64_t bytes = (((word & kLowBits) + kLowBits) | word) & ~kLowBits;
    parents += static_cast<std::uint64_t>(std::popcount(bytes));
  }
  return parents;
}

// The bytes of one block: its survey and its entries in the prefix sums.
constexpr double kBlockBytes =
    sizeof(BlockSurvey) + sizeof(std::unique_ptr<BlockSurvey>) + 3 * sizeof(std::uint64_t);

// All voxels and pairs of voxel and triangle, before any result is allocated.
struct Survey {
  TriangleBins bins;
  std::vector<std::unique_ptr<BlockSurvey>> blocks;
  std::vector<std::uint64_t> first_voxel;   // index of each block's first voxel, and the total
  std::vector<std::uint64_t> first_pair;    // index of each block's first pair, and the total
  std::vector<std::uint64_t> first_parent;  // index of the node above the first, and the total
  [[nodiscard]] std::uint64_t voxels() const { return first_voxel.back(); }
  [[nodiscard]] std::uint64_t pairs() const { return first_pair.back(); }
};

// How much there is of all that takes memory.
struct Counts {
  double blocks = 0, voxels = 0, pairs = 0;
};

// The memory of a mesh's voxels: what is allowed, and what they need.
class Memory {
 public:
  Memory(const TriangleMesh& mesh, const VoxelizerOptions& options)
      : options_(options), pairs_(mesh), triangles_(static_cast<double>(mesh.triangles.size())) {}

  [[nodiscard]] double needed(const Counts& counts) const {
    const double own = sizeof(std::uint64_t) + sizeof(PackedNormal) +
                       (options_.keep_triangles ? sizeof(std::uint32_t) : 0);
    const double own_pairs = options_.keep_triangles ? sizeof(std::uint32_t) : 0;
    return counts.blocks * kBlockBytes +
           counts.voxels * (own + static_cast<double>(options_.bytes_per_voxel)) +
           counts.pairs * (sizeof(BlockCell) + own_pairs) +
           triangles_ * static_cast<double>(options_.bytes_per_triangle);
  }
  // `spare`: by how much the counts may be too small, as a part of them.
  [[nodiscard]] bool holds(const Counts& counts, double spare = 0) const {
    const double by = 1 + spare;
    return by * counts.voxels <= kMaxCount && by * counts.pairs <= kMaxCount &&
           by * needed(counts) <= static_cast<double>(options_.max_memory);
  }
  // Returns false if voxels of one size certainly do not fit. The surface's area gives the least
  // number of pairs, without a look at any voxel. Three copies of the triangles' keys are needed
  // while blocks are sorted.
  [[nodiscard]] bool may_hold(double voxel_size) const {
    const double keys = pairs_.expected(voxel_size * TriangleBins::kEdge);
    return 3 * sizeof(std::uint64_t) * keys <= static_cast<double>(options_.max_memory) &&
           holds({.pairs = pairs_.least(voxel_size)});
  }
  // Returns the counts to expect. Voxels are no more than pairs.
  [[nodiscard]] Counts expected(double voxel_size) const {
    const double pairs = pairs_.expected(voxel_size);
    return {pairs_.expected(voxel_size * TriangleBins::kEdge), pairs, pairs};
  }

 private:
  const VoxelizerOptions& options_;
  PairCounts pairs_;
  double triangles_;
};

// The bins of a mesh, and the counts of one block after the other.
class Surveyor {
 public:
  Surveyor(const LatticeMesh& mesh, const Lattice& lattice, const TriangleBins& bins)
      : mesh_(mesh), lattice_(lattice), bins_(bins) {}

  // Finds the voxels of a block. Returns their number, and the number of pairs.
  Counts survey(std::size_t b, BlockSurvey& block) {
    const Cell place = morton_decode(bins_.codes[b]);
    cells_.clear();
    for (const std::uint32_t t : bins_.triangles[b]) {
      const std::size_t before = cells_.size();
      for_each_voxel(mesh_.box(t), place, lattice_, [&](BlockCell cell) {
        const std::size_t code = morton_in_block(cell);
        block.occupied[code / 64] |= std::uint64_t{1} << code % 64;
        cells_.push_back(cell);
      });
      block.cells_of.push_back(static_cast<std::uint16_t>(cells_.size() - before));
    }
    block.cells.assign(cells_.begin(), cells_.end());
    std::uint64_t voxels = 0;
    for (const std::uint64_t word : block.occupied) {
      voxels += static_cast<std::uint64_t>(std::popcount(word));
    }
    return {1, static_cast<double>(voxels), static_cast<double>(cells_.size())};
  }

 private:
  const LatticeMesh& mesh_;
  const Lattice& lattice_;
  const TriangleBins& bins_;
  std::vector<BlockCell> cells_;
};

// Adds up counts of several threads. Sums of whole numbers do not depend on their order.
class SharedCounts {
 public:
  // Returns all counts so far.
  Counts add(const Counts& more) {
    const auto plus = [](std::atomic<std::uint64_t>& sum, double count) {
      const auto by = static_cast<std::uint64_t>(count);
      return static_cast<double>(sum.fetch_add(by, std::memory_order_relaxed) + by);
    };
    return {plus(blocks_, more.blocks), plus(voxels_, more.voxels), plus(pairs_, more.pairs)};
  }

 private:
  std::atomic<std::uint64_t> blocks_{0}, voxels_{0}, pairs_{0};
};

// Finds all voxels and pairs. Returns nullopt as soon as they need too much memory.
std::optional<Survey> survey(const LatticeMesh& mesh, const Lattice& lattice, const Memory& memory,
                             Progress& progress) {
  progress.begin_stage("sorting triangles into blocks", 0);
  Survey result{bin_triangles(mesh, lattice.cells, lattice.pad()), {}, {}, {}, {}};
  const std::size_t blocks = result.bins.codes.size();
  if (!memory.holds({.blocks = static_cast<double>(blocks)})) return std::nullopt;
  progress.begin_stage("finding surface voxels", blocks);
  result.blocks.resize(blocks);
  result.first_voxel.resize(blocks + 1);
  result.first_pair.resize(blocks + 1);
  result.first_parent.resize(blocks + 1);
  SharedCounts found;
  std::atomic<bool> full{false};
  parallel_for(blocks, TriangleBins::kBlocksARange, [&](std::size_t begin, std::size_t end) {
    progress.check();
    if (full.load(std::memory_order_relaxed)) return;
    Surveyor surveyor(mesh, lattice, result.bins);
    Counts more;
    for (std::size_t b = begin; b < end; ++b) {
      result.blocks[b] = std::make_unique<BlockSurvey>();
      const Counts of_block = surveyor.survey(b, *result.blocks[b]);
      result.first_voxel[b + 1] = static_cast<std::uint64_t>(of_block.voxels);
      result.first_pair[b + 1] = static_cast<std::uint64_t>(of_block.pairs);
      result.first_parent[b + 1] = parents_of(result.blocks[b]->occupied);
      more = {more.blocks + 1, more.voxels + of_block.voxels, more.pairs + of_block.pairs};
    }
    if (!memory.holds(found.add(more))) full.store(true, std::memory_order_relaxed);
    progress.add(end - begin);
  });
  if (full || !memory.holds(found.add({}))) return std::nullopt;
  for (std::size_t b = 0; b < blocks; ++b) {
    result.first_voxel[b + 1] += result.first_voxel[b];
    result.first_pair[b + 1] += result.first_pair[b];
    result.first_parent[b + 1] += result.first_parent[b];
  }
  return result;
}

// Returns the survey at one voxel size, or nullopt if the voxels would not fit.
std::optional<Survey> fitting_survey(const TriangleMesh& mesh, const Lattice& lattice,
                                     const Memory& memory, Progress& progress) {
  if (!memory.may_hold(lattice.voxel_size)) return std::nullopt;
  return survey(LatticeMesh(mesh, lattice), lattice, memory, progress);
}

// Returns whether voxels of one size would fit, by some of their blocks: each so many-th. Where
// these are not all, a twentieth of the memory is to spare.
bool seems_to_fit(const TriangleMesh& mesh, const Lattice& lattice, const Memory& memory,
                  const Progress& progress) {
  constexpr std::size_t kBlocks = 1024;
  constexpr double kSpare = 0.05;
  if (!memory.may_hold(lattice.voxel_size)) return false;
  const LatticeMesh lattice_mesh(mesh, lattice);
  const TriangleBins bins = bin_triangles(lattice_mesh, lattice.cells, lattice.pad());
  const std::size_t blocks = bins.codes.size(), each = (blocks + kBlocks - 1) / kBlocks;
  const std::size_t looks = (blocks + each - 1) / each;
  SharedCounts found;
  parallel_for(looks, TriangleBins::kBlocksARange, [&](std::size_t begin, std::size_t end) {
    progress.check();
    Surveyor surveyor(lattice_mesh, lattice, bins);
    for (std::size_t k = begin; k < end; ++k) {
      BlockSurvey block;
      found.add(surveyor.survey(k * each, block));
    }
  });
  const Counts seen = found.add({});
  const double all = static_cast<double>(blocks) / static_cast<double>(looks);
  return memory.holds({static_cast<double>(blocks), all * seen.voxels, all * seen.pairs},
                      each > 1 ? kSpare : 0);
}

// Returns a voxel size near the one from which on the expected counts fit.
double expected_size(const Memory& memory, double least, double most) {
  constexpr double kNear = 1.05;
  while (least * kNear < most) {
    const double middle = std::sqrt(least * most);
    (memory.holds(memory.expected(middle)) ? most : least) = middle;
  }
  return most;
}

[[noreturn]] void refuse(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box,
                         const VoxelizerOptions& options, const Memory& memory,
                         const Progress& progress) {
  constexpr double kNear = 1.02;
  double step = 1.1;
  const auto fits = [&](double size) {
    return seems_to_fit(mesh, make_lattice(box.min(), box.max(), size), memory, progress);
  };
  const double one_voxel = std::max(options.voxel_size, box.sizes().maxCoeff());
  double too_small = options.voxel_size;
  double enough = expected_size(memory, too_small, one_voxel);
  if (fits(enough)) {
    for (double next = enough; next > options.voxel_size;) {
      next = std::max(options.voxel_size, next / step);
      step = std::min(2.0, step * step);
      too_small = next;
      if (next == options.voxel_size || !fits(next)) break;
      enough = next;
    }
  } else {
    do {
      if (enough >= one_voxel) {
        throw_error(ErrorCode::kMemoryLimit,
                    "the mesh has {} triangles, and needs more than the allowed {} bytes of "
                    "memory with voxels of any size: allow more memory, or simplify it",
                    mesh.triangles.size(), options.max_memory);
      }
      too_small = enough;
      enough = std::min(one_voxel, step * enough);
      step = std::min(2.0, step * step);
    } while (!fits(enough));
  }
  while (enough > kNear * too_small) {
    const double middle = std::sqrt(too_small * enough);
    (fits(middle) ? enough : too_small) = middle;
  }
  double named = round_to_nice_number(enough, 2);
  while (!fits(named)) named = round_to_nice_number(1.01 * named, 2);
  const Counts expected = memory.expected(options.voxel_size);
  const std::string needs =
      expected.pairs > kMaxCount
          ? fmt::format("some {:.2g} pairs of voxel and triangle, and the limit is 2^32",
                        expected.pairs)
          : fmt::format("more than the allowed {} bytes of memory, some {:.2g}: allow more memory",
                        options.max_memory, memory.needed(expected));
  throw_error(ErrorCode::kMemoryLimit, "voxel size {} needs {}{} use a voxel size of {} or larger",
              options.voxel_size, needs, expected.pairs > kMaxCount ? ":" : ", or", named);
}

// Sums the normals in the voxels of one block, and writes the voxels to their places.
class BlockWriter {
 public:
  // @param visitor takes the geometry of each voxel, if not null
  BlockWriter(const LatticeMesh& mesh, const Survey& survey, VoxelSet& set, PayloadVisitor* visitor)
      : mesh_(mesh), survey_(survey), set_(set), visitor_(visitor) {
    // Lattice coordinates and the corners of clipped pieces err by at most sixteen 2⁻⁵³ of the
    // grid's extent: two roundings for a coordinate, and three or four for each of three cuts.
    payload_.pad = 0x1p-48 * (2 * set.lattice.root_centre());
  }

  void write(std::size_t b) {
    const BlockSurvey& block = *survey_.blocks[b];
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
    pairs_.clear();
    pieces_.clear();
    points_.clear();
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
    if (set_.triangles.empty() && visitor_ == nullptr) return;
    order_pairs();
    if (!set_.triangles.empty()) write_lists(b);
    if (visitor_ != nullptr) visit_voxels(b);
  }

 private:
  struct Sum {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double area = 0;
    Eigen::Vector3d vector_area = Eigen::Vector3d::Zero();  // of the pieces, up to a factor
    std::uint32_t triangles = 0;
  };
  // The part of a triangle in a voxel, or its nearest point if there is no part.
  struct Piece {
    std::uint32_t first, count;  // of its points
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
      pairs_.push_back({rank, t});
      Sum& sum = sums_[rank];
      ++sum.triangles;
      if (!normal && visitor_ == nullptr) continue;
      const std::uint32_t x = block[0] * TriangleBins::kEdge + (cell & 15u),
                          y = block[1] * TriangleBins::kEdge + (cell >> 4 & 15u),
                          z = block[2] * TriangleBins::kEdge + (cell >> 8 & 15u);
      const ClippedTriangle& inside = slicer.cube(x, y, z);
      if (visitor_ != nullptr) keep(corners, inside, {x + 0.5, y + 0.5, z + 0.5}, sum);
      if (!normal) continue;
      const double area = kTouch + inside.projected_area(static_cast<int>(steepest)) / slope;
      sum.normal += area * *normal;
      sum.area += area;
    }
  }

  void keep(const std::array<Eigen::Vector3d, 3>& corners, const ClippedTriangle& inside,
            const Eigen::Vector3d& centre, Sum& sum) {
    const auto first = static_cast<std::uint32_t>(points_.size());
    const auto* const piece = inside.corners.data();
    points_.insert(points_.end(), piece, piece + inside.count);
    for (int i = 2; i < inside.count; ++i) {
      add_to(sum.vector_area,
             cross_in_order(difference(piece[i - 1], piece[0]), difference(piece[i], piece[0])));
    }
    if (inside.count == 0) points_.push_back(nearest_on_triangle(corners, centre).point);
    pieces_.push_back({first, static_cast<std::uint32_t>(points_.size()) - first});
  }

  // Lists the pairs voxel by voxel: in the order of a counting sort, which keeps the triangles'.
  void order_pairs() {
    first_.assign(sums_.size() + 1, 0);
    for (std::size_t i = 0; i < sums_.size(); ++i) first_[i + 1] = first_[i] + sums_[i].triangles;
    next_.assign(first_.begin(), first_.end());
    order_.resize(pairs_.size());
    for (std::uint32_t pair = 0; pair < pairs_.size(); ++pair) {
      order_[next_[pairs_[pair].rank]++] = pair;
    }
  }

  void write_lists(std::size_t b) {
    const std::uint64_t first = survey_.first_pair[b];
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      set_.triangles.first[survey_.first_voxel[b] + i] =
          static_cast<std::uint32_t>(first + first_[i]);
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
      set_.triangles.ids[first + i] = pairs_[order_[i]].triangle;
    }
  }

  void visit_voxels(std::size_t b) {
    const std::uint64_t first_code = survey_.bins.codes[b] * TriangleBins::kBlockCells;
    std::uint64_t parent = survey_.first_parent[b], before = 0;
    int slot = -1;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const std::uint64_t code = set_.codes[survey_.first_voxel[b] + i];
      const std::uint64_t here = (code - first_code) >> 3;
      if (i > 0 && here != before) {
        ++parent;
        slot = -1;
      }
      before = here;
      payload_.points.clear();
      for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k) {
        const Piece& piece = pieces_[order_[k]];
        const auto* const points = points_.data() + piece.first;
        payload_.points.insert(payload_.points.end(), points, points + piece.count);
      }
      payload_.area = sums_[i].vector_area;
      payload_.is_flat = sums_[i].triangles == 1;
      visitor_->visit(parent, ++slot, morton_decode(code), payload_);
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
  PayloadVisitor* visitor_;
  std::array<std::uint16_t, TriangleBins::kBlockCells> rank_{};  // rank of each voxel in its block
  struct Pair {
    std::uint16_t rank;  // of the voxel
    std::uint32_t triangle;
  };
  std::vector<Pair> pairs_;
  std::vector<Sum> sums_;
  std::vector<std::uint32_t> first_, next_, order_;  // of each voxel: its pairs
  std::vector<Piece> pieces_;                        // of each pair, for the visitor
  std::vector<Eigen::Vector3d> points_;
  Payload payload_;
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
    throw_error(ErrorCode::kMemoryLimit,
                "the mesh has {} triangles, and the limit is {}: simplify the mesh",
                mesh.triangles.size(), kMaxTriangles);
  }
  VoxelSet set;
  set.lattice = make_lattice(box.min(), box.max(), options.voxel_size);
  const Memory memory(mesh, options);
  const std::optional<Survey> found = fitting_survey(mesh, set.lattice, memory, shown);
  if (!found) refuse(mesh, box, options, memory, shown);

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
  if (options.visitor != nullptr) options.visitor->begin(set.lattice, found->first_parent.back());
  parallel_for(blocks, TriangleBins::kBlocksARange, [&](std::size_t begin, std::size_t end) {
    const auto writer = std::make_unique<BlockWriter>(lattice_mesh, *found, set, options.visitor);
    for (std::size_t b = begin; b < end; ++b) {
      shown.check();
      writer->write(b);
    }
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
  return fitting_survey(mesh, make_lattice(box.min(), box.max(), options.voxel_size),
                        Memory(mesh, options), progress != nullptr ? *progress : unseen)
      .has_value();
}

}  // namespace ist
