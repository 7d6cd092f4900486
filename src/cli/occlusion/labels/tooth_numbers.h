#pragma once

#include <cstdint>
#include <string>

namespace ist::cli {

/// A system of tooth numbers: the permanent and milk teeth of ISO 3950 (FDI), or the universal
/// numbers 1 to 32.
enum class ToothNumbers { kFdi, kUniversal };

/// Whether a number is one of the system, or 0: no tooth.
[[nodiscard]] bool is_tooth_number(std::int64_t number, ToothNumbers system);

/// Throws kInputInvalid for a number of another system, at a place.
[[noreturn]] void refuse_tooth_number(std::int64_t number, ToothNumbers system,
                                      const std::string& place);

}  // namespace ist::cli
