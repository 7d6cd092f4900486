// VTK's XML PolyData: every encoding of its arrays, pieces, and every field that may be wrong.

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/base/error.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/largest_allocation.h"
#include "support/mesh_files.h"

namespace ist {
namespace {

using test::corners;
using test::replaced;

enum class VtpData { kText, kInline, kRaw, kAppended64 };

struct VtpForm {
  VtpData data = VtpData::kText;
  bool big_endian = false, wide = false;
  std::size_t block = 0;  // bytes of a block before it is packed; 0: not packed
};

template <class T>
std::string vtp_bytes(const std::vector<double>& numbers, bool big_endian) {
  std::string bytes;
  for (const double number : numbers) {
    const auto value = static_cast<T>(number);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (big_endian) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  return bytes;
}

std::string vtp_lengths(const std::vector<double>& numbers, const VtpForm& form) {
  return form.wide ? vtp_bytes<std::uint64_t>(numbers, form.big_endian)
                   : vtp_bytes<std::uint32_t>(numbers, form.big_endian);
}

// The bytes of an array and what precedes them, as VTK writes them.
std::string vtp_encoded(const std::string& bytes, const VtpForm& form) {
  const bool raw = form.data == VtpData::kRaw;
  if (form.block == 0) {
    const std::string all = vtp_lengths({static_cast<double>(bytes.size())}, form) + bytes;
    return raw ? all : test::base64(all);
  }
  std::vector<double> head = {0, static_cast<double>(form.block),
                              static_cast<double>(bytes.size() % form.block)};
  std::string packed;
  for (std::size_t at = 0; at < bytes.size(); at += form.block) {
    const std::string part = bytes.substr(at, form.block);
    uLongf size = compressBound(part.size());
    std::string out(size, '\0');
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(out.data()), &size,
                       reinterpret_cast<const Bytef*>(part.data()), part.size()),
              Z_OK);
    packed += out.substr(0, size);
    head.push_back(static_cast<double>(size));
    ++head[0];
  }
  return raw ? vtp_lengths(head, form) + packed
             : test::base64(vtp_lengths(head, form)) + test::base64(packed);
}

// Writes arrays, and collects what is appended.
class VtpWriter {
 public:
  explicit VtpWriter(const VtpForm& form) : form_(form) {}

  std::string array(const std::string& type, const std::string& name,
                    const std::vector<double>& numbers, const std::string& more = "") {
    std::string tag = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" " + more;
    if (form_.data == VtpData::kText) {
      tag += " format=\"ascii\">\n";
      for (const double number : numbers) {
        char text[32];
        std::snprintf(text, sizeof text, "%.17g ", number);
        tag += text;
      }
      return tag +
             "\n<InformationKey name=\"a\"><Value index=\"0\">1 2</Value></InformationKey>"
             "</DataArray>\n";
    }
    const std::string bytes = type == "Float64"   ? vtp_bytes<double>(numbers, form_.big_endian)
                              : type == "Float32" ? vtp_bytes<float>(numbers, form_.big_endian)
                              : type == "Int64" ? vtp_bytes<std::int64_t>(numbers, form_.big_endian)
                              : type == "UInt16"
                                  ? vtp_bytes<std::uint16_t>(numbers, form_.big_endian)
                                  : vtp_bytes<std::int8_t>(numbers, form_.big_endian);
    if (form_.data == VtpData::kInline)
      return tag + " format=\"binary\">\n  " + vtp_encoded(bytes, form_) + "\n</DataArray>\n";
    tag += " format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
    appended_ += vtp_encoded(bytes, form_);
    return tag;
  }

  std::string file(const std::string& pieces) const {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"" +
                       std::string(form_.big_endian ? "BigEndian" : "LittleEndian") + "\"" +
                       (form_.wide ? " header_type=\"UInt64\"" : "") +
                       (form_.block == 0 ? "" : " compressor=\"vtkZLibDataCompressor\"") +
                       ">\n<!-- made by hand -->\n<PolyData>\n" + pieces + "</PolyData>\n";
    if (form_.data == VtpData::kRaw || form_.data == VtpData::kAppended64)
      text += std::string("<AppendedData encoding=\"") +
              (form_.data == VtpData::kRaw ? "raw" : "base64") + "\">\n _" + appended_ +
              "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
  }

