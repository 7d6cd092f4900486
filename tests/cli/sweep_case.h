#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include "cli/cli_case.h"

namespace ist::test {

/// A test of sweeps: a ball is asked at random poses about a ball of the same size, so that some
/// poses touch and some do not.
class SweepCommand : public CliTest {
 protected:
  SweepCommand() {
    leave_no_core();
    static_cast<void>(ball_tree());
  }

  /// The content of a sweep file.
  struct Job {
    std::uint64_t count = 25, rows_per_part = 10, seed = 1;
    std::string answers = R"("intersects", "distance")", tolerance = "0.01";
    std::string from = "[2, -1, -1]", to = "[5, 1, 1]";
    std::string name = "job.toml";
  };
  static std::string text_of(const Job& job) {
    return fmt::format(
        "answers = [{}]\n"
        "tolerance = {}\n"
        "rows_per_part = {}\n"
        "[fixed]\n"
        "tree = \"ball.ist\"\n"
        "[moving]\n"
        "tree = \"ball.ist\"\n"
        "[poses.box]\n"
        "seed = {}\n"
        "count = {}\n"
        "from = {}\n"
        "to = {}\n"
        "turns = \"any\"\n",
        job.answers, job.tolerance, job.rows_per_part, job.seed, job.count, job.from, job.to);
  }
  /// Writes a sweep file, and returns its path.
  std::string sweep_file(const Job& job) const { return write(job.name, text_of(job)); }

  /// The arguments of a sweep of a file into a folder of the test's.
  [[nodiscard]] std::vector<std::string> arguments(
      const std::string& file, const std::string& folder,
      const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"sweep", file, "-o", path(folder)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  [[nodiscard]] CommandResult sweep(const std::string& file, const std::string& folder,
                                    const std::vector<std::string>& more = {}) const {
    return ist(arguments(file, folder, more));
  }
  /// Runs what must succeed.
  CommandResult sweep_well(const std::string& file, const std::string& folder,
                           const std::vector<std::string>& more = {}) const {
    return ist_well(arguments(file, folder, more));
  }
  /// Makes all parts in one process, which merges them.
  void make_whole(const std::string& file, const std::string& folder) const {
    sweep_well(file, folder);
    EXPECT_TRUE(exists(folder + "/rows.npy"));
  }
  /// Removes the table of a folder, so that the next call merges.
  void remove_table(const std::string& folder) const {
    std::filesystem::remove(path(folder + "/rows.npy"));
    std::filesystem::remove(path(folder + "/manifest.json"));
  }

  using Files = std::map<std::string, std::string>;
  /// The files of a folder, their bytes by their names.
  [[nodiscard]] Files files(const std::string& folder) const {
    Files found;
    if (!exists(folder)) return found;
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      found[entry.path().filename()] = file_content(entry.path());
    }
    return found;
  }
  /// The same without the records of parts, which hold times.
  [[nodiscard]] Files results(const std::string& folder) const {
    Files found = files(folder);
    std::erase_if(found, [](const auto& file) {
      return file.first.starts_with("part-") && file.first.ends_with(".json");
    });
    return found;
  }
  /// Whether they are the same files; names those that are not.
  static ::testing::AssertionResult same(const Files& found, const Files& expected) {
    ::testing::AssertionResult result = ::testing::AssertionSuccess();
    const auto fail = [&](const std::string& name, const char* how) {
      if (result) result = ::testing::AssertionFailure();
      result << name << how << "; ";
    };
    for (const auto& [name, bytes] : expected) {
      if (found.count(name) == 0) {
        fail(name, " is missing");
      } else if (found.at(name) != bytes) {
        fail(name, " has other bytes");
      }
    }
    for (const auto& [name, bytes] : found) {
      if (expected.count(name) == 0) fail(name, " is too many");
    }
    return result;
  }
  [[nodiscard]] std::vector<std::string> names(const std::string& folder) const {
    std::vector<std::string> found;
    if (!exists(folder)) return found;
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      found.push_back(entry.path().filename());
    }
    std::sort(found.begin(), found.end());
    return found;
  }
  /// How many parts of a folder are there, or marks of a part.
  [[nodiscard]] std::ptrdiff_t parts_in(const std::string& folder) const {
    return count_of(folder, [](const std::string& name) {
      return name.starts_with("part-") && name.ends_with(".npy");
    });
  }
  [[nodiscard]] std::ptrdiff_t marks_in(const std::string& folder) const {
    return count_of(
        folder, [](const std::string& name) { return name.find(".start-") != std::string::npos; });
  }

  /// How many parts of a folder are begun, with a file that has its header and no name yet.
  [[nodiscard]] std::ptrdiff_t begun_in(const std::string& folder) const {
    return count_of(folder, [&](const std::string& name) {
      std::error_code gone;
      const std::uintmax_t bytes = std::filesystem::file_size(path(folder + "/" + name), gone);
      return name.starts_with("part-") && name.ends_with(".tmp") && !gone && bytes > 0;
    });
  }

  /// The object that a command prints with --json, after its header.
  static nlohmann::json object_of(const CommandResult& result) {
    const std::vector<nlohmann::json> lines = json_lines(result.out);
    EXPECT_EQ(lines.size(), 1u) << result.out;
    return lines.empty() ? nlohmann::json() : lines[0];
  }

  /// The rows of a .npy file, without its header.
  static std::string rows_in(const std::string& npy) {
    if (npy.size() < 10 || !npy.starts_with("\x93NUMPY")) return "no .npy file";
    const std::size_t length =
        static_cast<unsigned char>(npy[8]) + std::size_t{256} * static_cast<unsigned char>(npy[9]);
    return npy.substr(std::min(npy.size(), 10 + length));
  }
  /// A column of rows, as the sweep.json of their folder describes it.
  [[nodiscard]] std::vector<double> column(const std::string& folder,
                                           const std::string& name) const {
    const nlohmann::json record = nlohmann::json::parse(file_content(path(folder + "/sweep.json")));
    std::size_t offset = 0, row = 0;
    std::string type;
    for (const nlohmann::json& each : record["columns"]) {
      if (each["name"] == name) {
        offset = row;
        type = each["type"];
      }
      row += std::size_t{each["type"] == "int32" ? 4u : 8u};
    }
    const std::string bytes = rows_in(file_content(path(folder + "/rows.npy")));
    std::vector<double> values;
    const auto add = [&](const char* at, auto value) {
      std::memcpy(&value, at, sizeof(value));
      values.push_back(static_cast<double>(value));
    };
    for (std::size_t at = offset; at < bytes.size(); at += row) {
      if (type == "int32") add(bytes.data() + at, std::int32_t());
      if (type == "uint64") add(bytes.data() + at, std::uint64_t());
      if (type == "float64") add(bytes.data() + at, double());
    }
    return values;
  }

 private:
  template <typename Is>
  [[nodiscard]] std::ptrdiff_t count_of(const std::string& folder, const Is& is) const {
    const std::vector<std::string> all = names(folder);
    return std::count_if(all.begin(), all.end(), is);
  }
};

}  // namespace ist::test
