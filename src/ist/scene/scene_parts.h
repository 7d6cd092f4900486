#pragma once

#include "ist/scene.h"
#include "ist/scene/table_reader.h"

namespace ist {

// Readers of a scene file's parts, from the outermost table `scene` into `result`, whose unit is
// known. All throw kInputInvalid with file, line and remedy.

/// Reads the tables `fixed` and `held`, including `held.open`.
void read_bodies(TableReader& scene, Scene& result);

/// Reads the table `device`.
void read_device(TableReader& scene, Scene& result);

/// Reads the tables below `effects`. A missing table leaves its effect out.
void read_effects(TableReader& scene, Scene& result);

/// Reads the path of a regular file: relative to the scene's folder, or, as ${IST_DATA_DIR}/…, to
/// the folder in that environment variable.
[[nodiscard]] std::filesystem::path read_path(TableReader& table, std::string_view key);

/// Checks the values of a scene that a program may have made: the conditions that read_scene()
/// checks of a file, as far as the library depends on them. Throws kInputInvalid (fail_at).
void check_scene(const Scene& scene);

}  // namespace ist
