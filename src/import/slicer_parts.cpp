#include "import/slicer_parts.h"

#include <algorithm>
#include <pugixml.hpp>
#include <string>

#include "import/placed_polygons.h"

namespace ist::import {
namespace {

// Returns whether a volume of that type is part of the body. Both slicers take an unknown type for
// the body.
bool is_body_type(std::string_view type, std::string_view place) {
  if (type == "NegativeVolume" || type == "negative_part")
    refuse(ErrorCode::kNotAMesh, place,
           "a negative volume cuts the body: export the plate as STL in the slicer");
  constexpr std::string_view kOthers[] = {"ParameterModifier", "SupportBlocker",
                                          "SupportEnforcer",   "modifier_part",
                                          "support_blocker",   "support_enforcer"};
  return std::find(std::begin(kOthers), std::end(kOthers), type) == std::end(kOthers);
}

// The type of a volume of PrusaSlicer or Slic3r. Older files only say that it is a modifier.
std::string type_of(const pugi::xml_node& volume) {
  std::string type = "ModelPart";
  for (const pugi::xml_node& data : volume.children("metadata")) {
    const std::string_view key = data.attribute("key").value(),
                           value = data.attribute("value").value();
    if (key == "volume_type") return std::string(value);
    if (key == "modifier" && value == "1") type = "ParameterModifier";
  }
  return type;
}

pugi::xml_document settings(ZipParts& archive, const char* name) {
  pugi::xml_document document;
  const auto text = archive.part(name);
  if (text && !document.load_buffer(text->data(), text->size()))
    refuse(ErrorCode::kNotAMesh, name,
           "the slicer's settings are no XML; export the plate as STL in the slicer");
  return document;
}

}  // namespace

SlicerParts::SlicerParts(ZipParts& archive) {
  constexpr const char *kPrusa = "Metadata/Slic3r_PE_model.config",
                       *kBambu = "Metadata/model_settings.config";
  const pugi::xml_document prusa = settings(archive, kPrusa), bambu = settings(archive, kBambu);
  for (const pugi::xml_node& object : prusa.child("config").children("object"))
    for (const pugi::xml_node& volume : object.children("volume"))
      if (!is_body_type(type_of(volume), kPrusa)) {
        const pugi::xml_attribute first = volume.attribute("firstid"),
                                  last = volume.attribute("lastid");
        if (!first || !last)
          refuse(ErrorCode::kNotAMesh, kPrusa,
                 "a modifier does not name its triangles (firstid, lastid): export the plate as "
                 "STL in the slicer");
        left_out_[object.attribute("id").as_uint()].push_back(
            {first.as_ullong(), last.as_ullong()});
      }
  for (const pugi::xml_node& object : bambu.child("config").children("object"))
    for (const pugi::xml_node& part : object.children("part"))
      if (!is_body_type(part.attribute("subtype").value(), kBambu))
        left_out_parts_.emplace_back(object.attribute("id").as_uint(),
                                     part.attribute("id").as_uint());
}

bool SlicerParts::is_body(std::uint32_t object, std::size_t triangle) const {
  const auto found = left_out_.find(object);
  return found == left_out_.end() ||
         std::none_of(found->second.begin(), found->second.end(), [&](const Range& range) {
           return range.first <= triangle && triangle <= range.last;
         });
}

bool SlicerParts::is_body_part(std::uint32_t object, std::uint32_t component) const {
  return std::find(left_out_parts_.begin(), left_out_parts_.end(), std::pair(object, component)) ==
         left_out_parts_.end();
}

}  // namespace ist::import
