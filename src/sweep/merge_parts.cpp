#include "sweep/merge_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <system_error>

#include "ist/base/checksum.h"
#include "ist/base/error.h"
#include "ist/base/files.h"
#include "sweep/npy_file.h"
#include "sweep/start_mark.h"
#include "sweep/sweep_record.h"

namespace ist {
namespace {

constexpr std::uint64_t kMergedAtOnce = 1 << 16;

using Reached = std::function<void(std::uint64_t rows)>;

std::filesystem::path table_file(const SweepFolder& folder) { return folder.path() / "rows.npy"; }
std::filesystem::path manifest_file(const SweepFolder& folder) {
  return folder.path() / "manifest.json";
}

// Writes rows.npy and its checksum.
class Table {
 public:
  Table(const SweepFolder& folder, const RowLayout& layout) : npy_(table_file(folder)) {
    const std::string header = npy_header(layout, folder.identity().rows);
    add(std::as_bytes(std::span(header)));
  }

  void add(std::span<const std::byte> bytes) {
    npy_.write(bytes.data(), bytes.size());
    hash_.add(bytes.data(), bytes.size());
  }

  // Writes the manifest, and gives both files their names.
  void commit(const SweepFolder& folder, const RowLayout& layout,
              const std::vector<std::string>& checksums) {
    OutputFile manifest(manifest_file(folder));
    const std::string text = manifest_of(folder.identity(), layout, checksums, hash_.text());
    manifest.write(text.data(), text.size());
    const std::array<OutputFile*, 2> files = {&npy_, &manifest};
    OutputFile::commit_all(files);
  }

 private:
  OutputFile npy_;
  Checksum hash_;
};

// Reads the rows of a part into the table. Compares the part's header, row numbers and checksum.
void merge_part(const SweepFolder& folder, const RowLayout& layout, std::uint64_t part,
                const std::string& checksum, Table& table, const Reached& proceed) {
  const std::uint64_t rows = folder.identity().rows_of(part);
  const std::string header = npy_header(layout, rows);
  InputFile file(folder.part_file(part));
  Checksum hash;
  std::string begin(header.size(), ' ');
  if (file.read(begin.data(), begin.size()) < begin.size() || begin != header) {
    fail_damaged(folder, part);
  }
  hash.add(begin.data(), begin.size());
  std::vector<std::byte> block;
  std::uint64_t index = part * folder.identity().rows_per_part;
  for (std::uint64_t done = 0; done < rows;) {
    const std::uint64_t count = std::min(kMergedAtOnce, rows - done);
    block.resize(count * layout.bytes);
    if (file.read(block.data(), block.size()) < block.size()) fail_damaged(folder, part);
    hash.add(block.data(), block.size());
    for (std::size_t row = 0; row < count; ++row, ++index) {
      if (std::memcmp(block.data() + row * layout.bytes, &index, sizeof(index)) != 0) {
        fail_damaged(folder, part);
      }
    }
    table.add(block);
    done += count;
    proceed(part * folder.identity().rows_per_part + done);
  }
  if (hash.text() != checksum) fail_damaged(folder, part);
}

// Returns the checksum of rows.npy.
std::string checksum_of_table(const SweepFolder& folder, const RowLayout& layout,
                              const Reached& proceed) {
  InputFile file(table_file(folder));
  Checksum hash;
  std::vector<std::byte> block(kMergedAtOnce * layout.bytes);
  for (std::uint64_t rows = 0;; rows += kMergedAtOnce) {
    const std::size_t bytes = file.read(block.data(), block.size());
    hash.add(block.data(), bytes);
    if (bytes < block.size()) return hash.text();
    proceed(std::min(rows + kMergedAtOnce, folder.identity().rows));
  }
}

// Whether rows.npy is the table of the parts with these checksums, as its manifest says.
bool has_table(const SweepFolder& folder, const RowLayout& layout,
               const std::vector<std::string>& checksums, TableCheck check,
               const Reached& proceed) {
  std::error_code missing;
  const std::uint64_t rows = folder.identity().rows;
  const std::uint64_t bytes = std::filesystem::file_size(table_file(folder), missing);
  if (missing || bytes != npy_header(layout, rows).size() + rows * layout.bytes) return false;
  if (!std::filesystem::is_regular_file(manifest_file(folder), missing)) return false;
  const std::string manifest = InputFile(manifest_file(folder)).read_rest();
  const std::string npy = table_checksum_in(manifest);
  if (manifest != manifest_of(folder.identity(), layout, checksums, npy)) return false;
  return check == TableCheck::kSize || checksum_of_table(folder, layout, proceed) == npy;
}

}  // namespace

MergeResult merge_parts(const SweepFolder& folder, const RowLayout& layout, TableCheck check,
                        const Proceed& proceed) {
  MergeResult result;
  std::vector<std::string> checksums;
  const std::uint64_t parts = folder.identity().parts(), all = folder.identity().rows;
  for (std::uint64_t part = 0; part < parts; ++part) {
    const PartStatus status = folder.look(part);
    if (status.state == PartState::kMissing) result.missing.push_back(part);
    if (status.state == PartState::kGivenUp) result.given_up.push_back(part);
    if (status.state == PartState::kDamaged) fail_damaged(folder, part);
    checksums.push_back(status.checksum);
  }
  if (!result.missing.empty() || !result.given_up.empty()) return result;
  const Reached go_on = [&](std::uint64_t rows) {
    if (!proceed || proceed(static_cast<double>(rows) / static_cast<double>(all))) return;
    throw Error(ErrorCode::kCancelled, "the merge was ended by its caller");
  };
  const auto ended = [&](MergeOutcome outcome) {
    result.outcome = outcome;
    result.rows = outcome == MergeOutcome::kBusy ? 0 : all;
    return result;
  };
  if (has_table(folder, layout, checksums, check, go_on)) return ended(MergeOutcome::kWasThere);
  folder.require_writable();
  const MergeMark mark(folder);
  if (!mark.is_held()) return ended(MergeOutcome::kBusy);
  // Another process may have merged after the look above and before the mark.
  if (has_table(folder, layout, checksums, check, go_on)) return ended(MergeOutcome::kWasThere);
  Table table(folder, layout);
  for (std::uint64_t part = 0; part < parts; ++part) {
    merge_part(folder, layout, part, checksums[part], table, go_on);
  }
  table.commit(folder, layout, checksums);
  return ended(MergeOutcome::kMerged);
}

void fail_merging(const SweepFolder& folder) {
  throw Error(ErrorCode::kPartBusy,
              fmt::format("{}: another process is merging the parts now: wait for it",
                          table_file(folder).string()));
}

}  // namespace ist
