#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "ist/base/printable.h"
#include "ist/mesh/format/base64.h"
#include "ist/mesh/format/inflate.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/format/vtk_surface.h"
#include "ist/mesh/format/xml_reader.h"

namespace ist {
namespace {

// Types of the XML form. Characters of strings are numbers.
constexpr NumberType kVtpTypes[] = {
    number_type<std::int8_t>("Int8"),   number_type<std::uint8_t>("UInt8"),
    number_type<std::int16_t>("Int16"), number_type<std::uint16_t>("UInt16"),
    number_type<std::int32_t>("Int32"), number_type<std::uint32_t>("UInt32"),
    number_type<std::int64_t>("Int64"), number_type<std::uint64_t>("UInt64"),
    number_type<float>("Float32"),      number_type<double>("Float64"),
    number_type<std::int8_t>("String")};
constexpr NumberType kLength32 = number_type<std::uint32_t>("UInt32"),
                     kLength64 = number_type<std::uint64_t>("UInt64");

// An array as its tag describes it.
struct VtpArray {
  std::string_view section, name, type, format, text;
  std::uint64_t components = 1, offset = 0;
};

struct VtpPiece {
  std::uint64_t points = 0, vertices = 0, lines = 0, polygons = 0, strips = 0;
  std::vector<VtpArray> arrays;
};

// Reads the tags first, then the arrays that they describe.
class VtpReader {
 public:
  VtpReader(std::string_view content, std::string_view name, VtkLabels* labels)
      : file_{content, name}, xml_(content, name, ""), tags_(name), labels_(labels) {}

  TriangleMesh read() {
    read_tags();
    for (const VtpArray& array : field_) {
      if (array.name != "SPACE" || array.type != "String") continue;
      std::string text = "SPACE=";
      for (const double c : numbers(array).numbers)
        text += c > ' ' && c < 0x7F ? static_cast<char>(c) : ' ';
      tags_.read(text);
    }
    VtkSurface surface(file_, labels_);
    for (const VtpPiece& piece : pieces_) {
      surface.add(read_piece(piece));
      if (labels_ != nullptr) read_labels(piece);
    }
    return surface.finish(tags_.frame());
  }

 private:
  void read_tags() {
    std::string_view section;
    for (auto tag = xml_.next(); tag != XmlReader::Tag::kEnd; tag = xml_.next()) {
      const std::string_view name = xml_.name();
      if (tag == XmlReader::Tag::kClose) {
        if (name == section) section = {};
      } else if (name == "VTKFile") {
        read_root();
      } else if (name == "Piece") {
        pieces_.push_back({whole("NumberOfPoints"),
                           whole("NumberOfVerts"),
                           whole("NumberOfLines"),
                           whole("NumberOfPolys"),
                           whole("NumberOfStrips"),
                           {}});
      } else if (name == "DataArray" || name == "Array") {
        if (section == "FieldData") field_.push_back(array_of_tag(section));
        if (section != "FieldData" && !pieces_.empty())
          pieces_.back().arrays.push_back(array_of_tag(section));
      } else if (name == "AppendedData") {
        read_appended();
        return;
      } else if (section.empty() && name != "PolyData") {
        section = name;
      }
    }
  }

  void read_root() {
    const std::string_view type = attribute("type");
    if (type != "PolyData") fail_vtk_dataset(type, file_.name);
    is_big_endian_ = attribute("byte_order") == "BigEndian";
    if (attribute("header_type") == "UInt64") length_ = &kLength64;
    compressor_ = attribute("compressor");
  }

  VtpArray array_of_tag(std::string_view section) const {
    VtpArray array{section, attribute("Name"), attribute("type"), attribute("format"),
                   xml_.content()};
    array.components = xml_.attribute("NumberOfComponents") ? whole("NumberOfComponents") : 1;
    array.offset = whole("offset");
    return array;
  }

  // Raw data can hold any bytes, so that no tag is read behind them.
  void read_appended() {
    std::string_view end = file_.content;
    end = end.substr(0, end.find_last_not_of(std::string_view(" \t\r\n\0", 5)) + 1);
    const std::string_view rest = xml_.rest();
    const std::size_t begin = rest.find('_');
    if (!end.ends_with("</VTKFile>") || begin == rest.npos)
      xml_.fail(ErrorCode::kMeshTruncated,
                "the file ends within its appended data; copy or export it again");
    is_raw_ = attribute("encoding") == "raw";
    appended_ = rest.substr(begin + 1);
    if (!is_raw_) appended_ = appended_.substr(0, appended_.find('<'));
  }

