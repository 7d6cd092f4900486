#include "answers/formats/vtp_writer.h"

#include <fmt/format.h>

#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "answers/formats/little_endian.h"
#include "ist/base/assert.h"
#include "ist/mesh/format/frame_tags.h"

namespace ist::answers {
namespace {

// The XML of a file, and the arrays whose places in the appended data it tells.
class Document {
 public:
  void add(std::string_view line) { xml_ += line; }

  // The bytes must live until write().
  void add_array(const char* kind, std::string_view name, std::size_t components,
                 std::span<const std::byte> bytes) {
    xml_ += fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        kind, name, components, offset_);
    arrays_.push_back(bytes);
    offset_ += sizeof(std::uint64_t) + bytes.size();
  }
  void add_arrays(const std::vector<DataArray>& arrays) {
    for (const DataArray& array : arrays) {
      add_array(kind_of(array.numbers, "Float32", "Int32", "UInt8"), array.name, array.components,
                bytes_of(array.numbers));
    }
  }

  void write(OutputFile& output) const {
    const auto write_text = [&output](std::string_view text) {
      output.write(text.data(), text.size());
    };
    write_text(xml_);
    write_text("  <AppendedData encoding=\"raw\">\n_");
    for (const std::span<const std::byte> bytes : arrays_) {
      const std::uint64_t length = bytes.size();
      output.write(&length, sizeof length);
      output.write(bytes.data(), bytes.size());
    }
    write_text("\n  </AppendedData>\n</VTKFile>\n");
  }

 private:
  std::string xml_;
  std::vector<std::span<const std::byte>> arrays_;
  std::size_t offset_ = 0;
};

// VTK's strings are the numbers of their bytes, and end in 0.
std::string field_data(const PolyData& data) {
  std::vector<NamedText> texts = data.texts;
  if (data.frame != PatientFrame::kUnknown) {
    texts.push_back({"SPACE", std::string(slicer_name(data.frame))});
  }
  if (texts.empty()) return {};
  std::string xml = "    <FieldData>\n";
  for (const auto& [name, text] : texts) {
    xml += fmt::format(
        "      <DataArray type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">",
        name);
    for (const char byte : text) xml += fmt::format("{} ", static_cast<unsigned char>(byte));
    xml += "0</DataArray>\n";
  }
  return xml + "    </FieldData>\n";
}

}  // namespace

void write_vtp(const PolyData& data, const std::filesystem::path& file) {
  OutputFile output(file);
  write_vtp(data, output);
  output.commit();
}

void write_vtp(const PolyData& data, OutputFile& file) {
  IST_ASSERT(is_consistent(data));
  const std::vector<float> points = float_points(data, file.target());
  const bool vertices = data.polygons.empty();
  const std::size_t cells = data.cell_count(), corners = vertices ? 1 : data.corners;
  std::vector<std::int64_t> connectivity(data.polygons.begin(), data.polygons.end());
  if (vertices) {
    connectivity.resize(cells);
    std::iota(connectivity.begin(), connectivity.end(), 0);
  }
  std::vector<std::int64_t> ends;  // of cells, in the connectivity
  for (std::size_t i = 1; i <= cells; ++i) ends.push_back(static_cast<std::int64_t>(i * corners));

  Document document;
  document.add(fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "  <PolyData>\n{}    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
      field_data(data), data.points.size(), vertices ? cells : 0, vertices ? 0 : cells));
  document.add(data.normals.empty() ? "      <PointData>\n"
                                    : "      <PointData Normals=\"Normals\">\n");
  document.add_arrays(data.point_arrays);
  if (!data.colours.empty()) {
    document.add_array("UInt8", "RGB", 3, std::as_bytes(std::span(data.colours)));
  }
  if (!data.normals.empty()) {
    document.add_array("Float32", "Normals", 3, std::as_bytes(std::span(data.normals)));
  }
  document.add("      </PointData>\n      <CellData>\n");
  document.add_arrays(data.cell_arrays);
  document.add("      </CellData>\n      <Points>\n");
  document.add_array("Float32", "Points", 3, std::as_bytes(std::span(points)));
  const char* kind = vertices ? "Verts" : "Polys";
  document.add(fmt::format("      </Points>\n      <{}>\n", kind));
  document.add_array("Int64", "connectivity", 1, std::as_bytes(std::span(connectivity)));
  document.add_array("Int64", "offsets", 1, std::as_bytes(std::span(ends)));
  document.add(fmt::format("      </{}>\n    </Piece>\n  </PolyData>\n", kind));
  document.write(file);
}

}  // namespace ist::answers
