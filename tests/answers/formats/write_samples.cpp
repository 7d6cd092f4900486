// Writes samples in every format into a folder, and beside them their numbers as they were before
// they were written, in expected.json: for read_back.py, which reads the files with other tools.

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answers/formats/csv_writer.h"
#include "answers/formats/glb_writer.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/samples.h"
#include "answers/formats/vtp_writer.h"

namespace {

using ist::answers::DataArray;
using ist::answers::NamedPolyData;
using ist::answers::PolyData;
using Json = nlohmann::ordered_json;

constexpr double kMetresPerUnit = 0.001;

Json numbers_of(const std::vector<DataArray>& arrays) {
  Json all = Json::object();
  for (const DataArray& array : arrays) {
    constexpr std::array kKinds{"float32", "int32", "uint8"};
    Json& entry = all[array.name] = {{"kind", kKinds[array.numbers.index()]},
                                     {"components", array.components}};
    // What is no number becomes null.
    std::visit([&entry](const auto& numbers) { entry["numbers"] = numbers; }, array.numbers);
  }
  return all;
}

Json content_of(const PolyData& data) {
  Json points = Json::array(), normals = Json::array(), colours = Json::array();
  for (const Eigen::Vector3d& p : data.points) points.push_back({p[0], p[1], p[2]});
  for (const Eigen::Vector3f& n : data.normals) normals.push_back({n[0], n[1], n[2]});
  for (const ist::answers::Colour& c : data.colours) colours.push_back(c);
  return {{"points", points},
          {"corners", data.corners},
          {"polygons", data.polygons},
          {"normals", normals},
          {"colours", colours},
          {"point_arrays", numbers_of(data.point_arrays)},
          {"cell_arrays", numbers_of(data.cell_arrays)}};
}

Json write_table(const std::filesystem::path& file) {
  const std::vector<std::string> columns{"name", "a,\"b\"", "number"};
  const std::vector<std::string> names{"", "two\nlines", "a \"quote\"", "\xC3\xA4,;", "\r"};
  const std::vector<double> numbers{0.1, 1.0 / 3, -5e-324, 1e300, std::nan("")};
  const std::vector<float> floats{0.1f, 1.0f / 3, 3e38f, -0.0f, 16777216};
  ist::answers::CsvWriter csv(file, columns);
  for (std::size_t i = 0; i < names.size(); ++i) csv.row(names[i], floats[i], numbers[i]);
  csv.commit();
  return {{"columns", columns}, {"names", names}, {"floats", floats}, {"numbers", numbers}};
}

void write_all(const std::filesystem::path& folder) {
  const std::vector<NamedPolyData> jaws = ist::test::sample_bodies();
  const std::vector<NamedPolyData> quads{{"cube", ist::test::sample_quads()}};
  const std::vector<NamedPolyData> points{{"points", ist::test::sample_points()}};
  Json expected;
  for (const auto& [name, bodies] :
       {std::pair("jaws", &jaws), std::pair("quads", &quads), std::pair("points", &points)}) {
    const PolyData data = ist::answers::joined(*bodies);
    write_vtp(data, folder / (std::string(name) + ".vtp"));
    write_ply(data, folder / (std::string(name) + ".ply"), "a sample");
    write_glb(*bodies, kMetresPerUnit, folder / (std::string(name) + ".glb"));
    expected["files"][name] = content_of(data);
    for (const NamedPolyData& body : *bodies) {
      expected["files"][name]["bodies"].push_back(
          {{"name", body.name}, {"points", body.data.points.size()}});
    }
  }
  expected["metres_per_unit"] = kMetresPerUnit;
  expected["table"] = write_table(folder / "table.csv");
  std::ofstream(folder / "expected.json") << expected;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_samples FOLDER\n");
    return 2;
  }
  write_all(argv[1]);
}
