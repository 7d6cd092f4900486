#include "sweep/sweep_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "ist/base/checksum.h"
#include "ist/base/error.h"
#include "ist/base/throw_error.h"
#include "sweep/npy_file.h"
#include "sweep/start_mark.h"
#include "sweep/sweep_record.h"

namespace ist {
namespace {

// A folder that its user may not write to is bad input; a full disk is not.
[[noreturn]] void fail_unwritable(const std::filesystem::path& folder, int cause) {
  const std::string text =
      fmt::format("{}: cannot write to the folder: {}: name a folder that you may write to",
                  folder.string(), std::strerror(cause));
  if (cause == EACCES || cause == EROFS || cause == ENOTDIR || cause == EEXIST) {
    throw Error(ErrorCode::kInputInvalid, text);
  }
  throw UnwritableFile(text, cause);
}

}  // namespace

SweepFolder::SweepFolder(std::filesystem::path folder, SweepIdentity identity,
                         const RowLayout& layout, Access access)
    : folder_(std::move(folder)), identity_(std::move(identity)), layout_(layout) {
  const std::filesystem::path record = folder_ / "sweep.json";
  std::error_code unknown;
  if (access == Access::kWrite) {
    std::filesystem::create_directories(folder_, unknown);
    if (unknown) fail_unwritable(folder_, unknown.value());
    require_writable();
  }
  if (access == Access::kWrite && !std::filesystem::exists(record, unknown)) {
    const std::string text = json_of(identity_, layout);
    // Who begins at the same time writes the same bytes.
    OutputFile file(record);
    file.write(text.data(), text.size());
    file.commit();
  }
  require_same_sweep(record, identity_);
}

void SweepFolder::require_writable() const {
  if (::access(folder_.c_str(), W_OK | X_OK) != 0) fail_unwritable(folder_, errno);
}

std::filesystem::path SweepFolder::part_file(std::uint64_t part) const {
  return folder_ / fmt::format("part-{:06}.npy", part);
}

std::filesystem::path SweepFolder::record_file(std::uint64_t part) const {
  return folder_ / fmt::format("part-{:06}.json", part);
}

std::filesystem::path SweepFolder::mark_file(std::uint64_t part, int start) const {
  return folder_ / fmt::format("part-{:06}.start-{}", part, start);
}

std::uint64_t SweepFolder::bytes_of_part(std::uint64_t part) const {
  const std::uint64_t rows = identity_.rows_of(part);
  return npy_header(layout_, rows).size() + rows * layout_.bytes;
}

PartStatus SweepFolder::look(std::uint64_t part) const {
  PartStatus status;
  std::error_code missing;
  const std::uint64_t bytes = std::filesystem::file_size(part_file(part), missing);
  if (missing) {
    const PartStarts starts = starts_of(*this, part);
    status.running = starts.live;
    status.starts = starts.lost + (starts.live ? 1 : 0);
    if (starts.lost >= kMostStarts) status.state = PartState::kGivenUp;
    return status;
  }
  if (!std::filesystem::exists(record_file(part), missing)) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: the part has no record beside it: remove it to make it anew",
                part_file(part).string());
  }
  const PartRecord record = read_part_record(record_file(part));
  if (record.sweep != identity_.hash || record.part != part ||
      record.rows != identity_.rows_of(part)) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: the part is of another sweep, {}: remove it, and its record, to make it anew",
                part_file(part).string(), record.sweep);
  }
  status.seconds = record.seconds;
  status.checksum = record.checksum;
  status.state = bytes == bytes_of_part(part) ? PartState::kDone : PartState::kDamaged;
  return status;
}

PartStatus SweepFolder::verify(std::uint64_t part) const {
  PartStatus status = look(part);
  if (status.state == PartState::kDone && hash_of_file(part_file(part)) != status.checksum) {
    status.state = PartState::kDamaged;
  }
  return status;
}

void fail_damaged(const SweepFolder& folder, std::uint64_t part) {
  throw_error(ErrorCode::kInputInvalid,
              "{}: the part is cut off or damaged: remove it to make it anew",
              folder.part_file(part).string());
}

}  // namespace ist
