#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "ist/mesh/format/text_reader.h"

namespace ist {

enum class PlyEncoding : std::uint8_t { kText, kLittleEndian, kBigEndian };

enum class PlyType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};

[[nodiscard]] std::size_t size_of(PlyType type);
[[nodiscard]] bool is_integer(PlyType type);

/// What a property is to a surface.
enum class PlyRole : std::uint8_t { kX, kY, kZ, kCorners, kOther };

struct PlyProperty {
  PlyRole role = PlyRole::kOther;
  std::optional<PlyType> count_type;  ///< of a list only
  PlyType type = PlyType::kFloat32;
};

struct PlyElement {
  std::string_view name;    ///< lies in the content
  std::uint64_t count = 0;  ///< as declared: any number
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  std::vector<PlyElement> elements;
};

/// Reads the header of a PLY, and leaves the reader on its last line. There is at most one element
/// `vertex`, with x, y and z, and at most one `face`, with one list of integer corners.
/// Errors: kNotAMesh, kMeshTruncated.
[[nodiscard]] PlyHeader read_ply_header(TextReader& reader);

}  // namespace ist
