// Damaged tree files: whatever is wrong with one, reading it ends in an ist::Error.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_stream.h"
#include "support/errors.h"
#include "support/largest_allocation.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/tree_file.h"

namespace ist {
namespace {

using test::TreeFile;

const SphereTree& small_tree() {
  static const SphereTree tree = [] {
    BuildOptions options;
    options.voxel_size = 0.7;
    options.spheres = SpherePolicy::kSlab;
    options.keep_triangles = true;
    options.proximity = true;
    options.source = {"bär.stl", 0x123456789ABCDEF0, LengthUnit::kMillimetre};
    return build_tree(test::box({0, 0, 0}, {2, 1, 1}), options);
  }();
  return tree;
}

const TreeFile& small_file() {
  static const TreeFile file(small_tree());
  return file;
}

std::string error_of_bytes(const std::string& bytes) {
  return test::error_name([&] { (void)test::tree_of_bytes(bytes); });
}

// One damaged field; the checksum is right again.
struct Damage {
  const char* name;
  std::function<void(TreeFile&)> apply;
  const char* error = "tree-corrupt";
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class DamagedField : public testing::TestWithParam<Damage> {};

TEST_P(DamagedField, IsAnError) {
  TreeFile file = small_file();
  ASSERT_EQ(error_of_bytes(file.bytes), "none");
  GetParam().apply(file);
  ASSERT_NE(file.bytes, small_file().bytes) << "nothing was damaged";
  file.seal();
  EXPECT_EQ(error_of_bytes(file.bytes), GetParam().error);
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename T>
Damage put(const char* name, std::size_t offset, T value, const char* error = "tree-corrupt") {
  return {name, [=](TreeFile& f) { f.put<T>(offset, value); }, error};
}

// At a place that is known only with the file.
template <typename T>
Damage put(const char* name, std::size_t TreeFile::*array, std::size_t offset, T value,
           const char* error = "tree-corrupt") {
  return {name, [=](TreeFile& f) { f.put<T>(f.*array + offset, value); }, error};
}

template <typename T>
Damage add(const char* name, std::size_t TreeFile::*array, std::size_t offset, T change,
           const char* error = "tree-corrupt") {
  return {name,
          [=](TreeFile& f) {
            const std::size_t at = f.*array + offset;
            f.put<T>(at, static_cast<T>(f.get<T>(at) + change));
          },
          error};
}

// The section that they stand in, and its bit.
void drop_balls(TreeFile& file) {
  file.bytes.erase(file.balls, file.slabs - file.balls);
  file.put(TreeFile::kSections, file.get<std::uint32_t>(TreeFile::kSections) & ~1u);
}

const std::vector<Damage>& damages() {
  using F = TreeFile;
  constexpr std::uint32_t kMany = 0xFFFFFFFF;
  static const std::vector<Damage> all = {
      put("CornerNaN", F::kCorner, kNaN),
      put("CornerInfinite", F::kCorner + 16, -kInfinity),
      put("VoxelSizeZero", F::kVoxelSize, 0.0),
      put("VoxelSizeNegative", F::kVoxelSize, -0.7),
      put("VoxelSizeNaN", F::kVoxelSize, kNaN),
      put("VoxelSizeInfinite", F::kVoxelSize, kInfinity),
      put("VoxelSizeBeyondAllMeasure", F::kVoxelSize, 1e300),
      put("VoxelSizeBelowAllMeasure", F::kVoxelSize, 1e-30),
      put("VoxelSizeDenormal", F::kVoxelSize, std::numeric_limits<double>::denorm_min()),
      put("CellsZero", F::kCells, 0u),
      put("CellsTooMany", F::kCells, 70000u),
      put("CellsOfAnotherDepth", F::kCells, 9u),
      put("DepthOneMore", F::kDepth, 3u, "tree-truncated"),
      put("DepthHuge", F::kDepth, kMany),
      put("OrientationUnknown", F::kOrientation, 7u),
      put("SectionUnknown", F::kSections, 47u),
      put("SectionMissing", F::kSections, 11u),
      {"SlabsWithoutBalls", drop_balls},
      put("UnitUnknown", F::kUnit, 5u),
      put("FrameUnknown", F::kUnit, 0x301u),
      put("BytesBesideTheFrame", F::kUnit, 0x10001u),
      put("NameLongerThanNamesAre", F::kNameBytes, 256u),
      put("NameLengthHuge", F::kNameBytes, kMany),
      put("NameLongerThanTheFile", F::kNameBytes, 255u, "tree-truncated"),
      put("NameOneByteShorter", F::kNameBytes, 7u, "tree-truncated"),
      put("NameInAFolder", F::kName, '/'),
      put("NameInAFolderOfWindows", F::kName, '\\'),
      put("NameWithALineBreak", F::kName, '\n'),
      put("NameWithDelete", F::kName, '\x7F'),
      put("NameWithAControlOfLatin1", F::kName + 1, std::array<std::uint8_t, 2>{0xC2, 0x85}),
      put("NameNotUtf8", F::kName + 2, 'a'),
      add("NodeCountOneMore", &F::leaves, static_cast<std::size_t>(-8), 1u, "tree-truncated"),
      add("NodeCountOneLess", &F::leaves, static_cast<std::size_t>(-8), kMany, "tree-truncated"),
      put("NodeCountHuge", &F::nodes, 0, kMany, "tree-truncated"),
      add("LeafCountOneMore", &F::leaves, 0, 1u),
      add("LeafCountOneLess", &F::leaves, 0, kMany, "tree-truncated"),
      put("LeafCountHuge", &F::leaves, 0, kMany, "tree-truncated"),
      put("MaskZero", &F::masks, 0, std::uint8_t{0}),
      add("MaskWithAnotherNumberOfChildren", &F::masks, 0, std::uint8_t{0x80}),
      put("BallRadiusZero", &F::balls, 6, std::uint16_t{0}),
      put("BallRadiusOfTheRootZero", &F::slabs, static_cast<std::size_t>(-2), std::uint16_t{0}),
      put("SlabNormalTooLong", &F::slabs, 0, std::array<std::int8_t, 3>{100, 100, 0}),
      put("SlabNormalXTooSmall", &F::slabs, 0, std::array<std::int8_t, 3>{-128, 0, 0}),
      put("SlabNormalYTooSmall", &F::slabs, 0, std::array<std::int8_t, 3>{0, -128, 0}),
      put("SlabNormalZTooSmall", &F::slabs, 0, std::array<std::int8_t, 3>{0, 0, -128}),
      put("SlabOffsetTooSmall", &F::slabs, 3, std::int8_t{-128}),
      put("SlabWithoutWidth", &F::slabs, 4, std::uint8_t{0}),
      put("SlabOfTheRootWithoutWidth", &F::counts, static_cast<std::size_t>(-1), std::uint8_t{0}),
      put("VertexCountHuge", &F::counts, 0, ~std::uint64_t{0}, "tree-truncated"),
      put("TriangleCountHuge", &F::counts, 8, std::uint64_t{1} << 60, "tree-truncated"),
      put("ListCountHuge", &F::counts, 16, std::uint64_t{1} << 62, "tree-truncated"),
      put("VertexNaN", &F::vertices, 8, kNaN),
      put("VertexInfinite", &F::triangles, static_cast<std::size_t>(-8), kInfinity),
      put("VertexBeforeTheGrid", &F::vertices, 0, -std::numeric_limits<double>::denorm_min()),
      put("VertexBehindTheGrid", &F::vertices, 16, 2.2),
      put("VertexBeyondAllMeasure", &F::vertices, 0, 1e300),
      put("TriangleNamesAVertexThatIsNotThere", &F::triangles, 4, 8u),
      put("ListsDoNotBeginAtZero", &F::list_begins, 0, 1u),
      put("ListsDecrease", &F::list_begins, 8, 0u),
      put("ListEmpty", &F::list_begins, 4, 0u),
      put("ListBeginsBeyondTheEntries", &F::list_begins, 8, 0x7FFFFFFFu),
      add("ListsEndBeforeTheEntries", &F::list_ids, static_cast<std::size_t>(-4), kMany),
      put("ListNamesATriangleThatIsNotThere", &F::list_ids, 0, 12u),
      {"ListNotAscending",
       [](F& f) {
         const auto first = f.get<std::uint32_t>(f.list_ids);
         f.put(f.list_ids, f.get<std::uint32_t>(f.list_ids + 4));
         f.put(f.list_ids + 4, first);
       }},
      {"ListNamesATriangleTwice",
       [](F& f) { f.put(f.list_ids, f.get<std::uint32_t>(f.list_ids + 4)); }},
      put("ProximityDepthHuge", &F::proximity_depth, 0, 18u),
      add("ProximityDepthOneMore", &F::proximity_depth, 0, 1u, "tree-truncated"),
      put("ProximityMaskZero", &F::proximity_masks, 0, std::uint8_t{0}),
      add("ProximityLeafCountWrong", &F::proximity_leaves, 0, 1u),
      put("ProximityNodeCountHuge", &F::proximity_nodes, 0, kMany, "tree-truncated"),
      put("AxisOfClustersNaN", &F::axes, 0, kNaN),
      put("AxisOfClustersTooLong", &F::axes, 64, -1.01),
      put("GridZero", &F::axes, 72, 0.0),
      put("GridNegative", &F::axes, 72, -0.5),
      put("GridInfinite", &F::axes, 72, kInfinity),
      put("GridNoPowerOfTwo", &F::axes, 72, 0.75),
      put("BoundOfAClusterNaN", &F::blocks, 0, std::numeric_limits<float>::quiet_NaN()),
      put("BoundOfTheRootInfinite", &F::clusters, static_cast<std::size_t>(-64),
          std::numeric_limits<float>::infinity()),
      put("CornerOfAClusterNaN", &F::clusters, 0, std::numeric_limits<float>::quiet_NaN()),
      put("ClusterNamesATriangleThatIsNotThere", &F::clusters, 576, 12u),
      put("AxisOfAClusterInfinite", &F::clusters, 640, -std::numeric_limits<float>::infinity()),
      put("RangeOfAClusterNaN", &F::clusters, 676, std::numeric_limits<float>::quiet_NaN()),
      put("BytesBehindACluster", &F::clusters, 700, 1u),
  };
  return all;
}

INSTANTIATE_TEST_SUITE_P(TreeFile, DamagedField, testing::ValuesIn(damages()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(DamagedTree, EachFieldOfThePreambleHasAnErrorOfItsOwn) {
  const auto with = [](std::size_t offset, auto value) {
    TreeFile file = small_file();
    file.put(offset, value);
    return error_of_bytes(file.bytes);
  };
  EXPECT_EQ(with(TreeFile::kMagic, 'x'), "not-a-tree");
  EXPECT_EQ(with(TreeFile::kVersion, 6u), "tree-version");
  EXPECT_EQ(with(TreeFile::kVersion, 0u), "tree-version");
  EXPECT_EQ(with(TreeFile::kByteOrder, 0x04030201u), "not-a-tree");
  EXPECT_EQ(with(TreeFile::kBytes, std::uint64_t{32}), "tree-truncated");
  EXPECT_EQ(with(TreeFile::kChecksum, std::uint64_t{0}), "tree-corrupt");
}

// Files of version 4 have no clusters.
TEST(DamagedTree, OfAnEarlierVersionIsRefusedWithTheRemedy) {
  TreeFile file = small_file();
  file.put(TreeFile::kVersion, 4u);
  const auto error = test::error_of([&] { (void)test::tree_of_bytes(file.bytes); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kTreeVersion);
  const std::string what = error->what();
  EXPECT_NE(
      what.find(
          "it is of version 4, and this program reads version 5: build it again from the mesh"),
      std::string::npos)
      << what;
}

// Queries square lengths in float, so the lattice's numbers must be good together too.
TEST(DamagedTree, OfAGridThatNoMeshHasSaysWhy) {
  const auto with = [](double voxel_size) {
    TreeFile file = small_file();
    file.put(TreeFile::kVoxelSize, voxel_size);
    file.seal();
    const auto error = test::error_of([&] { (void)test::tree_of_bytes(file.bytes); });
    return error ? std::string(error->what()) : "none";
  };
  const auto says = [](const std::string& what, const std::string& part) {
    EXPECT_NE(what.find(part), std::string::npos) << what;
  };
  says(with(1e-30), "the grid is smaller than any mesh may be: build it again");
  says(with(1e20), "the grid is larger than any mesh may be: build it again");
  // Of three voxels an axis, which are too small for the triangles.
  says(with(1e-12 / 3), "a triangle leaves the grid: build it again");
  EXPECT_EQ(with(1e15 / 3), "none");
}

TEST(DamagedTree, CutAnywhereItIsAnError) {
  const std::string& whole = small_file().bytes;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    TreeFile file = small_file();
    file.bytes.resize(length);
    const std::string plain = error_of_bytes(file.bytes);
    ASSERT_EQ(plain, length < 8 ? "not-a-tree" : "tree-truncated") << length;
    if (length < TreeFile::kBody) continue;
    file.seal();  // even where its size and checksum are right
    ASSERT_EQ(error_of_bytes(file.bytes), "tree-truncated") << length;
  }
}

TEST(DamagedTree, WithAnyBitFlippedItIsAnError) {
  std::string bytes = small_file().bytes;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto flip = static_cast<char>(1 << bit % 8);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
    ASSERT_NE(error_of_bytes(bytes), "none") << bit;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
  }
}

// With the checksum made right after, some files are other good trees; none may do harm.
TEST(DamagedTree, WithAnyByteChangedAndSealedItIsATreeOrAnError) {
  for (std::size_t at = TreeFile::kBody; at < small_file().bytes.size(); ++at) {
    for (const int value : {0, 1, 0x7F, 0xFF}) {
      TreeFile file = small_file();
      file.put(at, static_cast<unsigned char>(value));
      file.seal();
      (void)error_of_bytes(file.bytes);
    }
  }
}

// The file of a tree without voxels, and where its triangles stand.
struct FileWithoutVoxels {
  FileWithoutVoxels() : bytes(test::file_of(build_tree(test::box({0, 0, 0}, {2, 1, 1})))) {}
  template <typename T>
  [[nodiscard]] std::string with(std::size_t at, T value) const {
    std::string damaged = bytes;
    std::memcpy(damaged.data() + at, &value, sizeof value);
    test::seal(damaged);
    return damaged;
  }
  static constexpr std::size_t kCounts = TreeFile::kName, kVertices = kCounts + 24,
                               kTriangles = kVertices + 8 * 24, kClusters = kTriangles + 12 * 12,
                               kEnd = kClusters + 80 + 2 * 832 + 704;
  std::string bytes;
};

TEST(DamagedTree, WithoutVoxelsCutOrChangedItIsAnError) {
  const FileWithoutVoxels file;
  ASSERT_EQ(file.bytes.size(), FileWithoutVoxels::kEnd);
  ASSERT_EQ(error_of_bytes(file.bytes), "none");
  for (std::size_t length = TreeFile::kBody; length < file.bytes.size(); ++length) {
    std::string cut = file.bytes.substr(0, length);
    ASSERT_EQ(error_of_bytes(cut), "tree-truncated") << length;
    test::seal(cut);
    ASSERT_EQ(error_of_bytes(cut), "tree-truncated") << length;
  }
  std::string bytes = file.bytes;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto flip = static_cast<char>(1 << bit % 8);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
    ASSERT_NE(error_of_bytes(bytes), "none") << bit;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
  }
  std::string longer = file.bytes + '\0';
  test::seal(longer);
  EXPECT_EQ(error_of_bytes(longer), "tree-corrupt");
}

TEST(DamagedTree, WithoutVoxelsEachFieldIsChecked) {
  const FileWithoutVoxels file;
  const auto expect_corrupt = [](const std::string& bytes, const char* field) {
    EXPECT_EQ(error_of_bytes(bytes), "tree-corrupt") << field;
  };
  expect_corrupt(file.with(TreeFile::kCorner, 1.0), "corner");
  expect_corrupt(file.with(TreeFile::kCorner, kNaN), "corner");
  expect_corrupt(file.with(TreeFile::kCorner, -0.0), "corner");
  EXPECT_NE(error_of_bytes(file.with(TreeFile::kVoxelSize, -0.0)), "none");
  EXPECT_NE(error_of_bytes(file.with(TreeFile::kCells, 1u)), "none");
  expect_corrupt(file.with(TreeFile::kDepth, 1u), "depth");
  expect_corrupt(file.with(TreeFile::kOrientation, 7u), "orientation");
  for (const std::uint32_t sections : {0u, 1u, 3u, 6u, 15u, 34u}) {
    expect_corrupt(file.with(TreeFile::kSections, sections), "sections");
  }
  expect_corrupt(file.with(FileWithoutVoxels::kVertices, kNaN), "vertex");
  expect_corrupt(file.with(FileWithoutVoxels::kVertices, 1e300), "extent");
  expect_corrupt(file.with(FileWithoutVoxels::kTriangles, 8u), "index");
  expect_corrupt(file.with(FileWithoutVoxels::kClusters, kNaN), "axes");
  expect_corrupt(file.with(FileWithoutVoxels::kEnd - 128, 12u), "triangle of a cluster");
  std::string flat = file.bytes;
  std::fill(flat.begin() + FileWithoutVoxels::kVertices,
            flat.begin() + FileWithoutVoxels::kTriangles, '\0');
  test::seal(flat);
  expect_corrupt(flat, "a mesh without an extent");
  for (std::size_t at = 0; at < 24; at += 8) {
    const std::string huge = file.with(FileWithoutVoxels::kCounts + at, std::uint64_t{1} << 40);
    EXPECT_EQ(error_of_bytes(huge), "tree-truncated") << at;
    const std::size_t largest = test::largest_allocation([&] { (void)error_of_bytes(huge); });
    EXPECT_LE(largest, file.bytes.size() + 4096) << at;
  }
  // List entries take the room of triangles.
  std::string entries = file.with(FileWithoutVoxels::kCounts + 8, std::uint64_t{11});
  const std::uint64_t three = 3;
  std::memcpy(entries.data() + FileWithoutVoxels::kCounts + 16, &three, sizeof three);
  test::seal(entries);
  expect_corrupt(entries, "list entries");
}

TEST(DamagedTree, TrailingBytesAreAnError) {
  TreeFile file = small_file();
  file.bytes += '\0';
  EXPECT_EQ(error_of_bytes(file.bytes), "tree-truncated");
  file.seal();
  EXPECT_EQ(error_of_bytes(file.bytes), "tree-corrupt");
}

TEST(DamagedTree, NoCountMakesItAllocateMoreThanTheFileIsLong) {
  for (const Damage& damage : damages()) {
    TreeFile file = small_file();
    damage.apply(file);
    file.seal();
    const std::size_t largest = test::largest_allocation([&] { (void)error_of_bytes(file.bytes); });
    EXPECT_LE(largest, file.bytes.size() + 4096) << damage.name;
  }
}

// Its size is looked at when it is opened, and what is in it believed only as far as it is read.
TEST(DamagedTree, CutWhileItIsReadIsAnError) {
  const test::TempDir folder;
  for (const std::size_t left : {TreeFile::kBody, TreeFile::kBody + 3}) {
    const auto path = folder.write("tree.ist", small_file().bytes);
    TreeReader reader(path);
    std::filesystem::resize_file(path, left);
    const auto error = test::error_of([&] { (void)reader.value<double>(); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ErrorCode::kTreeTruncated);
    EXPECT_EQ(error->what(),
              path.string() + ": it ends before its content does: copy or build it again");
  }
}

}  // namespace
}  // namespace ist
