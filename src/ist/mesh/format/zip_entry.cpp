#include "ist/mesh/format/zip_entry.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "ist/mesh/format/text_reader.h"

namespace ist {
namespace {

// Sizes of the archive's records without their names, and the places in them, are those of
// PKWARE's APPNOTE.TXT.
constexpr std::size_t kDirectoryEnd = 22, kDirectoryEntry = 46, kLocalEntry = 30;

std::size_t number(std::string_view record, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, record.data() + at, bytes);
  return value;
}

struct Entry {
  std::size_t flags, method, checksum, packed, unpacked, offset;
};

class Archive {
 public:
  Archive(std::string_view bytes, std::string_view name, std::string_view file)
      : bytes_(bytes), name_(name), file_(file) {}

  std::string unpacked() const {
    const Entry entry = find();
    // No byte of deflate's becomes more than 1032.
    constexpr std::size_t kMostRatio = 1032;
    const bool is_plain = entry.method == 0 && entry.packed == entry.unpacked;
    if (entry.unpacked > kMostUnpacked)
      fail(ErrorCode::kMemoryLimit,
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
  // Looks the entry up in the directory at the archive's end.
  Entry find() const {
    const std::size_t end = bytes_.rfind("PK\5\6");
    if (end == bytes_.npos || bytes_.size() - end < kDirectoryEnd)
      fail_mesh(ErrorCode::kMeshTruncated, file_, fmt::format("byte {}", bytes_.size()),
                "the directory at the end of the archive is missing; copy or export it again");
    std::size_t at = number(bytes_, end + 16, 4);
    while (at < end && end - at >= kDirectoryEntry && bytes_.substr(at, 4) == "PK\1\2") {
      const std::string_view record = bytes_.substr(at);
      const std::size_t length = number(record, 28, 2);
      if (same_word(record.substr(kDirectoryEntry, length), name_))
        return {number(record, 8, 2),  number(record, 10, 2), number(record, 16, 4),
                number(record, 20, 4), number(record, 24, 4), number(record, 42, 4)};
      at += kDirectoryEntry + length + number(record, 30, 2) + number(record, 32, 2);
    }
    fail(ErrorCode::kNotAMesh, "the archive does not hold it; convert the mesh to 3MF or STL");
  }

  std::string_view packed_bytes(const Entry& entry) const {
    const std::string_view record = bytes_.substr(std::min(entry.offset, bytes_.size()));
    if (record.size() >= kLocalEntry && record.starts_with("PK\3\4")) {
      const std::size_t begin = kLocalEntry + number(record, 26, 2) + number(record, 28, 2);
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
    fail_mesh(code, file_, name_, cause);
  }

  std::string_view bytes_, name_, file_;
};

}  // namespace

std::string unzip(std::string_view archive, std::string_view name, std::string_view file) {
  return Archive(archive, name, file).unpacked();
}

}  // namespace ist
