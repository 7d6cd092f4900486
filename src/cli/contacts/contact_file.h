#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

namespace ist::cli {

/// A leaf pair, or a contact point, as files hold it: fixed coordinates, mesh units.
struct ContactRow {
  enum class Kind : std::uint8_t { kLeafPair, kContact };

  std::size_t index = 0;  ///< of the pose
  Kind kind = Kind::kLeafPair;
  Eigen::Vector3d position;  ///< of a leaf pair, the centre of the fixed leaf's sphere
  double radius = 0;         ///< of that sphere; of a contact, of a disc as large as its weight
  std::optional<Eigen::Vector3d> moving_centre{};  ///< of a leaf pair
  std::optional<Eigen::Vector3d> normal{};         ///< of a contact, as the next two
  std::optional<double> depth{}, weight{};
};

/// A file of leaf pairs and contacts. It appears, complete, after commit().
class ContactFile {
 public:
  virtual ~ContactFile() = default;
  virtual void add(const ContactRow& row) = 0;
  virtual void commit() = 0;
};

/// Opens a file by its ending: .jsonl, an object a line; .csv, a row each; .vtp and .ply, points
/// with the arrays "index", "kind" (0 a leaf pair, 1 a contact), "radius", "normal", "depth" and
/// "weight" (NaN, and a normal of nothing, where a row has neither), in memory until commit().
/// Throws CLI::ValidationError for another ending, and kFileUnwritable.
[[nodiscard]] std::unique_ptr<ContactFile> open_contact_file(const std::filesystem::path& file);

/// Throws CLI::ValidationError for a name with another ending, before anything is done.
void check_contact_file(const std::filesystem::path& file);

}  // namespace ist::cli