  std::string_view attribute(std::string_view name) const {
    return xml_.attribute(name).value_or("");
  }
  // A missing number is 0.
  std::uint64_t whole(std::string_view name) const {
    const std::string_view text = attribute(name);
    const std::optional<std::int64_t> value = TextReader::whole(text);
    if (!text.empty() && !(value && *value >= 0))
      xml_.fail(ErrorCode::kNotAMesh,
                fmt::format("{}=\"{}\" is no count; export the mesh again", name, printable(text)));
    return static_cast<std::uint64_t>(value.value_or(0));
  }

  VtkPiece read_piece(const VtpPiece& piece) {
    VtkPiece result;
    result.other_cells = piece.vertices + piece.lines;
    result.points = numbers_of(piece, "Points", "");
    const std::size_t size = result.points.numbers.size();
    if (size % 3 != 0 || size / 3 != piece.points)
      fail(result.points.place, ErrorCode::kNotAMesh,
           fmt::format("it holds {} numbers for {} points; export the mesh again", size,
                       piece.points));
    result.polygons = cells_of(piece, "Polys", piece.polygons);
    result.strips = cells_of(piece, "Strips", piece.strips);
    return result;
  }

  VtkCells cells_of(const VtpPiece& piece, std::string_view section, std::uint64_t count) {
    const VtkArray ends = numbers_of(piece, section, "offsets");
    if (ends.numbers.size() != count)
      fail(section, ErrorCode::kNotAMesh,
           fmt::format("it holds {} offsets for {} cells; export the mesh again",
                       ends.numbers.size(), count));
    return cells_by_ends(numbers_of(piece, section, "connectivity"), ends, 0, file_);
  }

  // The array of a name, or the section's first one; without numbers if it is missing.
  VtkArray numbers_of(const VtpPiece& piece, std::string_view section, std::string_view name) {
    for (const VtpArray& array : piece.arrays)
      if (array.section == section && (name.empty() || array.name == name)) return numbers(array);
    return {std::string(section), {}};
  }

  void read_labels(const VtpPiece& piece) {
    std::vector<VtkLabels::Array>& known = labels_->arrays;
    for (const VtpArray& array : piece.arrays) {
      const bool of_cells = array.section == "CellData";
      const NumberType* type = type_named(array.type);
      const bool is_data = of_cells || array.section == "PointData";
      if (!is_data || array.components != 1 || type == nullptr || array.type == "String") continue;
      auto place = std::find_if(known.begin(), known.end(), [&](const VtkLabels::Array& other) {
        return other.of_cells == of_cells && other.name == array.name;
      });
      if (place == known.end())
        place = known.insert(known.end(), {std::string(array.name), of_cells, true, {}});
      place->is_integer = place->is_integer && type->is_integer;
      const std::vector<double> more = numbers(array).numbers;
      place->numbers.insert(place->numbers.end(), more.begin(), more.end());
    }
  }

  static const NumberType* type_named(std::string_view name) {
    const auto* known = std::find_if(std::begin(kVtpTypes), std::end(kVtpTypes),
                                     [&](const NumberType& type) { return type.name == name; });
    return known == std::end(kVtpTypes) ? nullptr : known;
  }

  VtkArray numbers(const VtpArray& array) {
    std::string place = fmt::format("{} '{}'", array.section, printable(array.name));
    const NumberType* type = type_named(array.type);
    if (type == nullptr)
      fail(place, ErrorCode::kNotAMesh,
           fmt::format("'{}' is not a type of numbers that is read; export the mesh again",
                       printable(array.type)));
    std::string_view text = array.text;
    if (array.format.empty() || array.format == "ascii")
      return numbers_of_text(std::move(place), text, *type, file_);
    const std::string bytes = bytes_of(array, *type, place);
    if (bytes.size() % type->size != 0)
      fail(place, ErrorCode::kNotAMesh,
           fmt::format("its {} bytes are not numbers of {}; export the mesh again", bytes.size(),
                       type->size));
    VtkArray result{std::move(place), {}};
    result.numbers.reserve(bytes.size() / type->size);
    for (std::size_t at = 0; at < bytes.size(); at += type->size)
      result.numbers.push_back(number_in(&bytes[at], *type, is_big_endian_));
    return result;
  }

