#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "ist/tree/sphere_tree.h"

namespace ist::cli {

/// Returns the name of a mesh's file without its folder, as source_name() spells it, and the hash
/// of its bytes; the unit is unknown. A pipe or a device can be read only once, so its hash is 0.
///
/// Cost: reads the file, some 0.2 s a GB from memory. Throws kFileUnreadable.
[[nodiscard]] MeshSource source_of(const std::filesystem::path& file);

/// Returns {"name": …, "hash": 16 hexadecimal digits}; each is null where unknown.
[[nodiscard]] nlohmann::ordered_json json_of(const MeshSource& source);

/// Returns the unit's name, or null if it is unknown.
[[nodiscard]] nlohmann::ordered_json json_of(LengthUnit unit);

/// Returns the frame's name, or null if it is unknown.
[[nodiscard]] nlohmann::ordered_json json_of(PatientFrame frame);

}  // namespace ist::cli
