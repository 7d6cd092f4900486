#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "ist/base/printable.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/percent.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/format/vtk_surface.h"

namespace ist {
namespace {

// Types of the legacy form. VTK writes a vtkIdType in 32 bits, and a long as its machine has it.
constexpr NumberType kVtkTypes[] = {number_type<std::int8_t>("char"),
                                    number_type<std::int8_t>("signed_char"),
                                    number_type<std::uint8_t>("unsigned_char"),
                                    number_type<std::int16_t>("short"),
                                    number_type<std::uint16_t>("unsigned_short"),
                                    number_type<std::int32_t>("int"),
                                    number_type<std::uint32_t>("unsigned_int"),
                                    number_type<std::int32_t>("vtkidtype"),
                                    number_type<std::int64_t>("vtktypeint64"),
                                    number_type<std::uint64_t>("vtktypeuint64"),
                                    number_type<std::int64_t>("long"),
                                    number_type<std::uint64_t>("unsigned_long"),
                                    number_type<float>("float"),
                                    number_type<double>("double")};
constexpr NumberType kShortLong = number_type<std::int32_t>("long"),
                     kShortUnsignedLong = number_type<std::uint32_t>("unsigned_long");

class VtkReader {
 public:
  VtkReader(std::string_view content, std::string_view name, VtkLabels* labels)
      : file_{content, name}, rest_(content), tags_(name), labels_(labels) {}

  TriangleMesh read() {
    read_header();
    for (std::string_view keyword = next_word(rest_); !keyword.empty();
         keyword = next_word(rest_)) {
      if (!read_section(keyword)) break;
    }
    VtkSurface surface(file_, labels_);
    surface.add(piece_);
    return surface.finish(tags_.frame());
  }

 private:
  void read_header() {
    static_cast<void>(line());
    tags_.read(line());
    const std::string_view encoding = word();
    if (!same_word(encoding, "ASCII") && !same_word(encoding, "BINARY"))
      fail(encoding, "is neither ASCII nor BINARY");
    const std::string_view keyword = word();
    const std::string_view type = same_word(keyword, "DATASET") ? word() : keyword;
    if (file_.is_last(type)) fail_end();
    if (!same_word(type, "POLYDATA")) fail_vtk_dataset(type, file_.name);
    is_binary_ = same_word(encoding, "BINARY");
  }

  // Returns false at the data of points and cells, if nobody asks for labels: no face follows them.
  bool read_section(std::string_view keyword) {
    const auto is = [keyword](std::string_view name) { return same_word(keyword, name); };
    section_ = keyword;
    if (is("VERTICES") || is("LINES")) {
      piece_.other_cells += read_cells().cells.size();
    } else if (is("POLYGONS") || is("TRIANGLE_STRIPS")) {
      VtkCells& cells = is("POLYGONS") ? piece_.polygons : piece_.strips;
      require_first(cells.corners);
      cells = read_cells();
    } else if (is("POINTS")) {
      require_first(piece_.points);
      const std::uint64_t points = count();
      piece_.points = numbers(word(), points, 3);
      skip_metadata(3);
    } else if (is("FIELD")) {
      static_cast<void>(word());
      const std::uint64_t arrays = count();
      for (std::uint64_t i = 0; i < arrays; ++i) read_field_array();
    } else if (is("CELL_DATA") || is("POINT_DATA")) {
      if (labels_ == nullptr) return false;
      of_cells_ = is("CELL_DATA");
      tuples_ = count();
    } else if (!tuples_ || !read_attribute(keyword)) {
      fail(keyword, "is not expected here");
    }
    return true;
  }

  VtkCells read_cells() {
    const std::uint64_t cells = count(), size = count();
    std::string_view ahead = rest_;
    if (!same_word(next_word(ahead), "OFFSETS")) return read_cell_list(cells, size);
    rest_ = ahead;
    const VtkArray ends = numbers(word(), cells, 1);
    skip_metadata(1);
    const std::string_view keyword = word();
    if (!same_word(keyword, "CONNECTIVITY")) fail(keyword, "stands in place of CONNECTIVITY");
    VtkArray corners = numbers(word(), size, 1);
    skip_metadata(1);
    return cells_by_ends(std::move(corners), ends, 1, file_);
  }

