#include "hardware/vector_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "hardware/xxh64.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

constexpr std::array<VectorField, kVectorFields> kFields = {
    {{"fixed_x", 5, 20, true, kMaxCentre},
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
     {"hit", 1, 1, false}}};

// Calls `use` with each member of the vector in the order of a line. Writing and reading share it.
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
  throw_error(ErrorCode::kInputInvalid,
              "{}: {}; make the file with 'ist table --vectors', or see "
              "src/hardware/README.md for the format of a line",
              place, what);
}

[[noreturn]] void out_of_range(std::string_view place, const VectorField& field,
                               std::string_view digits, const std::string& allowed) {
  throw_error(ErrorCode::kFixedPointRange,
              "{}, field {}: {} does not fit: {}; scale the numbers to the formats in "
              "src/hardware/README.md",
              place, field.name, digits, allowed);
}

// Removes the digits of the next number from the line, and returns them.
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
  const char* end = digits.data() + digits.size();
  if (std::from_chars(digits.data(), end, bits, 16).ptr != end) {
    malformed(place, fmt::format("field {}: '{}' is not a hexadecimal number", field.name,
                                 digits.substr(0, 40)));
  }
  const auto width = static_cast<std::size_t>(field.digits);
  if (digits.size() > width) {
    out_of_range(place, field, digits.substr(0, 40),
                 fmt::format("the field has {} digits, and {} bits", field.digits, field.bits));
  }
  if (digits.size() < width) {  // the width of the two's complement would be unknown
    malformed(place, fmt::format("field {}: '{}' must have {} digits", field.name, digits, width));
  }
  if (bits >> field.bits != 0) {
    out_of_range(place, field, digits, fmt::format("the field has {} bits", field.bits));
  }
  const std::uint64_t sign = field.is_signed ? bits >> (field.bits - 1) << field.bits : 0;
  const std::int64_t value = static_cast<std::int64_t>(bits) - static_cast<std::int64_t>(sign);
  if (field.most != 0 && std::abs(value) > field.most) {
    out_of_range(place, field, digits, fmt::format("{} is over {}", std::abs(value), field.most));
  }
  return value;
}

// Appends the vector's line, with its line end.
void append_line(const GoldenVector& vector, std::string& text) {
  std::array<char, 17 * kVectorFields> line;
  char* end = line.data();
  const VectorField* field = kFields.data();
  for_each_number(vector, [&](auto number) {
    const auto bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
    for (int shift = 4 * field++->digits - 4; shift >= 0; shift -= 4) {
      *end++ = "0123456789abcdef"[bits >> shift & 15];
    }
    *end++ = ' ';
  });
  end[-1] = '\n';
  text.append(line.data(), end);
}

// Returns a header line of fields such as "fixed_x/20s": a name, its bits, and s for signed.
std::string names_of(int first, int end) {
  std::string names = "#";
  for (int i = first; i < end; ++i) {
    const VectorField& field = kFields[static_cast<std::size_t>(i)];
    names += fmt::format(" {}/{}{}", field.name, field.bits, field.is_signed ? "s" : "u");
  }
  return names + "\n";
}

template <typename Use>
void for_each_piece(std::uint64_t count, std::uint64_t seed, const Use& use) {
  constexpr std::size_t kPiece = 1 << 16;
  GoldenVectors vectors(seed);
  std::string text;
  for (std::uint64_t i = 0; i < count; ++i) {
    append_line(vectors.next(), text);
    if (text.size() < kPiece && i + 1 < count) continue;
    use(text);
    text.clear();
  }
}

}  // namespace

const std::array<VectorField, kVectorFields>& vector_fields() noexcept { return kFields; }

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
    malformed(place, fmt::format("'{}' after the {} fields of a vector", more.substr(0, 40),
                                 kVectorFields));
  }
  return vector;
}

std::uint64_t write_vectors(std::uint64_t count, std::uint64_t seed, std::string_view generator,
                            const std::function<void(std::string_view)>& write) {
  Xxh64 checksum;
  for_each_piece(count, seed,
                 [&](const std::string& text) { checksum.add(text.data(), text.size()); });
  write(
      fmt::format("# golden vectors of the sphere pair test with the lookup table; {}\n"
                  "# seed {}\n# count {}\n{}{}{}"
                  "# name/bits, s for signed: hexadecimal, two's complement, all digits\n"
                  "# checksum xxh64 {:016x}\n",
                  generator, seed, count, names_of(0, 10), names_of(10, 19),
                  names_of(19, kVectorFields), checksum.value()));
  for_each_piece(count, seed, write);
  return checksum.value();
}

}  // namespace ist
