#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/cli_case.h"
#include "support/shapes.h"

namespace ist::test {

/// ist occlusion of a ball of radius 2 over a plate. At z = 2 - t the ball is t deep in it.
class OcclusionCommand : public CliTest {
 protected:
  [[nodiscard]] CommandResult ask(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"occlusion", plate_, ball_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ist(arguments);
  }
  [[nodiscard]] nlohmann::json asked(std::vector<std::string> more) const {
    more.emplace_back("--json");
    const CommandResult result = ask(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto lines = json_lines(result.out);
    return lines.size() == 1 ? lines[0] : nlohmann::json();
  }
  void refuses(const std::vector<std::string>& more, int code, const std::string& part) const {
    const std::size_t before = dir_.entries();
    const CommandResult result = ask(more);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(dir_.entries(), before);
  }

  const std::string ball_ = mesh("ball.stl", icosphere(4, 2));
  const std::string plate_ = mesh("plate.stl", box({-5, -5, -3}, {5, 5, 0}));
};

/// The rows of a table, each by its headings.
using CsvRows = std::vector<std::map<std::string, std::string>>;
inline CsvRows csv_rows(std::string text, char separator = ',') {
  CsvRows rows;
  constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";
  EXPECT_TRUE(text.starts_with(std::string(kByteOrderMark) + "kind")) << text.substr(0, 9);
  text.erase(0, 3);
  std::vector<std::string> head, fields(1);
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      fields.emplace_back();
    } else if (c != '\n') {
      fields.back() += c;
    } else if (head.empty()) {
      head = std::exchange(fields, {""});
    } else {
      EXPECT_EQ(fields.size(), head.size());
      auto& row = rows.emplace_back();
      for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = fields.at(i);
      fields = {""};
    }
  }
  return rows;
}

/// The rows with these cells.
inline CsvRows only(const CsvRows& rows, const std::map<std::string, std::string>& cells) {
  CsvRows found;
  for (const auto& row : rows) {
    if (std::all_of(cells.begin(), cells.end(),
                    [&](const auto& cell) { return row.at(cell.first) == cell.second; })) {
      found.push_back(row);
    }
  }
  return found;
}

}  // namespace ist::test
