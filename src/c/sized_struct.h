#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "c/guard.h"

namespace ist::capi {

/// A sized struct consists of words of 8 bytes, so that a shorter version ends between members.
inline constexpr std::size_t kStructWord = 8, kLeastStruct = 16, kMostStruct = 4096;

template <typename Struct>
concept SizedStruct = std::is_trivially_copyable_v<Struct> && std::is_standard_layout_v<Struct> &&
                              sizeof(Struct) %
                              kStructWord
                          == 0 &&
                      sizeof(Struct) >= kLeastStruct &&
                      sizeof(Struct) <= kMostStruct&& offsetof(Struct, struct_size) == 0;

/// Fails where struct_size is not a valid size. Returns whether it is one.
template <SizedStruct Struct>
bool check_size(Call& call, const char* name, const Struct& given) {
  const std::size_t size = given.struct_size;
  if (size >= kLeastStruct && size <= kMostStruct && size % kStructWord == 0) return true;
  call.fail(IST_STRUCT_SIZE, "{}->struct_size is {}: set it to sizeof, which is {}", name, size,
            sizeof(Struct));
  return false;
}

/// Copies a caller's options of any version; NULL gives zeros, the defaults. Fails for an invalid
/// size, and where a member unknown to this library is not zero.
template <SizedStruct Struct>
[[nodiscard]] Struct read_sized(Call& call, const char* name, const Struct* given) {
  Struct options{};
  if (given == nullptr || !check_size(call, name, *given)) return options;
  const std::size_t size = given->struct_size;
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  if (size > sizeof(Struct) &&
      std::any_of(bytes + sizeof(Struct), bytes + size, [](unsigned char b) { return b != 0; })) {
    call.fail(IST_STRUCT_SIZE,
              "{} has {} bytes, and a member after byte {} is not zero: this library is "
              "older and does not know the member; set it to zero, or update the library",
              name, size, sizeof(Struct));
    return options;
  }
  std::memcpy(&options, given, std::min(size, sizeof(Struct)));
  options.struct_size = sizeof(Struct);
  return options;
}

/// Fills a caller's struct of any version as far as its size allows, and sets members unknown to
/// this library to zero. The size must be valid (check_size).
template <SizedStruct Struct>
void write_sized(const Struct& values, Struct& out) noexcept {
  const std::size_t size = out.struct_size, known = std::min(size, sizeof(Struct));
  auto* bytes = reinterpret_cast<unsigned char*>(&out);
  std::memcpy(bytes + sizeof(std::size_t),
              reinterpret_cast<const unsigned char*>(&values) + sizeof(std::size_t),
              known - sizeof(std::size_t));
  std::fill(bytes + known, bytes + size, static_cast<unsigned char>(0));
}

/// Sets all members of a caller's struct to zero. Fails for NULL and for an invalid size.
template <SizedStruct Struct>
void clear_sized(Call& call, const char* name, Struct* out) {
  if (!call.need(name, out) || !check_size(call, name, *out)) return;
  write_sized(Struct{}, *out);
}

}  // namespace ist::capi
