#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/mesh.h"

namespace ist {

enum class PlyEncoding : std::uint8_t { kText, kLittleEndian, kBigEndian };

/// The type of a property's numbers. All are exact as a double.
using PlyType = NumberType;

/// The role of a property in the surface; the first three are a vertex's axes.
enum class PlyRole : std::uint8_t { kX, kY, kZ, kCorners, kOther };

struct PlyProperty {
  std::string_view name;  ///< a view of the content
  PlyRole role = PlyRole::kOther;
  const PlyType* count_type = nullptr;  ///< for a list only
  const PlyType* type = nullptr;
};

struct PlyElement {
  std::string_view name;    ///< a view of the content
  std::uint64_t count = 0;  ///< as declared: any number
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  std::vector<PlyElement> elements;
  PatientFrame frame = PatientFrame::kUnknown;  ///< as a comment says it
};

/// The element of triangle strips: lists of corners, with -1 after each strip.
inline constexpr std::string_view kPlyStrips = "tristrips";

/// Reads the header of a PLY and leaves the reader on the header's last line. The result has at
/// most one element `vertex`, with x, y and z, and at most one `face`, with one list of integer
/// corners. An element of strips has such a list too.
/// Errors: kNotAMesh, kMeshTruncated.
[[nodiscard]] PlyHeader read_ply_header(TextReader& reader);

}  // namespace ist
