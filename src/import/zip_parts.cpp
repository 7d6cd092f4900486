#include "import/zip_parts.h"

#include <fmt/format.h>
#include <zip.h>

#include "import/placed_polygons.h"
#include "ist/base/printable.h"
#include "ist/mesh/format/percent.h"

namespace ist::import {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 29;

}  // namespace

ZipParts::ZipParts(std::string_view content) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(content.data(), content.size(), 0, &error);
  if (source != nullptr) archive_ = zip_open_from_source(source, ZIP_RDONLY, &error);
  if (archive_ != nullptr) return;
  const std::string cause = zip_error_strerror(&error);
  zip_source_free(source);
  zip_error_fini(&error);
  refuse(ErrorCode::kMeshTruncated, "",
         fmt::format("the archive is damaged ({}); copy or export it again", cause));
}

ZipParts::~ZipParts() { zip_discard(archive_); }

std::optional<std::string> ZipParts::part(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  zip_int64_t at = -1;
  for (const std::string& spelled : {std::string(name), percent_decoded(name)})
    for (const zip_flags_t flags : {zip_flags_t{ZIP_FL_ENC_RAW}, zip_flags_t{ZIP_FL_NOCASE}})
      if (at < 0) at = zip_name_locate(archive_, spelled.c_str(), flags);
  if (at < 0) return {};
  const auto fail = [&](ErrorCode code, std::string_view cause) {
    refuse(code, printable(name, 200), fmt::format("{}; copy or export the mesh again", cause));
  };
  const auto index = static_cast<zip_uint64_t>(at);
  zip_stat_t status;
  if (zip_stat_index(archive_, index, 0, &status) != 0 || (status.valid & ZIP_STAT_SIZE) == 0)
    fail(ErrorCode::kNotAMesh, zip_strerror(archive_));
  if (status.size > kMostBytes - unpacked_)
    refuse(ErrorCode::kMeshTooLarge, printable(name, 200),
           fmt::format("it unpacks to {} bytes, and {} in all are the most; export each mesh to a "
                       "file of its own, or an STL",
                       status.size, kMostBytes));
  // Deflate packs a byte into 8 bits of 1032 bytes at best: a size beyond that is a lie.
  if (status.size / 1032 > status.comp_size + 64)
    fail(ErrorCode::kNotAMesh, "its size in the archive is wrong");
  zip_file_t* file = zip_fopen_index(archive_, index, 0);
  if (file == nullptr) fail(ErrorCode::kNotAMesh, zip_strerror(archive_));
  std::string content(status.size + 1, '\0');  // one more: at its end the checksum is compared
  std::size_t got = 0;
  zip_int64_t more = 1;
  while (more > 0 && got < content.size()) {
    more = zip_fread(file, content.data() + got, content.size() - got);
    got += more > 0 ? static_cast<std::size_t>(more) : 0;
  }
  const std::string cause = more < 0 ? zip_file_strerror(file) : "its size is wrong";
  zip_fclose(file);
  if (more < 0 || got != status.size) fail(ErrorCode::kNotAMesh, cause);
  content.resize(got);
  unpacked_ += got;
  return content;
}

}  // namespace ist::import
