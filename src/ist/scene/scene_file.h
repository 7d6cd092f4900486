#pragma once

#include "ist/base/api.h"
#include "ist/scene/scene.h"

namespace ist {

/// Reads a scene (TOML, see the README for every key). Relative paths are from the file's folder.
/// Throws kInputInvalid, naming file, line and remedy: for what is no TOML, keys that are unknown
/// or missing, values of the wrong kind or without sense, and files that are not there.
[[nodiscard]] IST_API Scene read_scene(const std::filesystem::path& file);

}  // namespace ist
