#include "cli/cli_case.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "ist/mesh/mesh.h"
#include "support/shapes.h"

namespace ist::test {

CommandResult CliTest::ist_well(const std::vector<std::string>& arguments) {
  CommandResult result = ist(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result;
}

std::string CliTest::mesh(const std::string& name, const TriangleMesh& mesh) const {
  write_stl(mesh, dir_.path() / name);
  return path(name);
}

std::string CliTest::needle(const std::string& name, double length) const {
  return mesh(name, box({0, 0, 0}, {length, length / 100, length / 100}));
}

std::string CliTest::ball() const { return mesh("ball.stl", icosphere(2, 2)); }

std::string CliTest::ball_tree(const std::string& name, const std::string& spheres,
                               const std::vector<std::string>& more) const {
  std::vector<std::string> arguments{"build", ball(), "-o", path(name), "--spheres", spheres};
  if (std::find(more.begin(), more.end(), "--voxel-size") == more.end()) {
    arguments.insert(arguments.end(), {"--voxel-size", "0.5"});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  ist_well(arguments);
  return path(name);
}

std::string CliTest::smaller_fine_tree() const {
  const std::string tree = path("smaller.ist");
  ist_well({"build", mesh("smaller.stl", icosphere(3, 1.9)), "-o", tree, "--voxel-size", "0.05"});
  return tree;
}

std::string CliTest::poses(const std::vector<double>& shifts) const {
  nlohmann::json list = nlohmann::json::array();
  for (const double x : shifts) {
    list.push_back({{"label", "not looked at"},
                    {"pose", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1}},
                    {"distance", nullptr}});
  }
  return write("poses.json", list.dump());
}

void CliTest::leave_no_core() {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

void CliTest::await_entries(std::size_t entries, Process& process) const {
  await(process, [&] { return dir_.entries() >= entries; });
}

Process CliTest::with_held_call(const std::string& call, int after,
                                const std::vector<std::string>& arguments,
                                const std::string& terminal) const {
  return {"/usr/bin/env", words_with_call(call, after, "stand", arguments), terminal};
}

Process CliTest::with_told_call(const std::string& call, int after,
                                const std::vector<std::string>& arguments,
                                const std::string& terminal) const {
  return {"/usr/bin/env", words_with_call(call, after, "tell", arguments), terminal};
}

CommandResult CliTest::with_failing_call(const std::string& call, int after,
                                         const std::vector<std::string>& arguments) const {
  return run_command("/usr/bin/env", words_with_call(call, after, "fail", arguments));
}

void CliTest::await_hold(Process& process) const {
  await(process, [&] { return std::filesystem::exists(sign("held")); });
}

void CliTest::release() const { signs_.write("go", ""); }

Process CliTest::with_own_clock(const std::vector<std::string>& arguments) const {
  return {"/usr/bin/env", words_with_call("none", 0, "stand", arguments)};
}

std::vector<std::string> CliTest::words_with_own_clock(
    const std::vector<std::string>& arguments) const {
  std::vector<std::string> words = words_with_call("none", 0, "stand", arguments);
  words.insert(words.begin(), "/usr/bin/env");
  return words;
}

void CliTest::set_clock(unsigned milliseconds) const {
  std::filesystem::resize_file(sign("clock"), milliseconds);
}

void CliTest::await_heard(std::size_t signals, Process& process) const {
  await(process, [&] {
    std::error_code not_yet;
    const std::uintmax_t heard = std::filesystem::file_size(sign("heard"), not_yet);
    return (!not_yet && heard > signals) || waits_for_files();
  });
}

std::vector<std::string> CliTest::words_with_call(const std::string& call, int after,
                                                  const std::string& how,
                                                  const std::vector<std::string>& arguments) const {
  for (const char* const name : {"held", "go", "heard", "waits"}) {
    std::filesystem::remove(sign(name));
  }
  signs_.write("clock", "");
  std::vector<std::string> words{"LD_PRELOAD=" IST_HELD_CALLS,
                                 "ASAN_OPTIONS=verify_asan_link_order=0",
                                 "IST_HOLD=" + call,
                                 "IST_HOLD_AFTER=" + std::to_string(after),
                                 "IST_HOLD_HOW=" + how,
                                 "IST_SIGNS=" + signs_.path().string(),
                                 IST_COMMAND};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

std::string CliTest::without_notes(const std::string& err) {
  std::string rest;
  std::istringstream stream(err);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("note: ")) rest += line + "\n";
  }
  return rest;
}

std::vector<nlohmann::json> CliTest::json_lines(const std::string& text) {
  std::vector<nlohmann::json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
    EXPECT_TRUE(object.is_object()) << line;
    if (!object.contains("ist")) lines.push_back(std::move(object));
  }
  return lines;
}

::testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no \"" << part << "\" in: " << text;
}

}  // namespace ist::test
