#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "cli/occlusion/labels/label_files.h"
#include "ist/base/printable.h"

namespace ist::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

// Whether no text holds it.
bool is_control(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F;
}

}  // namespace

// Blank lines are well at the end alone.
std::vector<int> labels_of_lines(const std::filesystem::path& file, ToothNumbers system) {
  const std::string content = text_of(file);
  if (std::any_of(content.begin(), content.end(), is_control)) {
    refuse_labels(file, "it is no text: write one whole number a line");
  }
  std::vector<int> numbers;
  std::size_t line = 0, blank = 0;  // counted from 1; the first blank one
  for (std::size_t at = 0; at < content.size();) {
    const std::size_t end = std::min(content.find('\n', at), content.size());
    const std::string_view text = trimmed(std::string_view(content).substr(at, end - at));
    at = end + 1;
    ++line;
    if (text.empty()) {
      if (blank == 0) blank = line;
      continue;
    }
    if (blank != 0) {
      refuse_labels(file, fmt::format("line {} is empty: write 0 for no tooth", blank));
    }
    int number = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || rest != text.data() + text.size()) {
      refuse_labels(file, fmt::format("line {} is \"{}\": write one whole number a line", line,
                                      printable(text)));
    }
    if (!is_tooth_number(number, system)) {
      refuse_tooth_number(number, system, fmt::format("{}: line {}", file.string(), line));
    }
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace ist::cli
