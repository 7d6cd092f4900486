#pragma once

#include <charconv>
#include <concepts>
#include <string_view>
#include <system_error>

#if !defined(__cpp_lib_to_chars)
#include <cmath>
#include <cstdlib>
#include <string>
#endif

namespace ist {

/// Parses the number at the beginning of `text` as std::from_chars does, which the host's locale
/// does not change. Returns the number's end and an error.
template <std::integral Number>
std::from_chars_result from_chars(std::string_view text, Number& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value);
}

#if defined(__cpp_lib_to_chars)
template <std::floating_point Number>
std::from_chars_result from_chars(std::string_view text, Number& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value);
}
#else
// libc++ has none for floating point. musl's strtod rounds as exactly, and knows one locale; it
// also takes blanks, a plus and hexadecimal digits, which from_chars does not.
template <std::floating_point Number>
std::from_chars_result from_chars(std::string_view text, Number& value) {
  const char* const begin = text.data();
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  constexpr std::string_view kFirst = "0123456789.iInN";
  if (sign == text.size() || kFirst.find(text[sign]) == kFirst.npos)
    return {begin, std::errc::invalid_argument};
  if (text.size() > sign + 1 && text[sign] == '0' && (text[sign + 1] | 0x20) == 'x') {
    value = sign == 0 ? Number(0) : -Number(0);
    return {begin + sign + 1, std::errc()};
  }
  const std::string word(text);
  char* stop = nullptr;
  Number read = 0;
  if constexpr (sizeof(Number) == sizeof(float)) {
    read = std::strtof(word.c_str(), &stop);
  } else {
    read = std::strtod(word.c_str(), &stop);
  }
  const auto length = static_cast<std::size_t>(stop - word.c_str());
  if (length == 0) return {begin, std::errc::invalid_argument};
  const std::string_view digits = text.substr(sign, text.find_first_of("eE") - sign);
  const bool lost = std::isinf(read)
                        ? (digits[0] | 0x20) != 'i'
                        : read == 0 && digits.find_first_of("123456789") != digits.npos;
  if (lost) return {begin + length, std::errc::result_out_of_range};
  value = read;
  return {begin + length, std::errc()};
}
#endif

}  // namespace ist
