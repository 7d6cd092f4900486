#pragma once

#include "ist/scene/scene.h"
#include "ist/scene/table_reader.h"

namespace ist {

/// The parts of a scene file, each read from the table `scene`, which is the outermost one, into
/// `result`, whose unit is known. All throw kInputInvalid with file, line and remedy.

/// The tables `fixed` and `held`, with the direction in which the held body is freed.
void read_bodies(TableReader& scene, Scene& result);

/// The table `device`.
void read_device(TableReader& scene, Scene& result);

/// The tables below `effects`. A table that is not there is an effect that is not.
void read_effects(TableReader& scene, Scene& result);

/// The regular file that a key names: relative to the scene's folder, or, by ${IST_DATA_DIR}/…, in
/// the folder which that variable of the environment names.
[[nodiscard]] std::filesystem::path read_path(TableReader& table, std::string_view key);

}  // namespace ist
