#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <string>

#include "ist/base/error.h"
#include "ist/mesh/mesh.h"
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

using test::corners;
using test::narrowed;
using test::TempDir;

const TriangleMesh kSolid = test::box({-1, 0.1, 2}, {0.5, 1.25, 3});

TEST(WriteStl, ComesBackTheSame) {
  const TempDir folder;
  const std::filesystem::path file = folder.write("ball.stl", "an older file");
  const TriangleMesh ball = test::icosphere(2, 30);
  write_stl(ball, file);
  EXPECT_EQ(corners(read_mesh(file)), corners(narrowed(ball)));
  EXPECT_EQ(folder.entries(), 1u);
  const std::string bytes = test::file_content(file);
  EXPECT_EQ(bytes.size(), 84 + 50 * ball.triangles.size());
  EXPECT_FALSE(bytes.starts_with("solid"));
}

TEST(WriteStl, KeepsTheFrame) {
  const TempDir folder;
  const auto file = folder.path() / "mesh.stl";
  TriangleMesh mesh = test::icosphere(0, 1);
  for (const PatientFrame frame :
       {PatientFrame::kUnknown, PatientFrame::kRas, PatientFrame::kLps}) {
    mesh.frame = frame;
    write_stl(mesh, file);
    EXPECT_EQ(read_mesh(file).frame, frame);
  }
}

TEST(WriteStl, WritesUnitNormalsFromTheWinding) {
  const TempDir folder;
  const auto normal_of = [&](const TriangleMesh& mesh) {
    write_stl(mesh, folder.path() / "a.stl");
    std::array<float, 3> normal;
    std::memcpy(normal.data(), test::file_content(folder.path() / "a.stl").data() + 84, 12);
    return normal;
  };
  using Normal = std::array<float, 3>;
  for (const double s : {1e-30, 1.0, 1e30}) {
    EXPECT_EQ(normal_of(test::triangle({0, 0, 0}, {0, s, 0}, {0, 0, s})), (Normal{1, 0, 0}));
    EXPECT_EQ(normal_of(test::triangle({0, 0, 0}, {0, s, 0}, {0, s, 0})), (Normal{0, 0, 0}));
  }
}

std::string write_code(const TriangleMesh& mesh, const std::filesystem::path& file) {
  try {
    write_stl(mesh, file);
    return "fine";
  } catch (const Error& error) {
    return to_string(error.code());
  }
}

TEST(WriteStl, LeavesNothingBehindWhereItFails) {
  const TempDir folder;
  std::filesystem::create_directory(folder.path() / "taken");
  EXPECT_EQ(write_code(kSolid, folder.path() / "missing" / "a.stl"), "file-unwritable");
  EXPECT_EQ(write_code(kSolid, folder.path() / "taken"), "file-unwritable");
  TriangleMesh wide = kSolid;
  wide.vertices[0].x() = 1e39;
  EXPECT_EQ(write_code(wide, folder.path() / "a.stl"), "mesh-not-finite");
  EXPECT_EQ(folder.entries(), 1u);
}

// A limit on the size of files stands for a full disk: writing stops in the same place.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(WriteStl, KeepsTheOlderFileOnAFullDisk) {
  const TempDir folder;
  const std::filesystem::path file = folder.write("a.stl", "an older file");
  const TriangleMesh ball = test::icosphere(3, 1);
  for (const rlim_t size : {rlim_t{10}, rlim_t{84 + 50 * 1279}}) {
    std::string code;
    {
      const FileSizeLimit limit(size);
      code = write_code(ball, file);
    }
    EXPECT_EQ(code, "file-unwritable");
    EXPECT_EQ(test::file_content(file), "an older file");
    EXPECT_EQ(folder.entries(), 1u);
  }
}

}  // namespace
}  // namespace ist
