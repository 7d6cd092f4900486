#pragma once

#include <string_view>

namespace ist::import {

/// Throws a Refusal for an X3D, AMF or COLLADA that assimp 5.2 would misread in silence. Other
/// formats pass. check_gltf() checks a glTF.
void check_xml(std::string_view format, std::string_view content);

}  // namespace ist::import
