#pragma once

#include <string_view>

#include "ist/mesh/mesh.h"

namespace ist {

/// Returns "RAS" or "LPS", as 3D Slicer names a frame; empty if it is unknown.
[[nodiscard]] std::string_view slicer_name(PatientFrame frame);

/// Collects SPACE=RAS and SPACE=LPS, which 3D Slicer writes into the header of an STL and the
/// comments of a PLY or OBJ. Another word after SPACE= says nothing here.
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
