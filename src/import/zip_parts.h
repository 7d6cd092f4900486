#pragma once

#include <optional>
#include <string>
#include <string_view>

struct zip;

namespace ist::import {

/// The parts of a zip archive in memory. Throws a Refusal for an archive or a part that is damaged,
/// and for more than 2^29 bytes unpacked in all.
class ZipParts {
 public:
  /// `content` must outlive this object.
  explicit ZipParts(std::string_view content);
  ~ZipParts();
  ZipParts(const ZipParts&) = delete;
  ZipParts& operator=(const ZipParts&) = delete;

  /// Unpacks the part of a name, or returns nothing if it is missing. A first slash and the case of
  /// letters do not matter. %XX may stand for a byte.
  [[nodiscard]] std::optional<std::string> part(std::string_view name);

 private:
  struct zip* archive_ = nullptr;
  std::size_t unpacked_ = 0;
};

}  // namespace ist::import
