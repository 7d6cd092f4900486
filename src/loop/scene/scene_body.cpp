#include <fmt/format.h>

#include <cstdlib>
#include <utility>
#include <vector>

#include "ist/tree/sphere_tree.h"
#include "loop/scene/ranges.h"
#include "loop/scene/scene_parts.h"

namespace ist {
namespace {

using Kind = BuiltInShape::Kind;

constexpr std::string_view kShapes =
    R"("upper jaw", "lower jaw", "splint", "fossa", "box", "sphere" or "cylinder")";

std::optional<Kind> shape_kind(std::string_view name) {
  if (name == "upper jaw") return Kind::kUpperJaw;
  if (name == "lower jaw") return Kind::kLowerJaw;
  if (name == "box") return Kind::kBox;
  if (name == "sphere") return Kind::kSphere;
  if (name == "cylinder") return Kind::kCylinder;
  if (name == "splint") return Kind::kSplint;
  if (name == "fossa") return Kind::kFossa;
  return std::nullopt;
}

std::optional<Eigen::Vector3d> axis(std::string_view name) {
  constexpr std::string_view kAxes = "xyz";
  const bool turned = name.starts_with('-');
  if (turned) name.remove_prefix(1);
  if (name.size() != 1 || kAxes.find(name) == std::string_view::npos) return std::nullopt;
  const auto index = static_cast<Eigen::Index>(kAxes.find(name));
  return (turned ? -1.0 : 1.0) * Eigen::Vector3d::Unit(index);
}

void need_millimetres(TableReader& table, std::string_view shape, double unit) {
  if (unit == metres_in("mm")) return;
  table.fail("shape",
             fmt::format("a built-in {} is in millimetres, and the scene's unit is another", shape),
             R"(write unit = "mm")");
}

BuiltInShape read_shape(TableReader& table, double unit) {
  BuiltInShape shape{.kind = table.choice("shape", shape_kind, kShapes)};
  switch (shape.kind) {
    case Kind::kUpperJaw:
    case Kind::kLowerJaw:
      shape.seed = table.whole_number("seed", kSeed, shape.seed);
      need_millimetres(table, "jaw", unit);
      break;
    case Kind::kSplint:
      shape.seed = table.whole_number("seed", kSeed, shape.seed);
      shape.opening = table.number("opening", kOpening, shape.opening);
      need_millimetres(table, "splint", unit);
      break;
    case Kind::kFossa:
      shape.radius = table.number("radius", kLength);
      shape.thickness = table.number("thickness", kLength);
      break;
    case Kind::kBox:
      shape.size = table.vector("size", kLength);
      break;
    case Kind::kCylinder:
      shape.height = table.number("height", kLength);
      [[fallthrough]];
    case Kind::kSphere:
      shape.radius = table.number("radius", kLength);
      break;
  }
  return shape;
}

SceneBody read_body(TableReader& table, double unit) {
  table.may_have({"name", "file", "shape", "seed", "opening", "radius", "thickness", "size",
                  "height", "voxel_size", "spheres", "trust_normals", "quaternion", "translation",
                  "attachable", "script", "open"});
  SceneBody body;
  body.name = table.path();
  if (table.has("name")) body.name = table.text("name", "a name, which no other body has");
  if (body.name.empty()) table.fail("name", table.name() + " has an empty 'name'", "give a name");
  if (table.has("file") && table.has("shape")) {
    table.fail("shape", table.name() + " has both a 'file' and a 'shape'", "take out one of them");
  }
  bool is_tree = false;
  if (table.has("file")) {
    const std::filesystem::path file = read_path(table, "file");
    is_tree = is_tree_file(file);
    body.source = file;
  } else if (table.has("shape")) {
    body.source = read_shape(table, unit);
  } else {
    table.fail_missing("file", fmt::format("a mesh or a tree, or shape = {}", kShapes));
  }
  if (table.has("voxel_size")) {
    body.voxel_size = table.number("voxel_size", kLength);
    if (is_tree) {
      table.fail("voxel_size", "the file is a tree, which has its voxels", "take the key out");
    }
  }
  if (table.has("spheres")) {
    body.spheres =
        table.choice("spheres", sphere_policy, R"("simple", "table", "tight" or "slab")");
  }
  body.trust_normals = table.flag("trust_normals", false);
  body.rotation = table.rotation("quaternion");
  body.translation = table.vector("translation", kPlace, Eigen::Vector3d::Zero());
  body.attachable = table.flag("attachable", false);
  return body;
}

std::vector<SceneBody> read_fixed(TableReader& scene, double unit) {
  std::vector<SceneBody> bodies;
  for (TableReader& table : scene.table_or_tables("fixed")) {
    SceneBody body = read_body(table, unit);
    if (table.has("script")) {
      body.script_file = read_path(table, "script");
      body.script = read_script(body.script_file, unit);
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

std::vector<SceneBody> read_held(TableReader& scene, Scene& result) {
  std::vector<SceneBody> bodies;
  for (TableReader& table : scene.table_or_tables("held")) {
    bodies.push_back(read_body(table, result.unit));
    if (bodies.size() > 1) continue;
    if (table.has("origin")) result.origin = table.vector("origin", kPlace);
    if (!table.has("open")) continue;
    result.open = table.choice("open", axis, R"("x", "-x", "y", "-y", "z" or "-z")");
  }
  return bodies;
}

std::vector<SceneChange> read_changes(TableReader& scene) {
  std::vector<SceneChange> changes;
  if (!scene.has("changes")) return changes;
  for (TableReader& table : scene.tables("changes")) {
    SceneChange change;
    change.time = table.number("time", kInstant);
    const bool attach = table.has("attach"), release = table.has("release");
    if (attach && release) {
      table.fail("release", table.name() + " has both 'attach' and 'release'",
                 "take out one of them");
    }
    if (!attach && !release) table.fail_missing("attach", "it or 'release', the name of a body");
    change.attach = attach;
    change.body = table.text(attach ? "attach" : "release", "the name of a body");
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace

std::filesystem::path read_path(TableReader& table, std::string_view key) {
  constexpr std::string_view kVariable = "IST_DATA_DIR", kPrefix = "${IST_DATA_DIR}/";
  const std::string text = table.text(key, "the name of a file");
  std::filesystem::path file;
  if (text.starts_with(kPrefix)) {
    const char* folder = std::getenv(std::string(kVariable).c_str());
    if (folder == nullptr || *folder == '\0') {
      table.fail(key, fmt::format("'{}' needs {}, which is not set", key, kVariable),
                 "set it in the environment to the folder of the meshes");
    }
    file = std::filesystem::path(folder) / text.substr(kPrefix.size());
  } else if (text.find("${") != std::string::npos) {
    table.fail(key, fmt::format("'{}' names a variable in \"{}\"", key, text),
               fmt::format("only {}… at the beginning is known", kPrefix));
  } else {
    file = table.file().parent_path() / text;
  }
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(file, unknown)) {
    table.fail(key, fmt::format("there is no file {}", file.string()),
               fmt::format("check '{}'; a relative path starts at the scene's folder", key));
  }
  return file;
}

void read_bodies(TableReader& scene, Scene& result) {
  result.fixed = read_fixed(scene, result.unit);
  result.held = read_held(scene, result);
  result.changes = read_changes(scene);
}

}  // namespace ist
