// The memory that reading a mesh takes at its peak, by the bytes that `new` gives out.

#include <gtest/gtest.h>

#include <filesystem>

#include "ist/mesh/mesh.h"
#include "support/data_dir.h"
#include "support/effort.h"
#include "support/largest_allocation.h"
#include "support/mesh_files.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

// The peak as a multiple of the file's size.
double peak_share(const std::filesystem::path& file) {
  TriangleMesh mesh;
  const std::size_t peak = test::peak_allocation([&] { mesh = read_mesh(file); });
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  EXPECT_GT(static_cast<double>(peak), size);  // the content, at least
  return static_cast<double>(peak) / size;
}

// Triangles without a vertex in common.
TriangleMesh soup(std::size_t triangles) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto a = static_cast<std::uint32_t>(mesh.vertices.size());
    const auto x = static_cast<double>(i);
    for (const double y : {0.0, 1.0, 2.0}) mesh.vertices.emplace_back(x, y, y * y);
    mesh.triangles.push_back({a, a + 1, a + 2});
  }
  return mesh;
}

TEST(MeshMemory, IsThreeTimesTheFileForAJaw) {
  const auto file = test::data_dir() / "human_mandible.stl";
  if (!std::filesystem::is_regular_file(file)) IST_SKIP("no " << file);
  EXPECT_LE(peak_share(file), 3);
}

// Sizes round the powers of two, where tables and vectors have just grown.
TEST(MeshMemory, IsFiveTimesTheFileForASoup) {
  const test::TempDir folder;
  for (const int triangles : {21'845, 21'850, 30'000, 32'768, 32'780, 43'700, 60'000, 65'540})
    EXPECT_LE(peak_share(folder.write(
                  "soup.stl", test::as_binary_stl(soup(static_cast<std::size_t>(triangles))))),
              5)
        << triangles;
}

}  // namespace
}  // namespace ist
