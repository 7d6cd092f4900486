#include "cli/sweeps/part_words.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "answers/json_parts.h"
#include "cli/terminal.h"
#include "ist/tree/mesh_source.h"

namespace ist::cli {

using namespace answers;

std::string ranges(const std::vector<std::uint64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += text.empty() ? "" : ", ";
    text +=
        last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

std::string duration_text(double seconds) {
  constexpr double kMinute = 60, kHour = 3600;
  if (seconds < 2 * kMinute) return fmt::format("{:.1f} s", seconds);
  if (seconds < 2 * kHour) return fmt::format("{:.0f} min", seconds / kMinute);
  return fmt::format("{:.1f} h", seconds / kHour);
}

std::string given_up_text(const std::vector<std::uint64_t>& parts) {
  return fmt::format(
      "given up, for {} processes that began each were lost: {}; remove the files .start-1 to "
      ".start-{} of a part to try it again",
      SweepFolder::kMostStarts, ranges(parts), SweepFolder::kMostStarts);
}

void ShareEstimate::add(double seconds) {
  --left_;
  ++made_;
  seconds_ += seconds;
}

std::string ShareEstimate::text() const {
  std::string done = fmt::format("{} of {} done", parts_ - left_, parts_);
  if (left_ == 0 || made_ == 0) return done;
  return fmt::format(
      "{}, about {} left", done,
      duration_text(seconds_ / static_cast<double>(made_) * static_cast<double>(left_)));
}

FolderStatus status_of(const Sweep& sweep, const std::filesystem::path& path, bool verify,
                       const Proceed& proceed) {
  const SweepFolder folder(path, sweep.identity(), sweep.layout(), SweepFolder::Access::kRead);
  FolderStatus all;
  for (std::uint64_t part = 0; part < sweep.parts(); ++part) {
    const PartStatus status = verify ? folder.verify(part) : folder.look(part);
    if (status.state == PartState::kMissing) all.missing.push_back(part);
    if (status.state == PartState::kGivenUp) all.given_up.push_back(part);
    if (status.state == PartState::kDamaged) all.damaged.push_back(part);
    if (status.running) all.running.push_back(part);
    if (status.state == PartState::kDone) ++all.done;
    if (std::isfinite(status.seconds)) all.seconds += status.seconds;
    proceed(static_cast<double>(part + 1) / static_cast<double>(sweep.parts()));
  }
  return all;
}

void print_json(const Sweep& sweep, const nlohmann::ordered_json& result) {
  nlohmann::ordered_json header =
      header_line("sweep", NamedSources{{"sweep", source_of(sweep.file().file)}});
  const auto add = [&](const char* name, const SweepBody& body) {
    header[name] = {{"file", source_name(body.file.filename().string())}, {"hash", body.hash}};
  };
  add("fixed", sweep.file().fixed);
  add("moving", sweep.file().moving);
  print_json(header);
  print_json(result);
}

void print_status(const Sweep& sweep, const FolderStatus& status, bool json) {
  if (json) {
    const nlohmann::ordered_json object{
        {"sweep", sweep.identity().hash}, {"rows", sweep.rows()},
        {"parts", sweep.parts()},         {"done", status.done},
        {"missing", status.missing},      {"given_up", status.given_up},
        {"damaged", status.damaged},      {"running", status.running},
        {"seconds", status.seconds}};
    print_json(sweep, object);
    return;
  }
  fmt::print("sweep    {}\n", sweep.identity().hash);
  fmt::print("fixed    {} {}\n", sweep.file().fixed.hash, sweep.file().fixed.file.string());
  fmt::print("moving   {} {}\n", sweep.file().moving.hash, sweep.file().moving.file.string());
  fmt::print("rows     {} of {} bytes\n", sweep.rows(), sweep.layout().bytes);
  fmt::print("parts    {} of {} done, in {} of computing\n", status.done, sweep.parts(),
             duration_text(status.seconds));
  const auto line = [](const char* name, const std::vector<std::uint64_t>& parts) {
    if (!parts.empty()) fmt::print("{} {}\n", name, ranges(parts));
  };
  line("running ", status.running);
  line("missing ", status.missing);
  line("given up", status.given_up);
  line("damaged ", status.damaged);
}

}  // namespace ist::cli
