#pragma once

#include <assimp/IOSystem.hpp>
#include <filesystem>
#include <string>
#include <string_view>

#include "import/placed_polygons.h"

namespace ist::import {

/// Gives assimp the content in memory as the main file, and other files only if they lie in its
/// folder or below: regular files, for reading, up to 1 GiB. Links out of the folder lead nowhere.
class SideFiles : public Assimp::IOSystem {
 public:
  /// `extension` tells assimp the format, whatever the file's own name is.
  SideFiles(const Input& input, std::string_view extension);

  /// Returns assimp's name for the main file.
  [[nodiscard]] const std::string& main_file() const { return main_; }
  /// Returns the last side file that could not be opened; an empty text for none.
  [[nodiscard]] const std::string& missing() const { return missing_; }

  bool Exists(const char* file) const override;
  [[nodiscard]] char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

 private:
  [[nodiscard]] std::filesystem::path allowed(std::string_view file) const;

  const Input& input_;
  std::filesystem::path folder_;  // canonical
  std::string main_, missing_;
};

}  // namespace ist::import