 private:
  VtpForm form_;
  std::string appended_;
};

constexpr const char* kVtpComponents = "NumberOfComponents=\"3\"";
const std::vector<double> kVtpPoints = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 1, 1, 0.1};
const std::vector<std::array<double, 9>> kVtpExpected = {
    {0, 0, 0, 2, 0, 0, 2, 2, 0}, {0, 0, 0, 2, 2, 0, 0, 2, 0}, {0, 0, 0, 2, 0, 0, 1, 1, 0.1}};

std::string vtp_piece(VtpWriter& writer, const std::string& counts, const std::string& cells,
                      const std::vector<double>& points = kVtpPoints) {
  return "<Piece " + counts + ">\n<PointData>" + writer.array("Float32", "Curv", {1, 2, 3, 4, 5}) +
         "</PointData><Points>\n" + writer.array("Float64", "Points", points, kVtpComponents) +
         "</Points>\n" + cells + "</Piece>\n";
}

std::string vtp_polys(VtpWriter& writer, const std::vector<double>& connectivity,
                      const std::vector<double>& offsets, const char* element = "Polys") {
  return std::string("<") + element + ">\n" + writer.array("Int64", "connectivity", connectivity) +
         writer.array("UInt16", "offsets", offsets) + "</" + element + ">\n";
}

// A square and a triangle in one form.
std::string vtp(const VtpForm& form,
                const std::vector<double>& connectivity = {0, 1, 2, 3, 0, 1, 4},
                const std::vector<double>& offsets = {4, 7}) {
  VtpWriter writer(form);
  return writer.file(
      "<FieldData>" +
      replaced(writer.array("String", "SPACE", {'L', 'P', 'S', 0}), "DataArray", "Array") +
      "</FieldData>\n" +
      vtp_piece(writer, "NumberOfPoints=\"5\" NumberOfPolys=\"2\"",
                "<Verts>\n</Verts>\n" + vtp_polys(writer, connectivity, offsets)));
}

std::vector<VtpForm> all_vtp_forms() {
  std::vector<VtpForm> forms = {{}};
  for (const VtpData data : {VtpData::kInline, VtpData::kRaw, VtpData::kAppended64})
    for (const bool big : {false, true})
      for (const bool wide : {false, true})
        for (const std::size_t block :
             {std::size_t{0}, std::size_t{7}, std::size_t{56}, std::size_t{32768}})
          forms.push_back({data, big, wide, block});
  return forms;
}

TriangleMesh read_vtp_bytes(std::string_view bytes) { return read_content(bytes, "mesh.vtp"); }

// The error's code and text, behind the file's name.
std::string vtp_refusal(std::string_view bytes) {
  const auto error = test::error_of([&] { static_cast<void>(read_content(bytes, "mesh.vtp")); });
  if (!error) return "fine";
  return std::string(to_string(error->code())) + (error->what() + std::strlen("mesh.vtp"));
}

TEST(Vtp, ReadsEveryEncoding) {
  for (const VtpForm& form : all_vtp_forms()) {
    const std::string text = vtp(form);
    const TriangleMesh mesh = read_vtp_bytes(text);
    EXPECT_EQ(corners(mesh), kVtpExpected) << text;
    EXPECT_EQ(mesh.frame, PatientFrame::kLps) << text;
  }
}

// Some writers encode the length and the bytes one after the other, each padded.
TEST(Vtp, ReadsALengthThatIsEncodedAlone) {
  const std::string points = vtp_bytes<double>(kVtpPoints, false);
  const std::string length = vtp_lengths({static_cast<double>(points.size())}, {});
  const std::string text = vtp({VtpData::kInline});
  const std::string changed =
      replaced(text, test::base64(length + points), test::base64(length) + test::base64(points));
  EXPECT_NE(changed, text);
  EXPECT_EQ(corners(read_vtp_bytes(changed)), kVtpExpected);
}

TEST(Vtp, JoinsPiecesAndStrips) {
  for (const VtpForm& form : {VtpForm{}, VtpForm{VtpData::kRaw, false, true, 16}}) {
    VtpWriter writer(form);
    const std::string fan = vtp_piece(writer, "NumberOfPoints=\"5\" NumberOfPolys=\"2\"",
                                      vtp_polys(writer, {0, 1, 2, 3, 0, 1, 4}, {4, 7}));
    const std::string strips =
        vtp_piece(writer,
                  "NumberOfPoints=\"5\" NumberOfVerts=\"1\" NumberOfLines=\"7\" "
                  "NumberOfStrips=\"2\"",
                  vtp_polys(writer, {0}, {1}, "Verts") +
                      vtp_polys(writer, {3, 2, 4, 1, 3, 3, 4}, {4, 7}, "Strips"),
                  {9, 9, 9, 5, 0, 0, 5, 5, 0, 0, 5, 0, 1, 1, 0.1});
    const std::string none = "<Piece NumberOfPoints=\"0\"><Points/><Polys/></Piece>";
    auto expected = kVtpExpected;
    expected.push_back({0, 5, 0, 5, 5, 0, 1, 1, 0.1});
    expected.push_back({1, 1, 0.1, 5, 5, 0, 5, 0, 0});
    EXPECT_EQ(corners(read_vtp_bytes(writer.file(fan + none + strips))), expected);
  }
}

