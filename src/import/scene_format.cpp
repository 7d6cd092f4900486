#include "import/scene_format.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "ist/mesh/format/other_formats.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/import/import_message.h"

namespace ist::import {

StatedUnit unit_of_name(std::string_view name) {
  struct NamedUnit {
    std::string_view name, other_name;
    StatedUnit unit;
  };
  constexpr NamedUnit kUnits[] = {
      {"micron", "micrometer", {LengthUnit::kMicrometre, 1}},
      {"millimeter", "millimeters", {LengthUnit::kMillimetre, 1}},
      {"centimeter", "centimeters", {LengthUnit::kMillimetre, 10}},
      {"inch", "inches", {LengthUnit::kInch, 1}},
      {"foot", "feet", {LengthUnit::kInch, 12}},
      {"meter", "meters", {LengthUnit::kMetre, 1}},
  };
  for (const NamedUnit& unit : kUnits)
    if (same_word(name, unit.name) || same_word(name, unit.other_name)) return unit.unit;
  return {};
}

std::string scene_format(const Input& input) {
  const OtherFormat* const format = other_format(input.content);
  const std::string_view ending = format != nullptr ? format->ending : imported_ending(input.path);
  if (ending.empty())
    refuse(ErrorCode::kNotAMesh, "",
           fmt::format("the content is in no format that ist-import reads; {}", kConvert));
  return std::string(ending);
}

Eigen::Affine3d root_turn(std::string_view format) {
  Eigen::Affine3d turn = Eigen::Affine3d::Identity();
  // assimp turns z, which is up in a 3DS, to y. An STL of the same scene keeps z.
  if (format == "3ds") turn.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

StatedUnit unit_of_scene(std::string_view format, const aiScene& scene) {
  // The standard of glTF says metres. assimp converts a COLLADA to metres, with y up.
  if (format == "glb" || format == "gltf" || format == "dae") return {LengthUnit::kMetre, 1};
  float factor = 0;
  if (format != "fbx" || scene.mMetaData == nullptr ||
      !scene.mMetaData->Get("UnitScaleFactor", factor) || !std::isfinite(factor) || factor <= 0)
    return {};
  // The factor of an FBX is the centimetres of its unit. Its decimals make 0.1 cm exactly 1 mm.
  const std::optional<double> centimetres =
      number_of(fmt::format("{}", factor), Precision::kDouble);
  return {LengthUnit::kMillimetre, 10 * centimetres.value()};
}

}  // namespace ist::import
