#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "answers/occlusion/labels/label_files.h"
#include "ist/mesh/format/mesh_readers.h"
#include "ist/mesh/format/ply_body.h"

namespace ist::answers {
namespace {

bool is_label(const PlyProperty& property) {
  std::string name(property.name);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return name.find("label") != name.npos || name.find("tooth") != name.npos;
}

// Returns the property that labels faces, or else the property that labels vertices.
const PlyProperty& label_property(const PlyHeader& header, const std::filesystem::path& file) {
  for (const std::string_view element_name : {"face", "vertex"}) {
    const PlyProperty* label = nullptr;
    for (const PlyElement& element : header.elements) {
      if (element.name != element_name) continue;
      for (const PlyProperty& property : element.properties) {
        if (!is_label(property)) continue;
        if (label != nullptr) {
          refuse_labels(file, fmt::format("'{}' and '{}' may both be the label of a {}: keep one",
                                          label->name, property.name, element_name));
        }
        label = &property;
      }
    }
    if (label == nullptr) continue;
    if (label->count_type != nullptr || !label->type->is_integer) {
      refuse_labels(file, fmt::format("the property '{}' of a {} is not one whole number: declare "
                                      "it as int",
                                      label->name, element_name));
    }
    return *label;
  }
  refuse_labels(file, "no property of faces or vertices is named label or tooth");
}

// Reads the elements of a PLY that has been checked, so that each index names a vertex.
class LabelReader {
 public:
  LabelReader(const std::filesystem::path& file, const PlyProperty& label, ToothNumbers numbers)
      : file_(file), label_(label), numbers_(numbers) {}

  template <class Body>
  ToothLabels read(Body body, const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        body.begin(element, i);
        read_instance(body, element, i);
      }
    }
    for (const Triangle& t : corners_) {
      labels_.push_back(
          tooth_of_corners(of_vertices_[t[0]], of_vertices_[t[1]], of_vertices_[t[2]]));
    }
    return std::move(labels_);
  }

 private:
  template <class Body>
  void read_instance(Body& body, const PlyElement& element, std::uint64_t index) {
    std::vector<std::uint32_t> corners;
    std::int64_t label = -1;
    for (const PlyProperty& property : element.properties) {
      const std::int64_t count = property.count_type ? body.integer(property.count_type) : 1;
      if (&property == &label_) {
        label = body.integer(property.type);
        if (!is_tooth_number(label, numbers_)) {
          refuse_tooth_number(label, numbers_,
                              fmt::format("{}: {} {}", file_.string(), element.name, index));
        }
        continue;
      }
      for (std::int64_t i = 0; i < count; ++i) {
        if (property.role == PlyRole::kCorners) {
          corners.push_back(static_cast<std::uint32_t>(body.integer(property.type)));
        } else {
          body.skip(property.type);
        }
      }
    }
    if (element.name == "vertex" && label >= 0) of_vertices_.push_back(static_cast<int>(label));
    if (element.name != "face") return;
    if (label >= 0) {
      labels_.insert(labels_.end(), corners.size() - 2, static_cast<int>(label));
    } else if (corners.size() == 3) {
      corners_.push_back({corners[0], corners[1], corners[2]});
    } else {
      refuse_labels(file_, fmt::format("face {} has {} corners, and labels of vertices need three: "
                                       "triangulate the mesh, or label its faces",
                                       index, corners.size()));
    }
  }

  const std::filesystem::path& file_;
  const PlyProperty& label_;
  ToothNumbers numbers_;
  ToothLabels labels_;
  std::vector<int> of_vertices_;
  std::vector<Triangle> corners_;  // of all faces, if vertices have labels
};

}  // namespace

ToothLabels labels_of_ply(const std::filesystem::path& file, ToothNumbers numbers) {
  const std::string content = text_of(file), name = file.string();
  (void)read_ply(content, name);
  TextReader reader(content, name);
  const PlyHeader header = read_ply_header(reader);
  const PlyProperty& label = label_property(header, file);
  return with_ply_body(reader, header, content, name, [&](auto body) {
    return LabelReader(file, label, numbers).read(body, header);
  });
}

}  // namespace ist::answers
