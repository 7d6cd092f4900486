#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "answers/bodies.h"
#include "ist/query/results.h"
#include "ist/tree/sphere_tree.h"

/// The parts that the JSON of all answers shares. docs/command.md lists its keys.
namespace ist::answers {

/// Returns the name of a file without its folder, in the spelling of source_name(), and the hash of
/// its bytes. The unit is unknown. The hash of a pipe or a device is 0, because it can be read only
/// once.
///
/// Cost: reads the file, some 0.2 s a GB from memory. Throws kFileUnreadable.
[[nodiscard]] MeshSource source_of(const std::filesystem::path& file);

/// Returns {"name": …, "hash": 16 hexadecimal digits}. An unknown one is null.
[[nodiscard]] nlohmann::ordered_json json_of(const MeshSource& source);

/// Returns the unit's name, or null if it is unknown.
[[nodiscard]] nlohmann::ordered_json json_of(LengthUnit unit);

/// Returns the frame's name, or null if it is unknown.
[[nodiscard]] nlohmann::ordered_json json_of(PatientFrame frame);

/// Returns the voxel size of a tree, or null if it lacks voxels.
[[nodiscard]] nlohmann::ordered_json voxel_size_json(const SphereTree& tree);

/// Returns the 16 numbers of a pose, column by column.
[[nodiscard]] nlohmann::ordered_json pose_json(const Eigen::Isometry3d& pose);

/// Returns the three numbers of a point or a vector, or null.
[[nodiscard]] nlohmann::ordered_json point_json(const std::optional<Eigen::Vector3d>& point);

/// Returns the indices of two triangles, or null.
[[nodiscard]] nlohmann::ordered_json pair_json(const std::optional<TrianglePair>& pair);

/// The files that an answer is about, by their roles: `fixed`, `mesh`, `tree` and so on.
using NamedSources = std::vector<std::pair<std::string, MeshSource>>;

/// A unit that a command takes, and whether it is assumed.
struct TakenUnit {
  std::string name;
  bool assumed;
};

/// Returns the first line of --json: version, commit, subcommand, and the base name and the hash of
/// each file. The hash of a pipe or a device is null. With bodies the line also holds the unit of
/// the bodies or the taken one, the frame, and the voxel sizes. The size of a body without voxels
/// is null.
[[nodiscard]] nlohmann::ordered_json header_line(const std::string& subcommand,
                                                 const NamedSources& files);
[[nodiscard]] nlohmann::ordered_json header_line(const std::string& subcommand,
                                                 const NamedSources& files, const Bodies& bodies,
                                                 const std::optional<TakenUnit>& unit = {});

/// Returns JSON as text, on one line or indented. Each byte that is not UTF-8, as the name of a
/// file may hold, becomes U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace ist::answers
