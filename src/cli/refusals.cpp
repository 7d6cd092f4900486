#include "cli/refusals.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

#include "cli/poses/numbers.h"

namespace ist::cli {

void refuse_if(bool wrong, const std::string& option, const std::string& why) {
  if (wrong) throw CLI::ValidationError(option, why);
}

void refuse_to_overwrite(const std::filesystem::path& output,
                         std::initializer_list<std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code neither;
    refuse_if(!output.empty() && std::filesystem::equivalent(output, input, neither),
              output.string(), "writing it would destroy an input: name another file");
  }
}

CLI::Validator whole_number(const std::string& what) {
  return {[what](const std::string& text) {
            std::uint64_t value = 0;
            const char* end = text.data() + text.size();
            const auto [stop, error] = std::from_chars(text.data(), end, value);
            const bool reads_so = error == std::errc() && stop == end;
            const bool octal = text.size() > 1 && text.front() == '0';
            return reads_so && !octal
                       ? std::string()
                       : fmt::format("{}: give {} as decimal digits, less than 2^64", text, what);
          },
          ""};
}

CLI::Validator tolerance() {
  return {[](const std::string& text) {
            const auto numbers = numbers_of(text);
            return numbers && numbers->size() == 1 && numbers->front() >= 0
                       ? std::string()
                       : text + ": give a finite tolerance from 0 on, in mesh units";
          },
          "LENGTH"};
}

}  // namespace ist::cli
