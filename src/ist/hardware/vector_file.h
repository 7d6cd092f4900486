#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ist/hardware/golden_vectors.h"

/// Golden vectors as text, which a bench in Verilog reads with $fscanf:
///
///     8 lines that begin with #: the generator, the seed, `# count N`, three lines that name the
///         fields and their widths, how numbers are written, and `# checksum xxh64 H`, H of all
///         bytes behind the header
///     N lines, a vector each: numbers in hexadecimal, in two's complement of the field's width and
///         with all its digits, a space between
namespace ist {

/// A field of a line, in the order of the line.
struct VectorField {
  const char* name;
  int digits;  ///< hexadecimal
  int bits;    ///< of the number, two's complement where it is signed
  bool is_signed;
  std::int64_t most = 0;  ///< no number is farther from 0; where 0, any that has the bits
};

inline constexpr int kVectorFields = 27;
[[nodiscard]] const std::array<VectorField, kVectorFields>& vector_fields() noexcept;

/// The most vectors that a file holds.
inline constexpr std::uint64_t kMaxVectors = 10'000'000;

/// What is there to be written of the first `count` vectors of `seed`, piece by piece. Makes all
/// twice, for the checksum stands before them. Returns the checksum.
///
/// @param generator name and version of who writes
std::uint64_t write_vectors(std::uint64_t count, std::uint64_t seed, std::string_view generator,
                            const std::function<void(std::string_view)>& write);

/// An answer that is not the model's.
struct VectorDifference {
  std::uint64_t line = 0;  ///< of the file, from 1
  const char* field = "";
  std::uint64_t is = 0, should_be = 0;
};

struct VectorCheck {
  std::uint64_t vectors = 0, hits = 0;
  std::uint64_t wrong = 0;                    ///< vectors with a difference
  std::vector<VectorDifference> differences;  ///< the first of them
  bool checksum_holds = false;
};

/// Holds each vector of a file against the model.
///
/// Throws kInputInvalid where the file is not as above, kFixedPointRange where a number does not
/// fit its format: more digits than its field has, a level over 16, a fixed centre outside
/// ±kMaxCentre; and kFileUnreadable. All name the file, and the line. Cost: 1 µs a vector; keeps
/// `most` differences and no vector in memory.
[[nodiscard]] VectorCheck check_vectors(const std::filesystem::path& file, std::size_t most);

}  // namespace ist
