#include "cli/page/page_file.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "ist/base/error.h"

namespace ist::cli {
namespace {

constexpr std::string_view kBegin = R"(<script type="application/json" id="ist-data">)";
constexpr std::string_view kEmpty = "null";
constexpr std::string_view kEnd = "</script>";

// JSON in which no text can end an element of HTML, or begin a comment.
std::string text_of(const nlohmann::ordered_json& block) {
  // A file's name may hold bytes that are no UTF-8.
  const std::string json =
      block.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string text;
  text.reserve(json.size());
  for (const char character : json) {
    if (character == '<') {
      text += "\\u003c";
    } else {
      text += character;
    }
  }
  return text;
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
                OutputFile& file) {
  const std::string html = InputFile(page).read_rest();
  const std::string place = fmt::format("{}{}{}", kBegin, kEmpty, kEnd);
  const std::size_t at = html.find(place);
  if (at == std::string::npos || html.find(kBegin, at + 1) != std::string::npos) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{}: it is no page of ist without data: make one by scripts/viewer.sh, "
                            "and name it in IST_PAGE",
                            page.string()));
  }
  const std::size_t begin = at + kBegin.size();
  const std::string text = text_of(block);
  file.write(html.data(), begin);
  file.write(text.data(), text.size());
  file.write(html.data() + begin + kEmpty.size(), html.size() - begin - kEmpty.size());
}

}  // namespace ist::cli
