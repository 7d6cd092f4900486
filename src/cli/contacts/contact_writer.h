#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "cli/bodies.h"
#include "cli/contacts/contact_file.h"
#include "ist/query/query.h"
#include "ist/tree/bounds.h"

namespace ist::cli {

/// Writes leaf pairs and contacts in fixed coordinates: for each pose all leaf pairs, as the
/// centres of their spheres, then its contacts. The file appears, complete, after commit().
class ContactWriter {
 public:
  /// Opens the file. `bodies` must outlive the writer.
  ContactWriter(const std::filesystem::path& file, const Bodies& bodies);

  /// Writes all leaf pairs of a pose, in order, then its contacts; without contacts if the answer
  /// is not `complete`, because a part of the leaf pairs would give other ones.
  void write(std::size_t index, const Eigen::Isometry3d& pose, std::span<const LeafPair> leaf_pairs,
             bool complete);
  void commit() { file_->commit(); }

 private:
  std::unique_ptr<ContactFile> file_;
  const Bodies& bodies_;
  std::vector<Ball> fixed_, moving_;
  Query query_;
  ContactManifold points_;
};

}  // namespace ist::cli
