#pragma once

#include <string_view>

#include "import/scene_format.h"

namespace ist::import {

/// Throws a Refusal for an X3D, AMF or COLLADA that assimp 5.2 would misread in silence. Other
/// formats pass. check_gltf() checks a glTF.
/// Returns the unit that an X3D or AMF states; an unknown one for other formats.
StatedUnit check_xml(std::string_view format, std::string_view content);

}  // namespace ist::import
