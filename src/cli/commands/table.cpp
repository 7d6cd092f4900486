#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "answers/json_parts.h"
#include "answers/refusals.h"
#include "cli/commands/commands.h"
#include "cli/common_options.h"
#include "cli/exit_code.h"
#include "cli/terminal.h"
#include "hardware/table_export.h"
#include "hardware/vector_file.h"
#include "ist/base/files.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::string_view kGenerator = "ist " IST_VERSION;
constexpr std::size_t kMostDifferences = 20;  // printed at most

struct TableArguments {
  std::string format;
  std::optional<std::uint64_t> vectors, seed;
  std::filesystem::path check, output;
  bool json = false;
};

void check(const TableArguments& options) {
  const bool checks = !options.check.empty(), has_output = !options.output.empty();
  refuse_if(!options.format.empty() + options.vectors.has_value() + checks != 1,
            "--format, --vectors, --check", "give one of them");
  refuse_if(options.seed && !options.vectors, "--seed", "goes with --vectors");
  refuse_if(checks && has_output, "--output", "goes with --format or --vectors");
  refuse_if(options.json && !checks && !has_output, "--json",
            "stdout carries the table or the vectors: write them to a file with --output");
}

// Passes a function to `make` that writes to `output`, or to stdout if that is empty.
template <typename Make>
void write_text(const std::filesystem::path& output, const Make& make) {
  if (!output.empty()) {
    OutputFile file(output);
    make([&file](std::string_view text) { file.write(text.data(), text.size()); });
    return file.commit();
  }
  make([](std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size()) return;
    fail_stdout();
  });
}

void tell(const TableArguments& options, const nlohmann::ordered_json& line,
          const std::string& text) {
  if (options.output.empty()) return;
  if (options.json) {
    print_header("table", {});
    print_json(line);
  } else {
    fmt::print("{}: {}\n", options.output.string(), text);
  }
}

void write_table(const TableArguments& options) {
  for (const auto& [name, format] : kTableFormats) {
    if (name != options.format) continue;
    const std::string text = table_text(format, kGenerator);
    write_text(options.output, [&text](const auto& write) { write(text); });
  }
  tell(options, {{"file", options.output.filename().string()}, {"format", options.format}},
       fmt::format("the table, as {}", options.format));
}

void write_golden(const TableArguments& options) {
  const std::uint64_t seed = options.seed.value_or(1);
  std::uint64_t checksum = 0;
  write_text(options.output, [&](const auto& write) {
    checksum = write_vectors(*options.vectors, seed, kGenerator, write);
  });
  tell(options,
       {{"file", options.output.filename().string()},
        {"vectors", *options.vectors},
        {"seed", seed},
        {"checksum", fmt::format("xxh64 {:016x}", checksum)}},
       fmt::format("{} vectors of seed {}", *options.vectors, seed));
}

nlohmann::ordered_json json_of(const std::filesystem::path& file, const VectorCheck& check) {
  nlohmann::ordered_json differences = nlohmann::ordered_json::array();
  for (const VectorDifference& at : check.differences) {
    differences.push_back(
        {{"line", at.line}, {"field", at.field}, {"is", at.is}, {"should_be", at.should_be}});
  }
  return {{"file", file.string()},      {"vectors", check.vectors},
          {"hits", check.hits},         {"wrong", check.wrong},
          {"differences", differences}, {"checksum_holds", check.checksum_holds}};
}

void check_file(const TableArguments& options) {
  const VectorCheck check = check_vectors(options.check, kMostDifferences);
  const std::string file = options.check.string();
  if (options.json) {
    print_header("table", {{"vectors", options.check}});
    print_json(json_of(options.check, check));
  } else {
    for (const VectorDifference& at : check.differences) {
      fmt::print("{}, line {}: {} is {:x}, and {:x} in the model\n", file, at.line, at.field, at.is,
                 at.should_be);
    }
    if (check.wrong == 0) {
      fmt::print("{}: {} vectors agree with the model, {} of them hits\n", file, check.vectors,
                 check.hits);
    }
  }
  if (check.wrong > 0) {
    throw Failure(
        kGuaranteeBroken,
        fmt::format("{}: {} of {} vectors differ from the model{}", file, check.wrong,
                    check.vectors,
                    check.checksum_holds
                        ? ""
                        : "; the checksum does not match the vectors: were they changed?"));
  }
}

void run(const TableArguments& options) {
  check(options);
  if (!options.check.empty()) return check_file(options);
  options.vectors ? write_golden(options) : write_table(options);
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const auto& [name, format] : kTableFormats) names.emplace_back(name);
  return names;
}

}  // namespace

void add_table(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "table", "Write the lookup table for other languages and for circuits, or test vectors");
  const auto options = std::make_shared<TableArguments>();
  command->add_option("--format", options->format, "write the table as text in this language")
      ->transform(one_of(format_names()));
  command
      ->add_option("--vectors", options->vectors,
                   "write this number of golden vectors of the pair test, corner cases first")
      ->transform(whole_number("the number of vectors"))
      ->check(CLI::Range(std::uint64_t{1}, kMaxVectors));
  command->add_option("--seed", options->seed, "seed of the random vectors; by default 1")
      ->transform(whole_number("a seed"));
  add_file(*command, "--check", options->check,
           "check a file of vectors against the model; exit code 5 if they differ, 2 if "
           "a number does not fit its format");
  add_file(*command, "-o,--output", options->output, "the file to write; by default stdout");
  command->add_flag("--json", options->json, "print one JSON object about the result");
  add_example(*command,
              "Example: ist table --format verilog -o ist_table_rom.v\n"
              "         ist table --vectors 100000 --seed 1 -o vectors.txt");
  command->callback([options] { run(*options); });
}

}  // namespace ist::cli
