#include "ist/mesh/import/import_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "ist/base/printable.h"
#include "ist/mesh/format/mesh_builder.h"
#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

constexpr std::size_t kMostText = 1000;  // of a message, bytes

class ImportReader {
 public:
  ImportReader(std::string_view answer, const std::filesystem::path& importer,
               std::string_view file)
      : answer_(answer), importer_(importer), file_(file) {}

  TriangleMesh read() {
    read_header();
    if (header_.kind == ImportHeader::kError) fail_as_told();
    require(header_.kind == ImportHeader::kMesh && header_.unit <= kLengthUnits.size() &&
            header_.frame <= kPatientFrames.size());
    IndexedFaces faces;
    read_vertices(faces);
    read_polygons(faces);
    TriangleMesh mesh = faces.weld();
    mesh.unit = static_cast<LengthUnit>(header_.unit);
    mesh.frame = static_cast<PatientFrame>(header_.frame);
    return mesh;
  }

 private:
  void read_header() {
    require(answer_.size() >= sizeof header_);
    std::memcpy(&header_, answer_.data(), sizeof header_);
    answer_.remove_prefix(sizeof header_);
    require(header_.magic == kImportMagic);
    const ImportHeader ours = import_header();
    if (header_.protocol != ours.protocol || header_.version != ours.version)
      fail_mesh(ErrorCode::kFileUnreadable, file_, "",
                fmt::format("ist-import at {} belongs to version {}, and this library is version "
                            "{}: install both from one release",
                            importer_.string(), text_of(header_.version), text_of(ours.version)));
    require(answer_.ends_with(kImportEnd));
    answer_.remove_suffix(kImportEnd.size());
  }

  static std::string text_of(const std::array<char, 16>& version) {
    const std::string_view text(version.data(), version.size());
    return printable(text.substr(0, text.find('\0')));
  }

  [[noreturn]] void fail_as_told() const {
    constexpr ErrorCode kKinds[] = {ErrorCode::kFileUnreadable, ErrorCode::kNotAMesh,
                                    ErrorCode::kMeshEmpty,      ErrorCode::kMeshPointsOnly,
                                    ErrorCode::kMeshTruncated,  ErrorCode::kMeshBadIndex,
                                    ErrorCode::kMeshNotFinite,  ErrorCode::kMeshTooLarge};
    const auto code = static_cast<ErrorCode>(header_.unit);
    require(std::find(std::begin(kKinds), std::end(kKinds), code) != std::end(kKinds) &&
            header_.vertices <= answer_.size() &&
            header_.polygons == answer_.size() - header_.vertices);
    fail_mesh(code, file_, printable(answer_.substr(0, header_.vertices), kMostText),
              printable(answer_.substr(header_.vertices), kMostText));
  }

  void read_vertices(IndexedFaces& faces) {
    require(header_.vertices <= kMostPlaced && header_.corners <= kMostPlaced &&
            header_.polygons <= header_.corners &&
            answer_.size() == header_.vertices * 3 * sizeof(double) +
                                  (header_.polygons + header_.corners) * sizeof(std::uint32_t));
    for (std::uint64_t i = 0; i < header_.vertices; ++i) {
      Eigen::Vector3d point;
      std::memcpy(point.data(), answer_.data() + i * sizeof point, sizeof point);
      if (!(is_coordinate(point.x()) && is_coordinate(point.y()) && is_coordinate(point.z())))
        fail_mesh(ErrorCode::kMeshNotFinite, file_, fmt::format("vertex {}", i),
                  "it is not finite, or beyond a float's range; repair the mesh where it was made");
      faces.add_vertex(point);
    }
    answer_.remove_prefix(header_.vertices * 3 * sizeof(double));
  }

  void read_polygons(IndexedFaces& faces) {
    std::size_t left = header_.corners;
    const char* sizes = answer_.data();
    const char* indices = sizes + header_.polygons * sizeof(std::uint32_t);
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < header_.polygons; ++i) {
      std::uint32_t size = 0;
      std::memcpy(&size, sizes + i * sizeof size, sizeof size);
      require(size >= 3 && size <= left);
      if (size > kMaxCorners)
        fail_mesh(ErrorCode::kNotAMesh, file_, fmt::format("face {}", i),
                  fmt::format("it has {} corners, more than {}; triangulate the mesh first", size,
                              kMaxCorners));
      corners.resize(size);
      std::memcpy(corners.data(), indices, size * sizeof size);
      indices += size * sizeof size;
      left -= size;
      for (const std::uint32_t corner : corners) require(corner < header_.vertices);
      faces.add_face(corners);
    }
    require(left == 0);
  }

  void require(bool holds) const {
    if (holds) return;
    fail_mesh(
        ErrorCode::kFileUnreadable, file_, "",
        fmt::format("ist-import at {} gave no mesh that can be trusted: install it again, or {}",
                    importer_.string(), kConvert));
  }

  std::string_view answer_;
  const std::filesystem::path& importer_;
  std::string_view file_;
  ImportHeader header_{};
};

}  // namespace

ImportHeader import_header() {
  ImportHeader header{};
  header.magic = kImportMagic;
  header.protocol = kImportProtocol;
  constexpr std::string_view kVersion = IST_VERSION;
  static_assert(kVersion.size() < std::tuple_size_v<decltype(header.version)>);
  std::copy(kVersion.begin(), kVersion.end(), header.version.begin());
  return header;
}

bool is_complete_import(std::string_view answer) {
  return answer.size() >= sizeof(ImportHeader) + kImportEnd.size() && answer.ends_with(kImportEnd);
}

TriangleMesh read_import_message(std::string_view answer, const std::filesystem::path& importer,
                                 std::string_view file) {
  return ImportReader(answer, importer, file).read();
}

}  // namespace ist
