#include "answers/formats/format.h"

#include <algorithm>
#include <cctype>

#include "answers/refusals.h"

namespace ist::answers {
namespace {

std::string in_words(std::span<const FileFormat> formats) {
  std::string words;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    if (i > 0) words += i + 1 == formats.size() ? " or " : ", ";
    words += ending(formats[i]);
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
  }
  return "";
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
                    ": name a file that ends in " + in_words(writable));
}

}  // namespace ist::answers
