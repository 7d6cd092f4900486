#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ist/query/results.h"

namespace ist::answers {

/// A contact of a bite, as its JSON holds it. Lengths are in mesh units, places in fixed
/// coordinates.
struct RecordedContact {
  std::size_t number = 0;                 ///< from 1
  bool on_fixed = true,                   ///< whether it has a region of the fixed body
      on_moving = true;                   ///< and of the moving one
  double area = 0, overlap = 0;           ///< units²
  double depth_integral = 0;              ///< units³
  double share = 0;                       ///< 0 to 1
  double least_distance = 0;              ///< signed
  Eigen::Vector3d centre, closest;        ///< of the area, and of the least distance
  int fixed_tooth = 0, moving_tooth = 0;  ///< 0: none

  /// Returns how deep the contact is, 0 if its surfaces do not overlap.
  [[nodiscard]] double depth() const { return least_distance < 0 ? -least_distance : 0; }
};

/// The measures of a tooth.
struct RecordedTooth {
  int number = 0;
  double area = 0, share = 0;            ///< units², 0 to 1
  std::optional<double> least_distance;  ///< empty beyond the reach
};

/// The measures of one body.
struct RecordedBody {
  std::string name, hash;              ///< of the file; the hash is empty if it is not known
  std::size_t vertices = 0;            ///< of the mesh
  Eigen::AlignedBox3d box;             ///< fixed coordinates
  double area = 0, overlap = 0;        ///< of all contact regions, and inside the other body
  double depth_integral = 0;           ///< units³
  std::optional<double> deepest;       ///< depth of the deepest vertex, if it is known
  std::vector<double> areas;           ///< for each limit of the preset
  std::vector<double> side, fore_aft;  ///< shares of both sides, per cent; empty without contacts
  std::vector<RecordedTooth> teeth;    ///< by their numbers; empty without labels
};

/// The measures of a bite, as `ist occlusion -o FILE.json` writes them.
struct BiteRecord {
  std::string name;  ///< how messages call the bite
  std::string unit;
  bool unit_assumed = false;
  double units_per_mm = 1;
  std::string frame, numbering;  ///< empty if there is none
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double reach = 0, contact = 0, foundation = 0;  ///< mesh units
  std::vector<double> limits;                     ///< of the preset, micrometres
  std::vector<double> region;                     ///< six numbers, or empty: all counts
  std::string touch;
  DistanceInterval distance{0, 0};
  std::optional<DistanceInterval> depth;  ///< certain; empty for open bodies
  std::string warning;                    ///< why the numbers mean nothing; else empty
  std::pair<std::string, std::string> side_names, fore_aft_names;
  RecordedBody fixed, moving;
  std::vector<RecordedContact> contacts;  ///< by their numbers
};

/// Returns the record of a bite.
///
/// @param json json_of(Bite)
/// @param name how messages call it
///
/// Throws kInputInvalid with the name and the place of a key that is missing or holds something
/// else, and for a schema that this version does not know.
[[nodiscard]] BiteRecord record_of(const nlohmann::ordered_json& json, std::string_view name);

/// Reads the file of a bite. Throws kFileUnreadable, and kInputInvalid with the file and the place.
[[nodiscard]] BiteRecord read_bite(const std::filesystem::path& file);

}  // namespace ist::answers
