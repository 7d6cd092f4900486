#pragma once

#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// Returns "RAS" or "LPS", as 3D Slicer names a frame; empty if it is unknown.
[[nodiscard]] std::string_view slicer_name(PatientFrame frame);

/// Collects SPACE=RAS and SPACE=LPS. 3D Slicer writes them into the header of an STL, the comments
/// of a PLY or OBJ, and the title or the field data of a VTK file. Another word after SPACE= is
/// ignored.
class FrameTags {
 public:
  explicit FrameTags(std::string_view file) : file_(file) {}

  /// Looks for a tag in a header or comment. Throws kNotAMesh, naming the file, if it contradicts
  /// an earlier one.
  void read(std::string_view text);
  [[nodiscard]] PatientFrame frame() const { return frame_; }

 private:
  std::string_view file_;
  PatientFrame frame_ = PatientFrame::kUnknown;
};

}  // namespace ist
