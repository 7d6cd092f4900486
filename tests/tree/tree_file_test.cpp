#include "support/tree_file.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <span>

#include "ist/base/cancellation.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "support/errors.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

template <typename T>
void expect_same_bytes(std::span<const T> a, std::span<const T> b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

void expect_equal(const LinearOctree& a, const LinearOctree& b) {
  ASSERT_EQ(a.depth(), b.depth());
  EXPECT_EQ(a.leaf_count(), b.leaf_count());
  for (int level = 0; level <= a.depth(); ++level) {
    ASSERT_EQ(a.codes(level), b.codes(level));
    for (std::uint32_t node = 0; level > 0 && node < a.node_count(level); ++node) {
      ASSERT_EQ(a.mask(level, node), b.mask(level, node));
      ASSERT_EQ(a.first_child(level, node), b.first_child(level, node));
    }
  }
}

void expect_equal(const SphereTree& a, const SphereTree& b) {
  EXPECT_EQ(voxels_of(a).lattice, voxels_of(b).lattice);
  EXPECT_EQ(a.orientation(), b.orientation());
  EXPECT_EQ(a.bounding_radius(), b.bounding_radius());
  EXPECT_EQ(a.source(), b.source());
  expect_equal(voxels_of(a).octree, voxels_of(b).octree);
  expect_same_bytes(std::span(voxels_of(a).normals), std::span(voxels_of(b).normals));
  ASSERT_EQ(a.tightest(), b.tightest());
  for (int level = 0; level <= a.depth(); ++level) {
    if (a.has(SpherePolicy::kTight))
      expect_same_bytes(voxels_of(a).balls(level), voxels_of(b).balls(level));
    if (a.has(SpherePolicy::kSlab))
      expect_same_bytes(voxels_of(a).slabs(level), voxels_of(b).slabs(level));
  }
  EXPECT_EQ(a.largest_leaf_radius(a.tightest()), b.largest_leaf_radius(b.tightest()));
  ASSERT_EQ(a.triangles() != nullptr, b.triangles() != nullptr);
  if (a.triangles()) {
    EXPECT_EQ(parts_of(a).triangles->mesh.vertices, parts_of(b).triangles->mesh.vertices);
    EXPECT_EQ(parts_of(a).triangles->mesh.triangles, parts_of(b).triangles->mesh.triangles);
    EXPECT_EQ(voxels_of(a).lists.first, voxels_of(b).lists.first);
    EXPECT_EQ(voxels_of(a).lists.ids, voxels_of(b).lists.ids);
  }
  ASSERT_EQ(a.has_proximity(), b.has_proximity());
  if (voxels_of(a).proximity)
    expect_equal(voxels_of(a).proximity->octree, voxels_of(b).proximity->octree);
}

SphereTree tree_of(const TriangleMesh& mesh, double voxel_size, unsigned sections) {
  BuildOptions options;
  options.voxel_size = voxel_size;
  options.spheres = (sections & 8) != 0   ? SpherePolicy::kSlab
                    : (sections & 1) != 0 ? SpherePolicy::kTight
                                          : SpherePolicy::kTable;
  options.keep_triangles = (sections & 2) != 0;
  options.proximity = (sections & 4) != 0;
  return build_tree(mesh, options);
}

TEST(TreeFile, EveryCombinationOfSectionsComesBackAsItWas) {
  for (const auto& [mesh, voxel_size] :
       {std::pair(test::icosphere(2, 1), 0.2), std::pair(test::open_strip(3), 0.4),
        std::pair(test::icosphere(1, 1), 10.0)}) {
    for (unsigned sections = 0; sections < 16; ++sections) {
      const SphereTree tree = tree_of(mesh, voxel_size, sections);
      const std::string bytes = test::file_of(tree);
      const SphereTree back = test::tree_of_bytes(bytes);
      expect_equal(tree, back);
      EXPECT_EQ(test::file_of(back), bytes);
    }
  }
}

TEST(TreeFile, WithoutVoxelsComesBackAsItWas) {
  TriangleMesh strip = test::open_strip(3);
  strip.frame = PatientFrame::kLps;
  for (const TriangleMesh& mesh : {test::icosphere(2, 1), strip}) {
    BuildOptions options;
    options.source = {"upper jaw.stl", 7, LengthUnit::kMillimetre};
    const SphereTree tree = build_tree(mesh, options);
    const std::string bytes = test::file_of(tree);
    const SphereTree back = test::tree_of_bytes(bytes);
    EXPECT_FALSE(back.has_voxels());
    EXPECT_EQ(back.origin(), tree.origin());
    EXPECT_EQ(back.bounding_radius(), tree.bounding_radius());
    EXPECT_EQ(back.orientation(), tree.orientation());
    EXPECT_EQ(back.source(), tree.source());
    EXPECT_EQ(back.frame(), mesh.frame);
    EXPECT_EQ(back.triangles()->frame, mesh.frame);
    EXPECT_EQ(back.triangles()->vertices, tree.triangles()->vertices);
    EXPECT_EQ(back.triangles()->triangles, tree.triangles()->triangles);
    EXPECT_EQ(test::file_of(back), bytes);
  }
}

TEST(TreeFile, EverySourceComesBackAsItWas) {
  BuildOptions options;
  options.voxel_size = 0.3;
  for (const MeshSource& source :
       {MeshSource{"upper jaw.stl", 0xFEDCBA9876543210, LengthUnit::kMillimetre},
        MeshSource{"Zähne–верх.ply", 1, LengthUnit::kMicrometre},
        MeshSource{std::string(255, 'x'), 0, LengthUnit::kInch}, MeshSource{"", 7},
        MeshSource{"..", 0, LengthUnit::kMetre}}) {
    options.source = source;
    const SphereTree tree = build_tree(test::icosphere(1, 1), options);
    EXPECT_EQ(tree.source(), source);
    const std::string bytes = test::file_of(tree);
    const SphereTree back = test::tree_of_bytes(bytes);
    EXPECT_EQ(back.source(), source);
    EXPECT_EQ(test::file_of(back), bytes);
  }
}

TEST(TreeFile, EveryFrameComesBackAsItWas) {
  BuildOptions options;
  options.voxel_size = 0.3;
  TriangleMesh mesh = test::icosphere(1, 1);
  for (const PatientFrame frame :
       {PatientFrame::kUnknown, PatientFrame::kRas, PatientFrame::kLps}) {
    mesh.frame = frame;
    options.source.unit = frame == PatientFrame::kRas ? LengthUnit::kInch : LengthUnit::kUnknown;
    const SphereTree tree = build_tree(mesh, options);
    EXPECT_EQ(tree.frame(), frame);
    const std::string bytes = test::file_of(tree);
    const SphereTree back = test::tree_of_bytes(bytes);
    EXPECT_EQ(back.frame(), frame);
    EXPECT_EQ(back.triangles()->frame, frame);
    EXPECT_EQ(back.source(), options.source);
    EXPECT_EQ(test::file_of(back), bytes);
  }
}

// The tree of a turned mesh is the tree of that mesh, bit by bit.
TEST(TreeFrames, AMeshOfTheOtherFrameIsTurned) {
  BuildOptions options;
  options.voxel_size = 0.3;
  TriangleMesh mesh = test::box({-1, 0.1, 2}, {0.5, 1.25, 3});
  mesh.frame = PatientFrame::kRas;
  TriangleMesh turned = test::box({-0.5, -1.25, 2}, {1, -0.1, 3});
  options.frame = PatientFrame::kLps;
  const SphereTree tree = build_tree(mesh, options);
  EXPECT_EQ(tree.frame(), PatientFrame::kLps);
  const auto box = [](const TriangleMesh& of) {
    Eigen::AlignedBox3d found;
    for (const Eigen::Vector3d& vertex : of.vertices) found.extend(vertex);
    return found;
  };
  EXPECT_EQ(box(*tree.triangles()).min(), box(turned).min());
  EXPECT_EQ(box(*tree.triangles()).max(), box(turned).max());
  EXPECT_EQ(tree.orientation(), Orientation::kOutward);
  options.frame = PatientFrame::kRas;
  EXPECT_EQ(build_tree(mesh, options).triangles()->vertices, mesh.vertices);
  mesh.frame = PatientFrame::kUnknown;
  const SphereTree unknown = build_tree(mesh, options);
  EXPECT_EQ(unknown.frame(), PatientFrame::kUnknown);
  EXPECT_EQ(unknown.triangles()->vertices, mesh.vertices);
  options.frame = static_cast<PatientFrame>(3);
  EXPECT_EQ(test::error_name([&] { static_cast<void>(build_tree(mesh, options)); }),
            "argument-invalid");
}

TEST(TreeFile, IsWrittenWholeAndItsSizeReported) {
  const test::TempDir folder;
  const auto file = folder.path() / "tree.ist";
  const std::uint64_t written = write_tree(tree_of(test::icosphere(1, 1), 0.3, 15), file);
  EXPECT_EQ(written, std::filesystem::file_size(file));
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(test::error_name([&] {
              (void)write_tree(tree_of(test::icosphere(1, 1), 0.3, 0), folder.path() / "no" / "t");
            }),
            "file-unwritable");
}

TEST(TreeFile, IsNeitherReadNorWrittenWhereItsThreadIsAskedToEnd) {
  const test::TempDir folder;
  const SphereTree tree = build_tree(test::icosphere(2, 1), {.voxel_size = 0.2});
  const auto file = folder.write("tree.ist", "older");
  const std::vector<std::byte> bytes = tree_to_bytes(tree);
  const std::atomic<bool> asked{true};
  const ScopedCancellation cancellation(asked);
  EXPECT_EQ(test::error_name([&] { write_tree(tree, file); }), "cancelled");
  EXPECT_EQ(test::file_content(file), "older");
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(test::error_name([&] { static_cast<void>(tree_from_bytes(bytes)); }), "cancelled");
  EXPECT_EQ(test::error_name([&] { static_cast<void>(read_tree(file)); }), "cancelled");
}

TEST(TreeFile, BeginsAsItsDescriptionSays) {
  const std::string bytes = test::file_of(tree_of(test::icosphere(1, 1), 0.3, 15));
  EXPECT_EQ(bytes.substr(0, 16), std::string("\x89IST\r\n\x1A\n\5\0\0\0\4\3\2\1", 16));
}

TEST(TreeFile, IsKnownByItsBeginning) {
  const test::TempDir folder;
  const std::string bytes = test::file_of(tree_of(test::icosphere(1, 1), 0.3, 0));
  EXPECT_TRUE(is_tree_file(folder.write("a", bytes)));
  EXPECT_TRUE(is_tree_file(folder.write("b", bytes.substr(0, 8))));
  EXPECT_FALSE(is_tree_file(folder.write("c", bytes.substr(0, 7))));
  EXPECT_FALSE(is_tree_file(folder.write("d", "solid")));
  EXPECT_FALSE(is_tree_file(folder.write("e", "")));
  EXPECT_EQ(test::error_name([&] { (void)is_tree_file(folder.path() / "missing"); }),
            "file-unreadable");
}

TEST(TreeFile, ErrorsNameTheFile) {
  const test::TempDir folder;
  const auto file = folder.write("broken.ist", "no tree at all, but long enough to be one");
  const auto error = test::error_of([&] { (void)read_tree(file); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kNotATree);
  EXPECT_NE(std::string(error->what()).find("broken.ist"), std::string::npos);
  EXPECT_EQ(test::error_name([&] { (void)read_tree(folder.path() / "missing"); }),
            "file-unreadable");
}

}  // namespace
}  // namespace ist
