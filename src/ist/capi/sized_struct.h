#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "ist/capi/guard.h"

namespace ist::capi {

/// Every struct with a size is of words of 8 bytes, so that a shorter one ends between members.
inline constexpr std::size_t kStructWord = 8, kLeastStruct = 16, kMostStruct = 4096;

template <typename Struct>
concept SizedStruct = std::is_trivially_copyable_v<Struct> && std::is_standard_layout_v<Struct> &&
                              sizeof(Struct) %
                              kStructWord
                          == 0 &&
                      sizeof(Struct) >= kLeastStruct &&
                      sizeof(Struct) <= kMostStruct&& offsetof(Struct, struct_size) == 0;

/// Fails where what stands in struct_size is no size.
template <SizedStruct Struct>
[[nodiscard]] ist_status check_size(const Call& call, const char* name, const Struct& given) {
  const std::size_t size = given.struct_size;
  if (size >= kLeastStruct && size <= kMostStruct && size % kStructWord == 0) return IST_OK;
  return call.fail(IST_STRUCT_SIZE, "{}->struct_size is {}: set it to sizeof, which is {}", name,
                   size, sizeof(Struct));
}

/// Copies options that a caller gave, of whatever age. Fails for a size that is none, and where
/// something is asked for that this library does not know.
template <SizedStruct Struct>
[[nodiscard]] ist_status read_sized(const Call& call, const char* name, const Struct& given,
                                    Struct& options) {
  if (const ist_status wrong = check_size(call, name, given)) return wrong;
  const std::size_t size = given.struct_size;
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  if (size > sizeof(Struct) &&
      std::any_of(bytes + sizeof(Struct), bytes + size, [](unsigned char b) { return b != 0; })) {
    return call.fail(IST_STRUCT_SIZE,
                     "{} has {} bytes, and what is behind the first {} is not zero: this library "
                     "is older than that, and does not know what it means",
                     name, size, sizeof(Struct));
  }
  options = {};
  std::memcpy(&options, &given, std::min(size, sizeof(Struct)));
  options.struct_size = sizeof(Struct);
  return IST_OK;
}

/// Fills in a caller's struct of whatever age: what it has room for; what this library does not
/// know becomes zero. Its size must be one (check_size).
template <SizedStruct Struct>
void write_sized(const Struct& values, Struct& out) noexcept {
  const std::size_t size = out.struct_size, known = std::min(size, sizeof(Struct));
  auto* bytes = reinterpret_cast<unsigned char*>(&out);
  std::memcpy(bytes + sizeof(std::size_t),
              reinterpret_cast<const unsigned char*>(&values) + sizeof(std::size_t),
              known - sizeof(std::size_t));
  std::fill(bytes + known, bytes + size, static_cast<unsigned char>(0));
}

/// Makes a caller's struct ready to be filled in, all zero, or fails.
template <SizedStruct Struct>
[[nodiscard]] ist_status clear_sized(const Call& call, const char* name, Struct* out) {
  if (const ist_status missing = call.need({{name, out}})) return missing;
  if (const ist_status wrong = check_size(call, name, *out)) return wrong;
  write_sized(Struct{}, *out);
  return IST_OK;
}

}  // namespace ist::capi
