#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ist/base/files.h"
#include "ist/sweep/columns.h"

namespace ist {

/// Returns the header of a .npy file of `rows` rows of that layout, by which numpy.load() gives an
/// array of structs. Source: NumPy's format 1.0, numpy.lib.format.
[[nodiscard]] std::string npy_header(const RowLayout& layout, std::uint64_t rows);

/// An array of doubles in a .npy file, in C order and little-endian.
struct NpyDoubles {
  std::vector<std::uint64_t> shape;
  std::uint64_t offset;  ///< of the first number, bytes
};

/// Reads a .npy file's header from its begin. Throws kInputInvalid, with a remedy, for another
/// file, another type or order of numbers, and a file that is not as long as its shape says.
[[nodiscard]] NpyDoubles read_npy_header(InputFile& file);

}  // namespace ist
