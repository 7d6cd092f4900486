#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace ist {

/// The output of a run of ist-import, and its end.
struct ImportRun {
  enum class End : std::uint8_t {
    kUnknown,  ///< another part of the host has waited for it
    kExit,     ///< with the exit code `code`
    kSignal,   ///< by the signal `code`
    kTooLate,  ///< killed at the end of its time
    kTooMuch,  ///< killed after 1 GiB of output
  };
  std::string answer;
  End end = End::kUnknown;
  int code = 0;
};

/// Runs the program with the content as its stdin and the file's path as its argument, and takes
/// its stdout. It gets no environment but LC_ALL=C, a process group of its own, and `time` on the
/// clock. Errors: kFileUnreadable if it cannot be started; kCancelled.
[[nodiscard]] ImportRun run_importer(const std::filesystem::path& importer,
                                     std::string_view content, const std::filesystem::path& file,
                                     std::chrono::milliseconds time = std::chrono::seconds(120));

}  // namespace ist
