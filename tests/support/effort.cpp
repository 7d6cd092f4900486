#include "support/effort.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace ist::test {

double effort() {
  static const double value = [] {
    const char* text = std::getenv("IST_EFFORT");
    if (text == nullptr) return 1.0;
    double number = 0;  // read alike in every locale, which some tests change
    const char* end = text + std::string_view(text).size();
    if (std::from_chars(text, end, number).ptr != end || !(number > 0) || number > 1e6) {
      std::fprintf(
          stderr,
          "IST_EFFORT is \"%s\": it takes a number above 0 and at most 1000000, such as 0.2\n",
          text);
      std::exit(2);
    }
    return number;
  }();
  return value;
}

double scaled_by_effort(double all) { return std::ceil(all * effort()); }

}  // namespace ist::test
