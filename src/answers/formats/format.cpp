#include "answers/formats/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "answers/refusals.h"

namespace ist::answers {
namespace {

// The programs that open files of a format; "" if any editor does.
std::string_view programs(FileFormat format) {
  switch (format) {
    case FileFormat::kVtp:
      return "ParaView, 3D Slicer";
    case FileFormat::kPly:
      return "MeshLab, CloudCompare, Blender";
    case FileFormat::kGlb:
      return "browsers, Blender";
    case FileFormat::kCsv:
      return "Excel, R";
    default:
      return "";
  }
}

// Joins what `name` says of each format.
template <class Name>
std::string in_words(std::span<const FileFormat> formats, const Name& name) {
  std::string words;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    if (i > 0) words += i + 1 == formats.size() ? " or " : ", ";
    words += name(formats[i]);
  }
  return words;
}

}  // namespace

const char* ending(FileFormat format) {
  switch (format) {
    case FileFormat::kVtp:
      return ".vtp";
    case FileFormat::kPly:
      return ".ply";
    case FileFormat::kGlb:
      return ".glb";
    case FileFormat::kCsv:
      return ".csv";
    case FileFormat::kJsonl:
      return ".jsonl";
    case FileFormat::kJson:
      return ".json";
    case FileFormat::kHtml:
      return ".html";
    case FileFormat::kPng:
      return ".png";
    case FileFormat::kSvg:
      return ".svg";
    case FileFormat::kPdf:
      return ".pdf";
  }
  return "";
}

std::string endings_with_programs(std::span<const FileFormat> formats) {
  return in_words(formats, [](FileFormat format) {
    const std::string_view opened_by = programs(format);
    return opened_by.empty() ? std::string(ending(format))
                             : fmt::format("{} ({})", ending(format), opened_by);
  });
}

FileFormat format_by_ending(const std::string& option, const std::filesystem::path& file,
                            std::span<const FileFormat> writable) {
  const std::string written = file.extension().string();
  std::string lower = written;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = std::find_if(writable.begin(), writable.end(),
                                  [&](FileFormat format) { return lower == ending(format); });
  if (found != writable.end()) return *found;
  throw Refusal(option + " " + file.string(),
                (written.empty() ? "a name without an ending says no format"
                                 : written + " cannot be written here") +
                    ": name a file that ends in " + in_words(writable, ending));
}

}  // namespace ist::answers
