#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "answers/bodies.h"
#include "ist/query/query.h"
#include "ist/tree/bounds.h"

namespace ist::cli {

/// Returns the endings of contact files with the programs that open them.
[[nodiscard]] std::string contact_endings();

/// Throws a Refusal if the name of the file has no ending of a contact file.
void check_contact_file(const std::filesystem::path& file);

class ContactFile;

/// Writes leaf pairs and contacts, in fixed coordinates and mesh units. The file appears, complete,
/// after commit().
///
/// Its ending chooses the format. A .jsonl holds an object a line, and a .csv a row each. A .vtp or
/// a .ply holds points with the arrays "index", "kind" (0 a leaf pair, 1 a contact), "radius",
/// "normal", "depth" and "weight", and takes memory until commit(). A leaf pair has the depth and
/// the weight NaN, and the normal 0.
class ContactWriter {
 public:
  /// Opens the file. `bodies` must outlive the writer. Throws a Refusal for another ending, and
  /// kFileUnwritable.
  ContactWriter(const std::filesystem::path& file, const answers::Bodies& bodies);
  ~ContactWriter();

  /// Writes all leaf pairs of a pose, in order, as the centres of their spheres, then its contacts.
  /// Leaves the contacts out if the answer is not `complete`, because a part of the leaf pairs
  /// would give other ones.
  void write(std::size_t index, const Eigen::Isometry3d& pose, std::span<const LeafPair> leaf_pairs,
             bool complete);
  void commit();

 private:
  std::unique_ptr<ContactFile> file_;
  const answers::Bodies& bodies_;
  std::vector<Ball> fixed_, moving_;
  Query query_;
  ContactManifold points_;
};

}  // namespace ist::cli
