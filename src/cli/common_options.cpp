#include "cli/common_options.h"

#include <CLI/CLI.hpp>

#include "ist/tree/sphere_tree.h"

namespace ist::cli {

std::vector<std::string> policy_names() {
  std::vector<std::string> names;
  names.reserve(kSpherePolicies.size());
  for (const SpherePolicy policy : kSpherePolicies) {
    names.emplace_back(to_string(policy));
  }
  return names;
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::IsMember(words, CLI::ignore_case);
}

CLI::Validator unit_name() { return one_of({"mm", "m", "inch", "um", "µm"}); }

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

}  // namespace ist::cli