  // Before version 5, the number of its corners precedes each cell.
  VtkCells read_cell_list(std::uint64_t count, std::uint64_t size) {
    VtkCells result{numbers("int", size, 1), {}};
    const std::vector<double>& list = result.corners.numbers;
    for (std::size_t at = 0; at < list.size();) {
      const std::size_t left = list.size() - at - 1;
      if (result.cells.size() == count || !(list[at] >= 0 && list[at] <= static_cast<double>(left)))
        file_.fail(result.corners, at, ErrorCode::kNotAMesh,
                   fmt::format("the list of {} numbers is not {} cells; export the mesh again",
                               size, count));
      const auto corners = static_cast<std::size_t>(list[at]);
      result.cells.push_back({at + 1, corners});
      at += corners + 1;
    }
    if (result.cells.size() != count)
      file_.fail(result.corners, list.size(), ErrorCode::kNotAMesh,
                 fmt::format("the list holds {} of {} cells; export the mesh again",
                             result.cells.size(), count));
    return result;
  }

  void read_field_array() {
    const std::string_view name = word();
    if (name == "NULL_ARRAY") return;
    const std::uint64_t components = count(), tuples = count();
    read_array(name, word(), tuples, components);
  }

  // Reads what follows the keyword of an array for each point or cell.
  bool read_attribute(std::string_view keyword) {
    struct Attribute {
      std::string_view keyword;
      std::uint64_t components;
    };
    constexpr Attribute kAttributes[] = {{"VECTORS", 3},   {"NORMALS", 3},    {"TENSORS", 9},
                                         {"TENSORS6", 6},  {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1},
                                         {"EDGE_FLAGS", 1}};
    const auto is = [keyword](std::string_view name) { return same_word(keyword, name); };
    const std::string_view name = word();
    for (const Attribute& attribute : kAttributes) {
      if (!is(attribute.keyword)) continue;
      read_array(name, word(), *tuples_, attribute.components);
      return true;
    }
    const std::string_view colour = is_binary_ ? "unsigned_char" : "float";
    if (is("SCALARS")) {
      const std::string_view type = word();
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      std::string_view same_line = rest_.substr(0, end);
      std::uint64_t components = 1;
      if (!next_word(same_line).empty()) components = count();
      constexpr std::string_view kTable = "\nLOOKUP_TABLE";  // may be missing
      const std::size_t next = std::min(rest_.find('\n'), rest_.size());
      if (same_word(rest_.substr(next, kTable.size()), kTable)) {
        static_cast<void>(word());
        static_cast<void>(word());
      }
      read_array(name, type, *tuples_, components);
    } else if (is("COLOR_SCALARS")) {
      const std::uint64_t components = count();
      read_array(name, colour, *tuples_, components);
    } else if (is("LOOKUP_TABLE")) {
      const std::uint64_t entries = count();
      read_array(name, colour, entries, 4);
    } else if (is("TEXTURE_COORDINATES")) {
      const std::uint64_t components = count();
      read_array(name, word(), *tuples_, components);
    } else {
      return false;
    }
    return true;
  }

  void read_array(std::string_view name, std::string_view type, std::uint64_t tuples,
                  std::uint64_t components) {
    if (same_word(type, "string") || same_word(type, "utf8_string")) {
      static_cast<void>(line());
      for (std::size_t i = 0, size = product(tuples, components); i < size; ++i) {
        if (rest_.empty()) fail_end();
        const std::string text =
            is_binary_ ? std::string(binary_string()) : percent_decoded(line());
        if (name == "SPACE") tags_.read("SPACE=" + text);
      }
    } else if (same_word(type, "bit") && is_binary_) {
      static_cast<void>(line());
      static_cast<void>(bytes((product(tuples, components) + 7) / 8));
    } else {
      const bool is_bit = same_word(type, "bit");
      const NumberType& known = type_named(is_bit ? "char" : type);
      std::vector<double> read = numbers(known.name, tuples, components).numbers;
      if (labels_ != nullptr && tuples_ && components == 1 && !is_bit)
        labels_->arrays.push_back(
            {percent_decoded(name), of_cells_, known.is_integer, std::move(read)});
    }
    skip_metadata(components);
  }

