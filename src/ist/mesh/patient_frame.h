#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace ist {

/// The directions of the patient that a mesh's axes point to. 3D Slicer writes SPACE=RAS or
/// SPACE=LPS into its files. A half turn about z leads from one frame to the other.
/// Tree files and the C interface hold the numbers.
enum class PatientFrame : std::uint8_t {
  kUnknown,  ///< 0: the file does not say
  kRas,      ///< 1: +x right, +y front, +z up
  kLps,      ///< 2: +x left, +y back, +z up
};

/// All frames but kUnknown.
inline constexpr std::array kPatientFrames = {PatientFrame::kRas, PatientFrame::kLps};

/// Returns "ras" or "lps"; "unknown" for kUnknown.
[[nodiscard]] constexpr std::string_view to_string(PatientFrame frame) noexcept {
  constexpr std::array<std::string_view, 3> kNames = {"unknown", "ras", "lps"};
  const auto at = static_cast<std::size_t>(frame);
  return at < kNames.size() ? kNames[at] : "";
}

/// Returns the frame of that name, or nullopt for another text.
[[nodiscard]] constexpr std::optional<PatientFrame> patient_frame(std::string_view name) noexcept {
  for (const PatientFrame frame : kPatientFrames) {
    if (name == to_string(frame)) return frame;
  }
  return std::nullopt;
}

/// Returns whether both frames are known, and differ.
[[nodiscard]] constexpr bool contradict(PatientFrame a, PatientFrame b) noexcept {
  return a != b && a != PatientFrame::kUnknown && b != PatientFrame::kUnknown;
}

}  // namespace ist
