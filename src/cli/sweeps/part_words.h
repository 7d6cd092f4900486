#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "ist/base/progress.h"
#include "sweep/sweep.h"

namespace ist::cli {

/// Returns ascending numbers as people write them: "0-3, 7".
[[nodiscard]] std::string ranges(const std::vector<std::uint64_t>& numbers);

/// Returns a time as people read it: "12.3 s", "5 min" or "2.1 h".
[[nodiscard]] std::string duration_text(double seconds);

/// The message of parts that are not tried again.
[[nodiscard]] std::string given_up_text(const std::vector<std::uint64_t>& parts);

/// Estimates the rest of a share by the mean time of the parts that were made.
class ShareEstimate {
 public:
  /// @param parts of the share
  explicit ShareEstimate(std::uint64_t parts) : left_(parts), parts_(parts) {}

  /// Counts a part that was made, and one that took no time.
  void add(double seconds);
  void skip() { --left_; }
  /// "3 of 16 done, about 5 min left"
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t left_, parts_, made_ = 0;
  double seconds_ = 0;
};

/// How the parts of a folder stand.
struct FolderStatus {
  std::vector<std::uint64_t> missing, given_up, damaged, running;
  std::uint64_t done = 0;
  double seconds = 0;  ///< that the parts took together, as far as known
};

/// Looks at each part, with `verify` at each byte. Throws what SweepFolder does.
[[nodiscard]] FolderStatus status_of(const Sweep& sweep, const std::filesystem::path& folder,
                                     bool verify, const Proceed& proceed);

/// Prints the first line of --json, which names the sweep file and the trees, and then the result.
void print_json(const Sweep& sweep, const nlohmann::ordered_json& result);

/// Prints the sweep and how its parts stand.
void print_status(const Sweep& sweep, const FolderStatus& status, bool json);

}  // namespace ist::cli