  VtkArray numbers(std::string_view type_name, std::uint64_t tuples, std::uint64_t components) {
    const std::size_t size = product(tuples, components);
    const NumberType* type = &type_named(type_name);
    if (!is_binary_) {
      VtkArray array = numbers_of_text(std::string(section_), rest_, *type, file_, size);
      if (array.numbers.size() < size) fail_end();
      return array;
    }
    VtkArray array{std::string(section_), {}};
    if (size == 0) return array;
    static_cast<void>(line());
    if (same_word(type->name, "long") || same_word(type->name, "unsigned_long")) {
      const bool may_be_short = ends_at(size, kShortLong);
      if (may_be_short && ends_at(size, *type))
        fail_mesh(ErrorCode::kNotAMesh, file_.name, section_,
                  "its numbers could have 32 or 64 bits; save the file as ASCII");
      if (may_be_short) type = type->name == kShortLong.name ? &kShortLong : &kShortUnsignedLong;
    }
    const std::string_view raw = bytes(std::uint64_t{size} * type->size);
    array.numbers.reserve(size);
    for (std::size_t at = 0; at < raw.size(); at += type->size)
      array.numbers.push_back(number_in(raw.data() + at, *type, true));
    return array;
  }

  // Whether a line end follows so many numbers. VTK writes one behind each array.
  bool ends_at(std::size_t count, const NumberType& type) const {
    const std::uint64_t size = std::uint64_t{count} * type.size;
    return size == rest_.size() ||
           (size < rest_.size() && rest_[static_cast<std::size_t>(size)] == '\n');
  }

  const NumberType& type_named(std::string_view name) const {
    for (const NumberType& type : kVtkTypes)
      if (same_word(type.name, name)) return type;
    fail(name, "is not a type of numbers that is read");
  }

  // Returns the number of an array's values. Throws if the rest of the file has fewer bits.
  std::size_t product(std::uint64_t tuples, std::uint64_t components) const {
    const std::uint64_t most = std::min<std::uint64_t>(8 * std::uint64_t{rest_.size()}, SIZE_MAX);
    if (components != 0 && tuples > most / components) fail_end();
    return static_cast<std::size_t>(tuples * components);
  }

  // Two bits tell how many bytes the length takes.
  std::string_view binary_string() {
    const auto first = static_cast<unsigned char>(rest_.empty() ? '\0' : rest_[0]);
    const std::size_t size = std::size_t{8} >> (first >> 6);
    std::uint64_t length = first & 0x3F;
    for (const char c : bytes(size).substr(1)) length = length << 8 | static_cast<unsigned char>(c);
    return bytes(length);
  }

  // Metadata of an array end at a blank line; lines of names may be blank.
  void skip_metadata(std::uint64_t components) {
    std::string_view ahead = rest_;
    if (!same_word(next_word(ahead), "METADATA")) return;
    rest_ = ahead;
    static_cast<void>(line());
    while (!rest_.empty()) {
      std::string_view text = line();
      const std::string_view keyword = next_word(text);
      if (keyword.empty()) return;
      if (!same_word(keyword, "COMPONENT_NAMES")) continue;
      for (std::uint64_t i = 0; i < components && !rest_.empty(); ++i) static_cast<void>(line());
    }
  }

  // Removes the rest of this line.
  std::string_view line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
  }
  std::string_view word() {
    const std::string_view found = next_word(rest_);
    if (found.empty()) fail_end();
    return found;
  }
  std::uint64_t count() {
    const std::string_view spelled = word();
    const std::optional<std::int64_t> value = TextReader::whole(spelled);
    if (!value || *value < 0) fail(spelled, "is not a count");
    return static_cast<std::uint64_t>(*value);
  }
  std::string_view bytes(std::uint64_t size) {
    if (size > rest_.size()) fail_end();
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }

  void require_first(const VtkArray& array) const {
    if (!array.place.empty()) fail(section_, "stands twice");
  }
  // Throws an error about a word: at its line, or in its section if the file is binary.
  [[noreturn]] void fail(std::string_view word, std::string_view fault) const {
    const std::string cause = fmt::format("'{}' {}; export the mesh again", printable(word), fault);
    if (!is_binary_) file_.fail_word(word, cause);
    if (file_.is_last(word)) fail_end();
    fail_mesh(ErrorCode::kNotAMesh, file_.name, printable(section_), cause);
  }
  [[noreturn]] void fail_end() const {
    fail_mesh(ErrorCode::kMeshTruncated, file_.name, printable(section_),
              "the file ends within this section; copy or export it again");
  }

  VtkFile file_;
  std::string_view rest_;  // of the content
  FrameTags tags_;
  VtkLabels* labels_;
  bool is_binary_ = false;
  std::string_view section_ = "header";
  VtkPiece piece_;
  bool of_cells_ = false;                // the arrays' owner
  std::optional<std::uint64_t> tuples_;  // the number of those points or cells
};

}  // namespace

TriangleMesh read_vtk(std::string_view content, std::string_view file, VtkLabels* labels) {
  return VtkReader(content, file, labels).read();
}

}  // namespace ist
