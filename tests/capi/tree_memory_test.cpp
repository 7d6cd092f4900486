// Trees in memory, meshes of trees, jaws from nothing, and builds, checks and files that their
// caller follows.

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "c_bodies.h"
#include "ist/capi/ist_models.h"
#include "ist/mesh/mesh.h"
#include "ist/models/models.h"
#include "listener.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

std::vector<unsigned char> bytes_of(const ist_tree* tree) {
  std::uint64_t size = 0;
  EXPECT_EQ(name(ist_tree_to_memory(tree, nullptr, 0, nullptr, &size)), "ok");
  std::vector<unsigned char> bytes(size);
  EXPECT_EQ(name(ist_tree_to_memory(tree, bytes.data(), bytes.size(), nullptr, &size)), "ok");
  EXPECT_EQ(size, bytes.size());
  return bytes;
}

TEST(CTreeInMemory, HasTheBytesOfItsFile) {
  ist_tree* tree = c_tree(icosphere(3, 2), 0.2);
  const TempDir folder;
  const std::string file = (folder.path() / "a.ist").string();
  ASSERT_EQ(name(ist_tree_save(tree, file.c_str(), nullptr)), "ok");
  const std::vector<unsigned char> bytes = bytes_of(tree);
  std::ifstream stream(file, std::ios::binary);
  const std::string saved(std::istreambuf_iterator<char>(stream), {});
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), saved);

  ist_tree* back = nullptr;
  ASSERT_EQ(name(ist_tree_from_memory(bytes.data(), bytes.size(), nullptr, &back)), "ok");
  EXPECT_EQ(bytes_of(back), bytes);
  EXPECT_EQ(name(ist_tree_free(back)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST(CTreeInMemory, LeavesAMemoryThatIsTooSmallAsItIs) {
  ist_tree* tree = c_tree(icosphere(1, 2), 0.5);
  std::vector<unsigned char> memory(bytes_of(tree).size() - 1, 7);
  std::uint64_t size = 0;
  EXPECT_EQ(name(ist_tree_to_memory(tree, memory.data(), memory.size(), nullptr, &size)), "ok");
  EXPECT_EQ(size, memory.size() + 1);
  EXPECT_EQ(memory, std::vector<unsigned char>(memory.size(), 7));
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST(CTreeInMemory, IsRefusedWhereItIsDamaged) {
  ist_tree* tree = c_tree(icosphere(1, 2), 0.5);
  const std::vector<unsigned char> bytes = bytes_of(tree);
  ist_tree* back = nullptr;
  const auto read = [&](const std::vector<unsigned char>& given) {
    const std::string status =
        name(ist_tree_from_memory(given.data(), given.size(), nullptr, &back));
    EXPECT_EQ(back, nullptr);
    return status;
  };
  EXPECT_EQ(read({}), "not-a-tree");
  EXPECT_EQ(read({1, 2, 3}), "not-a-tree");
  for (const std::size_t length : {std::size_t{8}, std::size_t{31}, bytes.size() - 1}) {
    EXPECT_EQ(read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}),
              "tree-truncated")
        << length;
  }
  auto longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(read(longer), "tree-truncated");
  auto other = bytes;
  ++other[8];
  EXPECT_EQ(read(other), "tree-version");
  for (std::size_t at = 32; at < bytes.size(); at += 97) {
    auto damaged = bytes;
    damaged[at] ^= 1;
    const std::string status = read(damaged);  // a count that changed asks for more than there is
    EXPECT_TRUE(status == "tree-corrupt" || status == "tree-truncated") << at << ": " << status;
  }
  EXPECT_NE(std::string(ist_last_error_message()).find("the bytes of a tree"), std::string::npos);
  EXPECT_EQ(name(ist_tree_from_memory(nullptr, 5, nullptr, &back)), "null-argument");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST(CTreeMesh, IsTheMeshThatWasGiven) {
  const TriangleMesh given = icosphere(2, 3);
  ist_tree* tree = c_tree(given, 0.5);
  ist_mesh* mesh = nullptr;
  ASSERT_EQ(name(ist_tree_get_mesh(tree, &mesh)), "ok");
  TriangleMesh back;
  back.vertices.resize(given.vertices.size());
  back.triangles.resize(given.triangles.size());
  ASSERT_EQ(name(ist_mesh_copy(mesh, back.vertices.front().data(), back.vertices.size(),
                               back.triangles.front().data(), back.triangles.size())),
            "ok");
  EXPECT_EQ(back.vertices, given.vertices);
  EXPECT_EQ(back.triangles, given.triangles);
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  tree = c_tree(given, 0.5, false);
  EXPECT_EQ(name(ist_tree_get_mesh(tree, &mesh)), "triangles-missing");
  EXPECT_EQ(mesh, nullptr);
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST(CJaw, IsThatOfCpp) {
  for (const auto& [jaw, of_cpp] :
       {std::pair{IST_JAW_LOWER, Jaw::kLower}, std::pair{IST_JAW_UPPER, Jaw::kUpper}}) {
    const TriangleMesh wanted = make_jaw(of_cpp, 3);
    ist_mesh* mesh = nullptr;
    ASSERT_EQ(name(ist_jaw_create(jaw, 3, &mesh)), "ok");
    std::vector<double> vertices(3 * wanted.vertices.size());
    ASSERT_EQ(name(ist_mesh_copy(mesh, vertices.data(), wanted.vertices.size(), nullptr, 0)), "ok");
    EXPECT_TRUE(std::equal(vertices.begin(), vertices.end(), wanted.vertices.front().data()));
    EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
  }
  ist_mesh* mesh = nullptr;
  EXPECT_EQ(name(ist_jaw_create(2, 1, &mesh)), "argument-invalid");
  EXPECT_EQ(mesh, nullptr);
}

TEST(CBuild, IsFollowedOnTheCallersThreadAndEndsWhereItSaysSo) {
  const FrequentReports frequent;
  ist_mesh* mesh = nullptr;
  ASSERT_EQ(name(ist_jaw_create(IST_JAW_UPPER, 1, &mesh)), "ok");
  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  auto options = sized<ist_build_options>();
  options.voxel_size = 0.3;
  options.progress = &progress;
  ist_tree* tree = nullptr;
  ASSERT_EQ(name(ist_tree_build(mesh, &options, &tree)), "ok");
  EXPECT_GE(listener.reports, 3);
  EXPECT_GT(listener.last, 0.2);
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
  for (const int at : {1, 2, 5}) {
    listener.reports = 0;
    listener.stop_at = at;
    EXPECT_EQ(name(ist_tree_build(mesh, &options, &tree)), "cancelled");
    EXPECT_EQ(tree, nullptr);
    EXPECT_EQ(listener.reports, at);
  }
  EXPECT_NE(std::string(ist_last_error_message()).find("ended as it asked"), std::string::npos);
  // An error of the work reaches a caller who follows it.
  listener.stop_at = 0;
  options.voxel_size = 1e-9;
  EXPECT_EQ(name(ist_tree_build(mesh, &options, &tree)), "voxel-size-too-small");
  EXPECT_NE(std::string(ist_last_error_message()).find("voxel"), std::string::npos);
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

// A sphere of 327,680 triangles: its files take longer than the time between two reports.
TEST(CFiles, AreFollowedAndEndWhereTheCallerSaysSo) {
  IST_SLOW();
  const FrequentReports frequent;
  const TempDir folder;
  const std::string stl = (folder.path() / "a.stl").string(),
                    ist = (folder.path() / "a.ist").string();
  write_stl(icosphere(7, 10), stl);
  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  ist_mesh* mesh = nullptr;
  ASSERT_EQ(name(ist_mesh_read(stl.c_str(), &progress, &mesh)), "ok");
  EXPECT_GE(listener.reports, 2);
  auto options = sized<ist_build_options>();
  options.voxel_size = 0.1;
  ist_tree *tree = nullptr, *back = nullptr;
  ASSERT_EQ(name(ist_tree_build(mesh, &options, &tree)), "ok");
  ASSERT_EQ(name(ist_tree_save(tree, ist.c_str(), &progress)), "ok");
  ASSERT_EQ(name(ist_tree_load(ist.c_str(), &progress, &back)), "ok");
  EXPECT_EQ(bytes_of(back), bytes_of(tree));
  EXPECT_EQ(name(ist_tree_free(back)), "ok");
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
  const std::string saved = file_content(ist);
  for (const int at : {1, 2}) {
    listener = {.stop_at = at};
    EXPECT_EQ(name(ist_mesh_read(stl.c_str(), &progress, &mesh)), "cancelled");
    EXPECT_EQ(mesh, nullptr);
    EXPECT_EQ(listener.reports, at);
  }
  listener = {.stop_at = 1};
  EXPECT_EQ(name(ist_tree_load(ist.c_str(), &progress, &back)), "cancelled");
  EXPECT_EQ(back, nullptr);
  listener = {.stop_at = 1};
  EXPECT_EQ(name(ist_tree_save(tree, ist.c_str(), &progress)), "cancelled");
  EXPECT_EQ(file_content(ist), saved);
  EXPECT_EQ(folder.entries(), 2u);
  EXPECT_NE(std::string(ist_last_error_message()).find("ist_tree_save"), std::string::npos);
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST(CTreeInMemory, IsFollowedAndEndsWhereTheCallerSaysSo) {
  IST_SLOW();
  const FrequentReports frequent;
  ist_tree *tree = c_tree(icosphere(6, 10), 0.1), *back = nullptr;
  const std::vector<unsigned char> bytes = bytes_of(tree);
  std::vector<unsigned char> memory(bytes.size(), 7);
  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  std::uint64_t size = 0;
  const auto write = [&] {
    return name(ist_tree_to_memory(tree, memory.data(), memory.size(), &progress, &size));
  };
  const auto read = [&] {
    return name(ist_tree_from_memory(bytes.data(), bytes.size(), &progress, &back));
  };
  EXPECT_EQ(write(), "ok");
  EXPECT_EQ(size, bytes.size());
  EXPECT_EQ(memory, bytes);
  EXPECT_GE(listener.reports, 1);
  listener = {};
  EXPECT_EQ(read(), "ok");
  EXPECT_GE(listener.reports, 2);
  EXPECT_EQ(bytes_of(back), bytes);
  EXPECT_EQ(name(ist_tree_free(back)), "ok");

  memory.assign(bytes.size(), 7);
  listener = {.stop_at = 1};
  EXPECT_EQ(write(), "cancelled");
  EXPECT_EQ(size, 0u);
  EXPECT_EQ(memory, std::vector<unsigned char>(bytes.size(), 7));
  for (const int at : {1, 2}) {
    listener = {.stop_at = at};
    EXPECT_EQ(read(), "cancelled");
    EXPECT_EQ(back, nullptr);
    EXPECT_EQ(listener.reports, at);
  }
  EXPECT_NE(std::string(ist_last_error_message()).find("ist_tree_from_memory"), std::string::npos);
  // An error of the work reaches a caller who follows it.
  listener = {};
  EXPECT_EQ(name(ist_tree_from_memory(bytes.data(), 40, &progress, &back)), "tree-truncated");
  EXPECT_EQ(name(ist_tree_free(tree)), "ok");
}

TEST(CMeshCheck, IsFollowedAndEndsWhereTheCallerSaysSo) {
  const FrequentReports frequent;
  ist_mesh* mesh = c_mesh(icosphere(7, 10));
  auto wanted = sized<ist_mesh_info>(), info = wanted;
  ASSERT_EQ(name(ist_mesh_get_info(mesh, nullptr, &wanted)), "ok");
  Listener listener;
  const auto progress = sized<ist_progress>({0, Listener::hear, &listener});
  ASSERT_EQ(name(ist_mesh_get_info(mesh, &progress, &info)), "ok");
  EXPECT_EQ(std::memcmp(&info, &wanted, sizeof info), 0);
  EXPECT_GE(listener.reports, 2);
  for (const int at : {1, 2}) {
    listener = {.stop_at = at};
    EXPECT_EQ(name(ist_mesh_get_info(mesh, &progress, &info)), "cancelled");
    EXPECT_EQ(info.triangles, 0u);
    EXPECT_EQ(listener.reports, at);
  }
  EXPECT_EQ(name(ist_mesh_free(mesh)), "ok");
}

}  // namespace
}  // namespace ist::test
