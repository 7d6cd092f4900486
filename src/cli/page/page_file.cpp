#include "cli/page/page_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>

#include "answers/json_parts.h"
#include "ist/base/throw_error.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::string_view kBegin = R"(<script type="application/json" id="ist-data">)";
constexpr std::string_view kEmpty = "null";
constexpr std::string_view kEnd = "</script>";
constexpr std::size_t kMega = 1'000'000;

// Writes JSON so that no text in it can end an element of HTML, or begin a comment.
void write_text(const std::string& json, OutputFile& file) {
  constexpr std::string_view kEscaped = "\\u003c";
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(json.find('<', begin), json.size());
    file.write(json.data() + begin, end - begin);
    if (end == json.size()) return;
    file.write(kEscaped.data(), kEscaped.size());
    begin = end + 1;
  }
}

}  // namespace

std::optional<std::filesystem::path> find_page() {
  const char* named = std::getenv("IST_PAGE");
  if (named != nullptr && *named != '\0') return named;
  std::error_code unknown;
  const auto command = std::filesystem::read_symlink("/proc/self/exe", unknown);
  if (unknown) return std::nullopt;
  const auto page = command.parent_path().parent_path() / "share" / "ist" / "page.html";
  if (!std::filesystem::exists(page, unknown)) return std::nullopt;
  return page;
}

void write_page(const std::filesystem::path& page, const nlohmann::ordered_json& block,
                OutputFile& file, std::size_t most) {
  const std::string html = InputFile(page).read_rest();
  const std::string place = fmt::format("{}{}{}", kBegin, kEmpty, kEnd);
  const std::size_t at = html.find(place);
  if (at == std::string::npos || html.find(kBegin, at + 1) != std::string::npos) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: it is no page of ist without data: make one by scripts/viewer.sh, "
                "and name it in IST_PAGE",
                page.string());
  }
  const std::size_t begin = at + kBegin.size();
  // A file's name may hold bytes that are no UTF-8.
  const std::string json = json_text(block);
  if (json.size() > most) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: it would hold {} MB of data, and a browser reads {} MB: take "
                "coarser meshes, or a shorter recording",
                file.target().string(), json.size() / kMega, most / kMega);
  }
  file.write(html.data(), begin);
  write_text(json, file);
  file.write(html.data() + begin + kEmpty.size(), html.size() - begin - kEmpty.size());
}

}  // namespace ist::cli
