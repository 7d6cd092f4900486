#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/bodies.h"
#include "ist/base/output_file.h"
#include "ist/query/contact.h"
#include "ist/query/contacts/contact_points.h"

namespace ist::cli {

/// Writes contacts in fixed coordinates, one JSON object a line: of each pose all leaf pairs, the
/// centres of their spheres, and then its contact points. The file is there, whole, after commit().
class ContactWriter {
 public:
  /// `bodies` must outlive it.
  ContactWriter(const std::filesystem::path& file, const Bodies& bodies);

  /// All contacts of a pose, in order. Of an answer that is not `complete` there are no points:
  /// they would be those of a part.
  void write(std::size_t index, const Eigen::Isometry3d& pose, std::span<const Contact> contacts,
             bool complete);
  void commit() { file_.commit(); }

 private:
  void add(const std::string& line);
  void flush();

  OutputFile file_;
  const Bodies& bodies_;
  std::vector<Ball> fixed_, moving_;
  ContactPoints points_;
  std::string lines_;  // not yet written
};

}  // namespace ist::cli
