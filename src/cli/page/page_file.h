#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "ist/base/files.h"

namespace ist::cli {

/// Returns the page that shows bodies with the engine in it: the file that the environment's
/// IST_PAGE names, or share/ist/page.html beside the folder of the command. Nothing where neither
/// is there: the command was built or packed without the page.
[[nodiscard]] std::optional<std::filesystem::path> find_page();

/// Says how to get a page, for those who have none.
inline constexpr const char* kHowToGetPage =
    "this build has no page: make it by scripts/viewer.sh, and name it in IST_PAGE";

/// Browsers' texts end at 2^29 characters; some room is left for `<`, which is written longer.
inline constexpr std::size_t kMostPageData = 500'000'000;

/// Writes the page with `block` in it, for its data (src/viewer/page/data_block.js). No text in the
/// block can end its element. Throws kInputInvalid for a file that is no such page, or that holds
/// data already, and for a block of more than `most` bytes; kFileUnreadable, kFileUnwritable.
void write_page(const std::filesystem::path& page, const nlohmann::ordered_json& block,
                OutputFile& file, std::size_t most = kMostPageData);

}  // namespace ist::cli
