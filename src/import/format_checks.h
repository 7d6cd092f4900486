#pragma once

#include <string>
#include <string_view>

#include "import/scene_format.h"

namespace ist::import {

/// Refuses a glTF that assimp 5.2 would read otherwise than it is meant, and says why: another
/// version, an extension that changes the geometry, skins, morph targets, sparse accessors, numbers
/// of a type or a place that it takes for another one.
/// Gives rotations of nodes that were rounded the length 1: it changes the content, if it must.
void check_gltf(std::string& content);

/// Throws a Refusal for an X3D, AMF or COLLADA that assimp 5.2 would misread in silence. Other
/// formats pass. check_gltf() checks a glTF.
/// Returns the unit that an X3D or AMF states; an unknown one for other formats.
StatedUnit check_xml(std::string_view format, std::string_view content);

}  // namespace ist::import
