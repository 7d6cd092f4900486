#pragma once

#include <string>

namespace ist::import {

/// Refuses a glTF that assimp 5.2 would read otherwise than it is meant, and says why: another
/// version, an extension that changes the geometry, skins, morph targets, sparse accessors, numbers
/// of a type or a place that it takes for another one.
/// Gives rotations of nodes that were rounded the length 1: it changes the content, if it must.
void check_gltf(std::string& content);

}  // namespace ist::import
