#include "ist/mesh/format/frame_tags.h"

#include <algorithm>

#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// Returns the letters at the beginning of a text.
std::string_view leading_word(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_letter);
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

}  // namespace

std::string_view slicer_name(PatientFrame frame) {
  return frame == PatientFrame::kRas ? "RAS" : frame == PatientFrame::kLps ? "LPS" : "";
}

void FrameTags::read(std::string_view text) {
  constexpr std::string_view kKey = "SPACE=";
  for (std::size_t at = text.find(kKey); at != text.npos; at = text.find(kKey, at + 1)) {
    if (at > 0 && is_letter(text[at - 1])) continue;
    const std::string_view word = leading_word(text.substr(at + kKey.size()));
    for (const PatientFrame frame : kPatientFrames) {
      if (!same_word(word, slicer_name(frame))) continue;
      if (contradict(frame_, frame))
        fail_mesh(ErrorCode::kNotAMesh, file_, "",
                  "the file says both SPACE=RAS and SPACE=LPS; export the mesh again in one frame");
      frame_ = frame;
    }
  }
}

}  // namespace ist
