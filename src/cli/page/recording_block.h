#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace ist::cli {

/// Whether a file begins as a recording of `ist run` does. Throws kFileUnreadable.
[[nodiscard]] bool is_recording(const std::filesystem::path& file);

/// Returns the data of a page that plays a recording: its text, and the bodies of its scene at
/// their places before the first tick.
///
/// @param scene the scene that it was recorded of; empty: the page shows no bodies, and says so
///
/// Builds the scene under a progress bar, for the places. Throws kInputInvalid for a file that is
/// no recording of this version, or of another scene than `scene`; and as build_scene() does.
[[nodiscard]] nlohmann::ordered_json recording_block(const std::filesystem::path& recording,
                                                     const std::filesystem::path& scene,
                                                     std::uint64_t max_memory);

}  // namespace ist::cli
