#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <numeric>
#include <regex>
#include <string>

#include "answers/formats/samples.h"
#include "answers/formats/vtp_writer.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::PolyData;

// The arrays of a file, by element and name, as "PointData/Signed"; checks that their places in the
// appended data follow each other without a gap.
class VtpFile {
 public:
  explicit VtpFile(const PolyData& data) {
    const TempDir dir;
    answers::write_vtp(data, dir.path() / "data.vtp");
    const std::string content = file_content(dir.path() / "data.vtp");
    const std::string begin = "  <AppendedData encoding=\"raw\">\n_";
    const std::size_t appended = content.find(begin);
    EXPECT_NE(appended, content.npos);
    xml = content.substr(0, appended);
    std::size_t at = appended + begin.size();
    const std::regex tag(
        "<(PointData|CellData|Points|Verts|Polys)[ >]|<DataArray type=\"(\\w+)\" "
        "Name=\"(\\w+)\" NumberOfComponents=\"(\\d+)\" format=\"appended\" "
        "offset=\"(\\d+)\"/>");
    std::string element;
    for (std::sregex_iterator it(xml.begin(), xml.end(), tag), end; it != end; ++it) {
      if ((*it)[1].matched) {
        element = (*it)[1];
        continue;
      }
      EXPECT_EQ(std::stoul((*it)[5]), at - appended - begin.size());
      std::uint64_t length = 0;
      std::memcpy(&length, content.data() + at, sizeof length);
      at += sizeof length;
      kinds[element + "/" + it->str(3)] = it->str(2) + " " + it->str(4);
      bytes[element + "/" + it->str(3)] = content.substr(at, length);
      at += length;
    }
    EXPECT_EQ(content.substr(at), "\n  </AppendedData>\n</VTKFile>\n");
  }

  template <typename T>
  [[nodiscard]] std::vector<T> numbers(const std::string& name) const {
    const std::string& raw = bytes.at(name);
    EXPECT_EQ(raw.size() % sizeof(T), 0u);
    std::vector<T> numbers(raw.size() / sizeof(T));
    if (!raw.empty()) std::memcpy(numbers.data(), raw.data(), raw.size());
    return numbers;
  }

  std::string xml;
  std::map<std::string, std::string> kinds, bytes;
};

std::vector<float> floats(const PolyData& data) {
  std::vector<float> all;
  for (const Eigen::Vector3d& point : data.points) {
    for (const double x : point) all.push_back(static_cast<float>(x));
  }
  return all;
}

template <typename T>
std::string bytes_as_they_lie(const std::vector<T>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), sizeof(T) * numbers.size()};
}

void expect_arrays(const VtpFile& file, const std::string& element,
                   const std::vector<answers::DataArray>& arrays) {
  for (const answers::DataArray& array : arrays) {
    const std::string name = element + "/" + array.name;
    const char* kinds[] = {"Float32 ", "Int32 ", "UInt8 "};
    EXPECT_EQ(file.kinds.at(name), kinds[array.numbers.index()] + std::to_string(array.components));
    std::visit(
        [&](const auto& numbers) { EXPECT_EQ(file.bytes.at(name), bytes_as_they_lie(numbers)); },
        array.numbers);
  }
}

TEST(Vtp, HoldsTwoBodiesWithAllTheirNumbers) {
  const PolyData data = answers::joined(sample_bodies());
  const VtpFile file(data);
  EXPECT_TRUE(
      file.xml.starts_with("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
                           "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"));
  EXPECT_NE(file.xml.find("<Piece NumberOfPoints=\"50\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
                          "NumberOfStrips=\"0\" NumberOfPolys=\"92\">"),
            std::string::npos)
      << file.xml;
  EXPECT_EQ(file.numbers<float>("Points/Points"), floats(data));
  expect_arrays(file, "PointData", data.point_arrays);
  expect_arrays(file, "CellData", data.cell_arrays);
  EXPECT_EQ(file.kinds.at("PointData/RGB"), "UInt8 3");
  EXPECT_EQ(file.bytes.at("PointData/RGB"), bytes_as_they_lie(data.colours));
  EXPECT_EQ(file.kinds.at("PointData/Normals"), "Float32 3");
  EXPECT_EQ(file.bytes.at("PointData/Normals"), bytes_as_they_lie(data.normals));
  EXPECT_NE(file.xml.find("<PointData Normals=\"Normals\">"), std::string::npos);
  const auto connectivity = file.numbers<std::int64_t>("Polys/connectivity");
  EXPECT_TRUE(std::equal(connectivity.begin(), connectivity.end(), data.polygons.begin(),
                         data.polygons.end()));
  const auto ends = file.numbers<std::int64_t>("Polys/offsets");
  ASSERT_EQ(ends.size(), 92u);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_EQ(ends[i], static_cast<std::int64_t>(3 * (i + 1)));
  }
  // Three arrays, colours and normals; two arrays; points; connectivity and offsets.
  EXPECT_EQ(file.kinds.size(), 10u);
}

TEST(Vtp, QuadsHaveFourCorners) {
  const VtpFile file(sample_quads());
  EXPECT_EQ(file.numbers<std::int64_t>("Polys/offsets"),
            (std::vector<std::int64_t>{4, 8, 12, 16, 20, 24}));
}

TEST(Vtp, PointsWithoutPolygonsAreVertexCells) {
  const PolyData data = sample_points();
  const VtpFile file(data);
  EXPECT_NE(file.xml.find("NumberOfVerts=\"5\""), std::string::npos);
  EXPECT_NE(file.xml.find("NumberOfPolys=\"0\""), std::string::npos);
  EXPECT_EQ(file.numbers<std::int64_t>("Verts/connectivity"),
            (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(file.numbers<std::int64_t>("Verts/offsets"),
            (std::vector<std::int64_t>{1, 2, 3, 4, 5}));
  expect_arrays(file, "PointData", data.point_arrays);
  expect_arrays(file, "CellData", data.cell_arrays);
}

// The mesh reader reads what the command writes.
TEST(Vtp, IsReadAsAMesh) {
  const TempDir dir;
  const auto file = dir.path() / "data.vtp";
  PolyData quads = sample_quads();
  quads.frame = PatientFrame::kRas;
  answers::write_vtp(quads, file);
  const TriangleMesh cube = read_mesh(file);
  EXPECT_EQ(cube.frame, PatientFrame::kRas);
  EXPECT_EQ(cube.vertices.size(), 8u);
  const MeshReport report = check_mesh(cube);
  EXPECT_TRUE(report.closed && report.consistent);
  EXPECT_NEAR(report.signed_volume, 0.7, 1e-7);
  const PolyData jaws = answers::joined(sample_bodies());
  answers::write_vtp(jaws, file);
  const std::vector<float> points = floats(jaws);
  std::vector<std::array<double, 9>> expected;
  for (std::size_t i = 0; i < jaws.polygons.size(); ++i) {
    if (i % 3 == 0) expected.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis)
      expected.back()[3 * (i % 3) + axis] = double{points[3 * jaws.polygons[i] + axis]} + 0.0;
  }
  EXPECT_EQ(corners(read_mesh(file)), expected);
  answers::write_vtp(sample_points(), file);
  EXPECT_EQ(error_name([&] { (void)read_mesh(file); }), "mesh-points-only");
}

TEST(Vtp, NothingIsAFileToo) {
  const VtpFile file({});
  EXPECT_EQ(file.bytes.at("Points/Points"), "");
  EXPECT_EQ(file.bytes.at("Verts/offsets"), "");
}

}  // namespace
}  // namespace ist::test