TEST(Vtp, OtherDatasetsAreRefusedByTheirName) {
  for (const char* type : {"UnstructuredGrid", "ImageData", "vtkMultiBlockDataSet"}) {
    EXPECT_EQ(
        vtp_refusal(replaced(vtp({}), "type=\"PolyData\"", std::string("type=\"") + type + "\"")),
        std::string("not-a-mesh: the file is a VTK ") + type +
            ", and only PolyData is read; extract its surface (in ParaView: Extract Surface) "
            "and save it as PolyData");
  }
}

TEST(Vtp, ErrorsNameThePlaceAndTheRemedy) {
  const std::string text = vtp({});
  for (const auto& [from, to, expected] : std::vector<std::array<std::string, 3>>{
           {"0 0 0 2 ", "0 0 0 two ",
            "not-a-mesh: line 15: 'two' is not a number; export the mesh again"},
           {"0 0 0 2 ", "0 0 0 inf ",
            "mesh-not-finite: line 15: a coordinate is not finite, or beyond a float's range; "
            "repair the "
            "mesh where it was made"},
           {"0 0 0 2 ", "0 0 2 ",
            "not-a-mesh: Points 'Points': it holds 14 numbers for 5 points; export the mesh again"},
           {"NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"",
            "not-a-mesh: Points 'Points': it holds 15 numbers for 6 points; export the mesh again"},
           {"NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\"",
            "not-a-mesh: line 9: NumberOfPoints=\"-5\" is no count; export the mesh again"},
           {"NumberOfPolys=\"2\"", "NumberOfPolys=\"3\"",
            "not-a-mesh: Polys: it holds 2 offsets for 3 cells; export the mesh again"},
           {"Float64", "Complex",
            "not-a-mesh: Points 'Points': 'Complex' is not a type of numbers that is read; export "
            "the "
            "mesh again"},
           {"ascii", "hex",
            "not-a-mesh: FieldData 'SPACE': the format 'hex' is not read; export the mesh again"},
           {"</Points>", "",
            "not-a-mesh: line 28: </Piece> closes nothing; export the mesh again"}}) {
    const std::string changed = replaced(text, from, to);
    ASSERT_NE(changed, text) << from;
    EXPECT_EQ(vtp_refusal(changed), expected) << to;
  }
  const auto with = [](const std::vector<double>& connectivity,
                       const std::vector<double>& offsets) {
    return vtp_refusal(vtp({VtpData::kInline}, connectivity, offsets));
  };
  EXPECT_EQ(with({0, 1, 2, 3, 0, 1, 5}, {4, 7}),
            "mesh-bad-index: Polys 'connectivity': a face names point 5, but there are 5, counted "
            "from 0; export the mesh again");
  EXPECT_EQ(
      with({0, 1, 2, 3, 0, 1, 4}, {7, 4}),
      "not-a-mesh: Polys 'offsets': the offset 4 follows 7, and there are 7 corners; export the "
      "mesh again");
  EXPECT_EQ(
      with({0, 1, 2, 3, 0, 1, 4}, {4, 6}),
      "not-a-mesh: Polys 'offsets': the last offset is 6, but there are 7 corners; export the "
      "mesh again");
  EXPECT_EQ(
      with({0, 1, 2, 3, 0, 1, 4}, {5, 7}),
      "not-a-mesh: Polys 'connectivity': a face has 2 corners, and needs three; export the mesh "
      "again");
  EXPECT_EQ(
      vtp_refusal(vtp({}, {0, 1, 2, 3, 0, 1, -1}, {4, 7})),
      "mesh-bad-index: line 22: a face names point -1, but there are 5, counted from 0; export "
      "the mesh again");
}

