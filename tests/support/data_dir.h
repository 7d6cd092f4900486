#pragma once

#include <filesystem>

namespace ist::test {

/// The folder of real meshes: IST_DATA_DIR, or ../shared/data beside the project's root. A test
/// that needs it and finds no such folder calls IST_SKIP.
[[nodiscard]] std::filesystem::path data_dir();

}  // namespace ist::test
