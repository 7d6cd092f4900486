#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "answers/formats/format.h"
#include "ist/base/files.h"

namespace ist::cli {

/// The files of `-o`. All of them are opened before anything is measured, and appear together.
class OutputFiles {
 public:
  struct One {
    std::unique_ptr<OutputFile> file;
    answers::FileFormat format;
  };

  /// Opens the files. Throws a Refusal for an ending that is not among `writable`, for a name that
  /// is given twice, and for one of the `inputs`; and what require_writable() throws.
  OutputFiles(std::span<const std::filesystem::path> names,
              std::span<const answers::FileFormat> writable,
              std::initializer_list<std::filesystem::path> inputs);

  [[nodiscard]] const std::vector<One>& all() const { return files_; }
  /// Returns whether a file has one of the formats.
  [[nodiscard]] bool has(std::initializer_list<answers::FileFormat> formats) const;
  /// Completes all files, or none.
  void commit() const;

 private:
  std::vector<One> files_;
};

}  // namespace ist::cli
