#include "ist/hardware/vector_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "ist/base/error.h"

namespace ist {
namespace {

constexpr std::array<VectorField, kVectorFields> kFields = {{
    {"fixed_x", 5, 20, true, kMaxCentre},
    {"fixed_y", 5, 20, true, kMaxCentre},
    {"fixed_z", 5, 20, true, kMaxCentre},
    {"fixed_level", 2, 5, false, kMaxNodeLevel},
    {"fixed_mask", 2, 8, false},
    {"moving_x", 8, 32, true},
    {"moving_y", 8, 32, true},
    {"moving_z", 8, 32, true},
    {"moving_level", 2, 5, false, kMaxNodeLevel},
    {"moving_mask", 2, 8, false},
    {"rotation0", 5, 20, true},
    {"rotation1", 5, 20, true},
    {"rotation2", 5, 20, true},
    {"rotation3", 5, 20, true},
    {"rotation4", 5, 20, true},
    {"rotation5", 5, 20, true},
    {"rotation6", 5, 20, true},
    {"rotation7", 5, 20, true},
    {"rotation8", 5, 20, true},
    {"radius0", 4, 16, false},
    {"radius1", 4, 16, false},
    {"radius2", 4, 16, false},
    {"radius3", 4, 16, false},
    {"radius4", 4, 16, false},
    {"pad", 4, 16, false},
    {"reach", 10, 33, false},
    {"hit", 1, 1, false},
}};

// The numbers of a line, in its order: `use` is called with each member of the vector. What writes
// and what reads go the same way.
template <typename Vector, typename Use>
void for_each_number(Vector& vector, const Use& use) {
  auto& [pair, registers, answer] = vector;
  for (auto& x : pair.fixed_centre) use(x);
  use(pair.fixed_level);
  use(pair.fixed_mask);
  for (auto& x : pair.moving_centre) use(x);
  use(pair.moving_level);
  use(pair.moving_mask);
  for (auto& x : registers.rotation) use(x);
  for (auto& x : registers.radius) use(x);
  use(registers.pad);
  use(answer.reach);
  use(answer.hit);
}

[[noreturn]] void malformed(std::string_view place, const std::string& what) {
  throw Error(ErrorCode::kInputInvalid,
              fmt::format("{}: {}; make the file with 'ist table --vectors', or see "
                          "src/ist/hardware/README.md for what a line holds",
                          place, what));
}

[[noreturn]] void out_of_range(std::string_view place, const VectorField& field,
                               std::string_view digits, const std::string& allowed) {
  throw Error(ErrorCode::kFixedPointRange,
              fmt::format("{}, field {}: {} does not fit: {}; scale what made it to the formats in "
                          "src/ist/hardware/README.md",
                          place, field.name, digits, allowed));
}

int value_of(char digit) noexcept {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

// The digits of the next number, which are taken off the line.
std::string_view take_digits(std::string_view& line) noexcept {
  constexpr std::string_view kBlank = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view digits = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(digits.size());
  return digits;
}

std::int64_t read_number(const VectorField& field, std::string_view digits,
                         std::string_view place) {
  std::uint64_t bits = 0;
  for (const char digit : digits) {
    if (value_of(digit) < 0) {
      malformed(place, fmt::format("field {}: '{}' is no hexadecimal number", field.name,
                                   digits.substr(0, 40)));
    }
    bits = bits << 4 | static_cast<std::uint64_t>(value_of(digit));
  }
  const auto width = static_cast<std::size_t>(field.digits);
  if (digits.size() > width) {
    out_of_range(place, field, digits.substr(0, 40),
                 fmt::format("the field has {} digits, and {} bits", field.digits, field.bits));
  }
  if (digits.size() < width) {  // two's complement of how many bits?
    malformed(place, fmt::format("field {}: '{}' must have {} digits", field.name, digits, width));
  }
  if (bits >> field.bits != 0) {
    out_of_range(place, field, digits,
                 fmt::format("the field has no more bits than {}", field.bits));
  }
  const std::uint64_t sign = field.is_signed ? bits >> (field.bits - 1) << field.bits : 0;
  const std::int64_t value = static_cast<std::int64_t>(bits) - static_cast<std::int64_t>(sign);
  if (field.most != 0 && std::abs(value) > field.most) {
    out_of_range(place, field, digits, fmt::format("{} is over {}", std::abs(value), field.most));
  }
  return value;
}

}  // namespace

const std::array<VectorField, kVectorFields>& vector_fields() noexcept { return kFields; }

void append_line(const GoldenVector& vector, std::string& text) {
  std::size_t at = 0;
  for_each_number(vector, [&](auto number) {
    if (at > 0) text.push_back(' ');
    const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
    for (int digit = kFields[at++].digits - 1; digit >= 0; --digit) {
      text.push_back("0123456789abcdef"[bits >> 4 * digit & 15]);
    }
  });
  text.push_back('\n');
}

GoldenVector read_line(std::string_view line, std::string_view place) {
  GoldenVector vector;
  std::size_t at = 0;
  for_each_number(vector, [&]<typename Number>(Number& number) {
    const std::string_view digits = take_digits(line);
    if (digits.empty()) {
      malformed(place, fmt::format("{} fields, and a vector has {}", at, kVectorFields));
    }
    number = static_cast<Number>(read_number(kFields[at++], digits, place));
  });
  if (const std::string_view more = take_digits(line); !more.empty()) {
    malformed(place, fmt::format("'{}' behind the {} fields of a vector", more.substr(0, 40),
                                 kVectorFields));
  }
  return vector;
}

}  // namespace ist
