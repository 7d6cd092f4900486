#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "import/zip_parts.h"

namespace ist::import {

/// The modifiers and the blockers and enforcers of supports in a slicer's project. They are no part
/// of the body. PrusaSlicer and Slic3r keep them as triangles of the same mesh
/// (Metadata/Slic3r_PE_model.config), Bambu Studio and OrcaSlicer as components of the object
/// (Metadata/model_settings.config). Throws a Refusal for a negative volume: it cuts the body.
class SlicerParts {
 public:
  explicit SlicerParts(ZipParts& archive);

  /// Returns whether a triangle of the root model's object is part of the body.
  [[nodiscard]] bool is_body(std::uint32_t object, std::size_t triangle) const;
  /// Returns whether a component of the root model's object is part of the body.
  [[nodiscard]] bool is_body_part(std::uint32_t object, std::uint32_t component) const;

 private:
  struct Range {
    std::size_t first, last;
  };
  std::map<std::uint32_t, std::vector<Range>> left_out_;  // of each object, triangles
  std::vector<std::pair<std::uint32_t, std::uint32_t>> left_out_parts_;
};

}  // namespace ist::import
