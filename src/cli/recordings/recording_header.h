#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ist/haptics/simulation.h"
#include "ist/scene.h"

namespace ist::cli {

/// The first line of a recording: the format's version, the program's, the scene's text, the time
/// step and the bodies with the hashes of their files.
class RecordingHeader {
 public:
  /// Reads the bodies' files for their hashes. Throws kFileUnreadable.
  RecordingHeader(const Scene& scene, const Simulation& simulation);
  ~RecordingHeader();
  RecordingHeader(RecordingHeader&&) noexcept;
  RecordingHeader& operator=(RecordingHeader&&) noexcept;

  /// The line, without its end.
  [[nodiscard]] std::string line() const;
  /// The names of the bodies, by their numbers.
  [[nodiscard]] std::vector<std::string> body_names() const;
  /// The length of a tick, s.
  [[nodiscard]] double dt() const;

  /// Checks that a line is a header of this version of the format. Throws kInputInvalid with `file`
  /// and a remedy.
  static void check_format(const nlohmann::json& recorded, const std::filesystem::path& file);
  /// Checks the header of a recording that this scene is to replay. Throws as check_format() does,
  /// and for another scene and bodies whose files have changed.
  void check(const nlohmann::json& recorded, const std::filesystem::path& file) const;

 private:
  std::unique_ptr<nlohmann::ordered_json> line_;
};

}  // namespace ist::cli
