#include "cli/occlusion/labels/tooth_numbers.h"

#include <fmt/format.h>

#include "ist/base/error.h"

namespace ist::cli {
namespace {

constexpr const char* kFdi =
    "FDI numbers are 11 to 18 up to 41 to 48, of milk teeth 51 to 55 up "
    "to 81 to 85; 0 is no tooth";
constexpr const char* kUniversal = "universal numbers are 1 to 32; 0 is no tooth";

}  // namespace

bool is_tooth_number(std::int64_t number, ToothNumbers system) {
  if (number == 0) return true;
  if (system == ToothNumbers::kUniversal) return number >= 1 && number <= 32;
  const std::int64_t quarter = number / 10, tooth = number % 10;
  return quarter >= 1 && quarter <= 8 && tooth >= 1 && tooth <= (quarter <= 4 ? 8 : 5);
}

void refuse_tooth_number(std::int64_t number, ToothNumbers system, const std::string& place) {
  throw Error(ErrorCode::kInputInvalid,
              fmt::format("{} is {}: {}; see --numbering", place, number,
                          system == ToothNumbers::kFdi ? kFdi : kUniversal));
}

}  // namespace ist::cli
