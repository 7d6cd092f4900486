#include "answers/refusals.h"

#include <algorithm>
#include <cmath>

#include "ist/base/platform/from_chars.h"

namespace ist::answers {

void refuse_if(bool wrong, const std::string& option, const std::string& why) {
  if (wrong) throw Refusal(option, why);
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r\n,;";
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    std::string_view word = text.substr(at, end - at);
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0;
    const auto [rest, error] = from_chars(word, number);
    if (error != std::errc() || rest != word.data() + word.size() || !std::isfinite(number)) {
      return std::nullopt;
    }
    numbers.push_back(number);
    at = text.find_first_not_of(kBetween, end);
  }
  return numbers;
}

std::optional<Eigen::Vector3d> vector_of(std::string_view text) {
  const auto numbers = numbers_of(text);
  if (!numbers || numbers->size() != 3) return std::nullopt;
  return Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
}

}  // namespace ist::answers
