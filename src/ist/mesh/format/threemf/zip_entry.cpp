#include "ist/mesh/format/threemf/zip_entry.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "ist/base/printable.h"
#include "ist/mesh/format/text_reader.h"
#include "ist/mesh/format/threemf/zip_directory.h"

namespace ist {
namespace {

class Unpacking {
 public:
  Unpacking(std::string_view archive, std::string_view name, std::string_view file)
      : archive_(archive), name_(name), file_(file) {}

  std::string bytes_of(const ZipEntry& entry) const {
    // No byte of deflate's becomes more than 1032.
    constexpr std::size_t kMostRatio = 1032;
    const bool is_plain = entry.method == 0 && entry.packed == entry.unpacked;
    if (entry.unpacked > kMostUnpacked)
      fail(ErrorCode::kMeshTooLarge,
           fmt::format("it unpacks to {} bytes, more than {}; export the mesh as STL or PLY",
                       entry.unpacked, kMostUnpacked));
    if ((entry.flags & 1) != 0 || !(is_plain || entry.method == Z_DEFLATED) ||
        entry.unpacked / kMostRatio > entry.packed)
      fail(ErrorCode::kNotAMesh, "it is encrypted, or packed in an unknown way; export it again");
    const std::string_view packed = packed_bytes(entry);
    std::string bytes = is_plain ? std::string(packed) : inflated(packed, entry.unpacked);
    if (crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != entry.checksum)
      fail(ErrorCode::kNotAMesh, "its checksum is wrong; copy or export it again");
    return bytes;
  }

 private:
  std::string_view packed_bytes(const ZipEntry& entry) const {
    constexpr std::size_t kLocalEntry = 30;
    const std::string_view record =
        archive_.substr(std::min<std::uint64_t>(entry.offset, archive_.size()));
    if (record.size() >= kLocalEntry && record.starts_with("PK\3\4")) {
      const std::size_t begin = kLocalEntry + zip_number(record, 26, 2) + zip_number(record, 28, 2);
      if (begin <= record.size() && entry.packed <= record.size() - begin)
        return record.substr(begin, entry.packed);
    }
    fail(ErrorCode::kMeshTruncated, "its bytes are not in the archive; copy or export it again");
  }

  std::string inflated(std::string_view packed, std::size_t size) const {
    std::string bytes(size, '\0');
    z_stream stream{};
    const int raw = -MAX_WBITS;
    bool whole = inflateInit2(&stream, raw) == Z_OK;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    whole = whole && inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    if (!whole) fail(ErrorCode::kNotAMesh, "its packed bytes are damaged; copy or export it again");
    return bytes;
  }

  [[noreturn]] void fail(ErrorCode code, std::string_view cause) const {
    fail_mesh(code, file_, printable(name_), cause);
  }

  std::string_view archive_, name_, file_;
};

}  // namespace

std::optional<std::string> unzip(std::string_view archive, std::string_view name,
                                 std::string_view file) {
  const std::optional<ZipEntry> entry = find_zip_entry(archive, name, file);
  if (!entry) return {};
  return Unpacking(archive, name, file).bytes_of(*entry);
}

}  // namespace ist
