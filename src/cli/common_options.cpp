#include "cli/common_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <limits>
#include <system_error>

#include "answers/refusals.h"
#include "ist/base/files.h"
#include "ist/tree/sphere_tree.h"
#include "loop/scene/spelling.h"

namespace ist::cli {

using namespace answers;

std::vector<std::string> policy_names() {
  std::vector<std::string> names;
  names.reserve(kSpherePolicies.size());
  for (const SpherePolicy policy : kSpherePolicies) {
    names.emplace_back(to_string(policy));
  }
  return names;
}

std::string with_nearest(const std::string& why, const std::string& word,
                         const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  for (const std::string& each : known) {
    const std::size_t changes = edits(word, each);
    if (!looks_like(word, each) || changes >= fewest) continue;
    fewest = changes;
    nearest = &each;
  }
  return nearest == nullptr ? why : why + "; did you mean " + *nearest + "?";
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto take = [words](std::string& word) {
    const std::string small = CLI::detail::to_lower(word);
    for (const std::string& known : words) {
      if (CLI::detail::to_lower(known) != small) continue;
      word = known;
      return std::string();
    }
    return with_nearest(fmt::format("'{}' is none of {}", word, fmt::join(words, ", ")), small,
                        words);
  };
  return {take, fmt::format("{{{}}}", fmt::join(words, ","))};
}

CLI::Validator unit_name() { return one_of({"mm", "m", "inch", "um", "µm"}); }

CLI::Option* add_file(CLI::App& command, const std::string& name, std::filesystem::path& file,
                      const std::string& help) {
  return command.add_option(name, file, help)->type_name("FILE");
}

void add_example(CLI::App& command, const std::string& example) {
  command.footer(example + "\n" + command.get_parent()->get_footer());
}

void add_max_memory(CLI::App& command, std::uint64_t& bytes, const std::string& of) {
  // A minus sign would wrap round in an unsigned number.
  const auto refuse_minus = [](const std::string& text) {
    return std::string(text.find('-') == text.npos ? "" : "give a positive number of bytes");
  };
  command
      .add_option("--max-memory", bytes, "most memory for " + of + ", in bytes, or with K, M or G")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->type_name("BYTES")
      ->transform(CLI::Validator(refuse_minus, ""))  // applied before the transformation above
      ->default_str("4G");
}

void refuse_to_overwrite(const std::filesystem::path& output,
                         std::initializer_list<std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code neither;
    refuse_if(!output.empty() && std::filesystem::equivalent(output, input, neither),
              output.string(), "writing it would destroy an input: name another file");
  }
}

void check_output(const std::filesystem::path& output,
                  std::initializer_list<std::filesystem::path> inputs) {
  refuse_to_overwrite(output, inputs);
  if (!output.empty()) require_writable(output);
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