TEST(Vtp, RefusesOtherCompressors) {
  const std::string packed = vtp({VtpData::kRaw, false, true, 64});
  EXPECT_EQ(vtp_refusal(replaced(packed, "vtkZLibDataCompressor", "vtkLZ4DataCompressor")),
            "not-a-mesh: FieldData 'SPACE': it is packed by vtkLZ4DataCompressor, and only "
            "vtkZLibDataCompressor is read; save the file without compression");
  std::string damaged = packed;
  damaged[packed.find("_") + 50] ^= 1;
  EXPECT_NE(vtp_refusal(damaged), "fine");
}

TEST(Vtp, NamesAFileWithoutPolygons) {
  VtpWriter writer({});
  EXPECT_TRUE(
      vtp_refusal(writer.file(vtp_piece(writer, "NumberOfPoints=\"5\" NumberOfVerts=\"1\"",
                                        vtp_polys(writer, {0}, {1}, "Verts"))))
          .starts_with("mesh-points-only: the file has 5 points, but no polygon or strip; "));
  EXPECT_EQ(vtp_refusal(writer.file("")),
            "mesh-empty: the PolyData has no point; export the mesh again");
}

// A few bytes claim any length.
TEST(Vtp, BelievesNoLengthThatTheFileDoesNotHold) {
  const auto points_of = [](const VtpForm& form, const std::string& data) {
    VtpWriter writer(form);
    return writer.file(
        "<Piece NumberOfPoints=\"1\"><Points><DataArray type=\"Int8\" format=\"binary\">" +
        test::base64(data) + "</DataArray></Points></Piece>");
  };
  for (const bool wide : {false, true}) {
    const double most = wide ? 0x1p63 : 0x1p32 - 1;
    const VtpForm plain{VtpData::kInline, false, wide, 0}, packed{VtpData::kInline, false, wide, 1};
    std::string text;
    const auto largest = [&](const VtpForm& form, const std::vector<double>& head) {
      return test::largest_allocation([&] {
        text = vtp_refusal(points_of(form, vtp_lengths(head, form) + std::string(90, 'x')));
      });
    };
    EXPECT_LT(largest(plain, {most}), 1u << 17);
    EXPECT_TRUE(text.starts_with("mesh-truncated: Points '': the file ends within")) << text;
    EXPECT_LT(largest(packed, {most, 1, 1}), 1u << 17);
    EXPECT_TRUE(text.starts_with("mesh-truncated: ")) << text;
    EXPECT_LT(largest(packed, {1, 1, most, 8}), 1u << 17);
    EXPECT_TRUE(text.starts_with("mesh-too-large: Points '': the arrays unpack to more than"))
        << text;
    EXPECT_LT(largest(packed, {2, most, 1, 8, 8}), 1u << 17);
    EXPECT_TRUE(text.starts_with("mesh-too-large: ")) << text;
    EXPECT_LT(largest(packed, {1, 1, 50000000, 8}), 1u << 17);
    EXPECT_TRUE(text.starts_with("not-a-mesh: Points '': its packed bytes are damaged")) << text;
    EXPECT_LT(largest(packed, {1, 1, 100, most}), 1u << 17);
    EXPECT_TRUE(text.starts_with("mesh-truncated: ")) << text;
  }
}

// Many arrays in the same bytes are a small file of a large surface.
TEST(Vtp, ReadsNoByteTwice) {
  std::string points(30000, '\0'), many;
  for (int i = 0; i < 100; ++i)
    many +=
        "<Piece NumberOfPoints=\"10000\"><Points><DataArray type=\"Int8\" format=\"appended\" "
        "offset=\"0\"/></Points></Piece>\n";
  const std::string file =
      "<VTKFile type=\"PolyData\">" + many + "<AppendedData encoding=\"raw\">_" +
      vtp_lengths({static_cast<double>(points.size())}, {}) + points + "</AppendedData></VTKFile>";
  EXPECT_EQ(vtp_refusal(file),
            "not-a-mesh: Points '': arrays share their bytes; export the mesh again");
}

TEST(Vtp, RefusesEveryCut) {
  for (const VtpForm& form : all_vtp_forms()) {
    if (form.wide != form.big_endian || form.block == 7) continue;
    const std::string text = vtp(form);
    for (std::size_t size = text.find("VTKFile") + 7; size + 1 < text.size(); ++size) {
      const std::string found = vtp_refusal(text.substr(0, size));
      EXPECT_TRUE(found.starts_with("mesh-truncated: "))
          << found << " at " << size << " of " << text;
    }
  }
}

}  // namespace
}  // namespace ist
