#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "hardware/golden_vectors.h"

/// Golden vectors as text, which a bench in Verilog reads with $fscanf:
///
///     8 lines that begin with #: the generator, the seed, `# count N`, three lines with the names
///         and widths of the fields, the format of numbers, and `# checksum xxh64 H`, with H of all
///         bytes after the header
///     N lines, one vector each: numbers in hexadecimal, in two's complement of the field's width
///         and with all its digits, separated by spaces
namespace ist {

/// A field of a line. Fields are in the order of the line.
struct VectorField {
  const char* name;
  int digits;  ///< number of hexadecimal digits
  int bits;    ///< width of the number, two's complement if signed
  bool is_signed;
  std::int64_t most = 0;  ///< largest absolute value; 0: any that fits the bits
};

inline constexpr int kVectorFields = 27;
/// Returns the fields of a line, in their order.
[[nodiscard]] const std::array<VectorField, kVectorFields>& vector_fields() noexcept;

/// The largest number of vectors in a file.
inline constexpr std::uint64_t kMaxVectors = 10'000'000;

/// Writes the file of the first `count` vectors of `seed`, piece by piece, and returns its
/// checksum. Makes all vectors twice, because the checksum precedes them.
///
/// @param generator name and version of the writing program
std::uint64_t write_vectors(std::uint64_t count, std::uint64_t seed, std::string_view generator,
                            const std::function<void(std::string_view)>& write);

/// Reads a vector from a line without its line end. Throws kInputInvalid and kFixedPointRange;
/// `place`, file and line, begins the text.
[[nodiscard]] GoldenVector read_line(std::string_view line, std::string_view place);

/// An answer that differs from the model's.
struct VectorDifference {
  std::uint64_t line = 0;  ///< in the file, from 1
  const char* field = "";
  std::uint64_t is = 0, should_be = 0;
};

/// The result of a check: counts, and the first differences.
struct VectorCheck {
  std::uint64_t vectors = 0, hits = 0;
  std::uint64_t wrong = 0;                    ///< vectors with a difference
  std::vector<VectorDifference> differences;  ///< the first ones
  bool checksum_holds = false;
};

/// Checks each vector of a file against the model.
///
/// Throws kInputInvalid if the file has another format, kFixedPointRange if a number does not fit
/// its own: more digits than its field has, a level over 16, a fixed centre outside ±kMaxCentre;
/// and kFileUnreadable. All name the file and the line. Cost: 1 µs a vector; keeps `most`
/// differences and no vector in memory.
[[nodiscard]] VectorCheck check_vectors(const std::filesystem::path& file, std::size_t most);

}  // namespace ist