  // One length precedes the bytes. Packed bytes are blocks: their number, the size of a block and
  // of a shorter last one, and the packed size of each precede them.
  std::string bytes_of(const VtpArray& array, const NumberType& type, std::string_view place) {
    Packed packed{trimmed(array.text), false};
    const auto begin =
        static_cast<std::size_t>(std::min<std::uint64_t>(array.offset, appended_.size()));
    if (array.format == "appended")
      packed = {appended_.substr(begin), is_raw_};
    else if (array.format != "binary")
      fail(place, ErrorCode::kNotAMesh,
           fmt::format("the format '{}' is not read; export the mesh again",
                       printable(array.format)));
    if (compressor_.empty()) {
      const std::size_t size = length(first_bytes(packed, length_->size, place), 0, packed, place);
      return spend(first_bytes(packed, length_->size + size, place), place).substr(length_->size);
    }
    if (compressor_ != "vtkZLibDataCompressor")
      fail(place, ErrorCode::kNotAMesh,
           fmt::format("it is packed by {}, and only vtkZLibDataCompressor is read; save the file "
                       "without compression",
                       printable(compressor_)));
    if (!can_inflate())
      fail(place, ErrorCode::kNotAMesh,
           "it is packed, and this build has no zlib to unpack it; save the file without "
           "compression");
    std::string head = first_bytes(packed, 3 * length_->size, place);
    const std::size_t blocks = length(head, 0, packed, place);
    if (blocks > packed.text.size() / length_->size) fail_end(place);
    head = first_bytes(packed, (3 + blocks) * length_->size, place);
    std::size_t size = head.size();
    for (std::size_t i = 0; i < blocks && size <= packed.text.size(); ++i)
      size += length(head, 3 + i, packed, place);
    return unpacked(spend(first_bytes(packed, size, place), place), blocks, type, place);
  }

  std::string unpacked(const std::string& packed, std::size_t blocks, const NumberType& type,
                       std::string_view place) {
    const double whole = number_at(packed, 1), last = number_at(packed, 2);
    const double final = last > 0 ? last : whole;
    const auto total = blocks == 0 ? 0 : static_cast<double>(blocks - 1) * whole + final;
    unpacked_ += total / static_cast<double>(type.size) * sizeof(double);
    if (!(unpacked_ <= static_cast<double>(kMostUnpacked)))
      fail(place, ErrorCode::kMeshTooLarge,
           fmt::format("the arrays unpack to more than {} bytes; save the file without compression",
                       kMostUnpacked));
    std::string bytes;
    std::size_t at = (3 + blocks) * length_->size;
    for (std::size_t i = 0; i < blocks; ++i) {
      const auto size = static_cast<std::size_t>(number_at(packed, 3 + i));
      const auto block = static_cast<std::size_t>(i + 1 < blocks ? whole : final);
      const std::size_t begin = bytes.size();
      const bool may_fit = block / kMostUnpackedRatio <= size;
      if (may_fit) bytes.resize(begin + block);
      if (!may_fit || !inflate_bytes(std::string_view(packed).substr(at, size),
                                     std::span(bytes).subspan(begin)))
        fail(place, ErrorCode::kNotAMesh,
             "its packed bytes are damaged; copy or export the file again");
      at += size;
    }
    return bytes;
  }

  struct Packed {
    std::string_view text;
    bool is_raw;
  };

  std::string first_bytes(const Packed& packed, std::size_t size, std::string_view place) const {
    if (size > packed.text.size()) fail_end(place);
    if (packed.is_raw) return std::string(packed.text.substr(0, size));
    std::optional<std::string> bytes = decode_base64(packed.text, size);
    if (!bytes)
      fail(place, ErrorCode::kNotAMesh, "its base64 is damaged; copy or export the file again");
    return *std::move(bytes);
  }

  double number_at(const std::string& head, std::size_t index) const {
    return number_in(head.data() + index * length_->size, *length_, is_big_endian_);
  }
  // Returns a length in bytes or blocks. Throws if the packed bytes are fewer.
  std::size_t length(const std::string& head, std::size_t index, const Packed& packed,
                     std::string_view place) const {
    const double named = number_at(head, index);
    if (named > static_cast<double>(packed.text.size())) fail_end(place);
    return static_cast<std::size_t>(named);
  }

  // Arrays that share bytes could make much of a few.
  std::string spend(std::string bytes, std::string_view place) {
    spent_ += bytes.size();
    if (spent_ > file_.content.size())
      fail(place, ErrorCode::kNotAMesh, "arrays share their bytes; export the mesh again");
    return bytes;
  }

  static std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
    return text.substr(0, text.find_last_not_of(kBlank) + 1);
  }

  [[noreturn]] void fail(std::string_view place, ErrorCode code, std::string_view cause) const {
    fail_mesh(code, file_.name, place, cause);
  }
  [[noreturn]] void fail_end(std::string_view place) const {
    fail(place, ErrorCode::kMeshTruncated,
         "the file ends within this array; copy or export it again");
  }

  VtkFile file_;
  XmlReader xml_;
  FrameTags tags_;
  VtkLabels* labels_;
  bool is_big_endian_ = false, is_raw_ = false;
  const NumberType* length_ = &kLength32;
  std::string_view compressor_, appended_;
  std::vector<VtpArray> field_;
  std::vector<VtpPiece> pieces_;
  std::size_t spent_ = 0;  // bytes of arrays, as the file holds them
  double unpacked_ = 0;    // bytes that packed arrays take in memory
};

}  // namespace

TriangleMesh read_vtp(std::string_view content, std::string_view file, VtkLabels* labels) {
  return VtpReader(content, file, labels).read();
}

}  // namespace ist
