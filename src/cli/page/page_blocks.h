#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "answers/bodies.h"
#include "answers/occlusion/bite_maker.h"

namespace ist::cli {

/// Returns the data of a page of a kind, with no bodies yet.
[[nodiscard]] nlohmann::ordered_json empty_block(const char* kind);

/// Returns a body as the page's data holds it: its role, name and tree file, in base64.
[[nodiscard]] nlohmann::ordered_json body_block(const char* role, const std::string& name,
                                                const SphereTree& tree);

struct NamedTree {
  std::string name;
  SphereTree tree;
};
/// Returns the same tree without the name of its file.
[[nodiscard]] SphereTree without_name(const SphereTree& tree);

/// Returns the data of a page that shows two bodies, or one alone.
[[nodiscard]] nlohmann::ordered_json bodies_block(const NamedTree& fixed, const NamedTree& moving,
                                                  const Eigen::Isometry3d& pose);
[[nodiscard]] nlohmann::ordered_json body_alone_block(const NamedTree& body);

/// Returns the data of a page that shows an occlusion: the page measures it again, to the same
/// bits.
[[nodiscard]] nlohmann::ordered_json bite_block(const answers::Bodies& bodies,
                                                const answers::Bite& bite,
                                                const answers::BiteQuestions& questions);

/// Whether the page can ask all that was asked: it knows no sides, midlines, labels and
/// regions.
[[nodiscard]] bool page_shows(const answers::BiteQuestions& questions);

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
