#include "loop/haptics/devices/script_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "ist/base/files.h"
#include "ist/base/float_environment.h"
#include "ist/base/platform/from_chars.h"
#include "ist/base/printable.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

constexpr std::string_view kHeader = "time,x,y,z,qw,qx,qy,qz";
constexpr std::size_t kColumns = 8;
constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // written by spreadsheets

// Takes the text up to the separator, or all of it, and the separator.
std::string_view take(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view taken = text.substr(0, end);
  text.remove_prefix(end == text.npos ? text.size() : end + 1);
  return taken;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

class ScriptReader {
 public:
  ScriptReader(std::string_view text, std::string file, double metres)
      : text_(text), file_(std::move(file)), metres_(metres) {}

  std::vector<Waypoint> read() {
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    const std::string_view header = next_line();
    if (header != kHeader) {
      fail(fmt::format("'{}' is not the header: begin with the line {}", printable(header),
                       kHeader));
    }
    std::vector<Waypoint> waypoints;
    for (std::string_view line = next_line(); !line.empty(); line = next_line()) {
      const Waypoint waypoint = waypoint_of(numbers_of(line));
      const std::string flaw =
          waypoint_flaw(waypoints.empty() ? nullptr : &waypoints.back(), waypoint);
      if (!flaw.empty()) fail(flaw);
      waypoints.push_back(waypoint);
    }
    if (waypoints.empty()) fail("no waypoint follows the header: give at least one, at time 0");
    return waypoints;
  }

 private:
  // Takes the next line that is not empty; empty at the end of the text.
  std::string_view next_line() {
    while (!text_.empty()) {
      ++line_;
      const std::string_view line = without_blanks(take(text_, '\n'));
      if (!line.empty()) return line;
    }
    return {};
  }

  std::array<double, kColumns> numbers_of(std::string_view line) const {
    std::array<double, kColumns> numbers{};
    std::size_t columns = 0;
    for (bool more = true; more; ++columns) {
      more = line.find(',') != line.npos;
      const std::string_view word = without_blanks(take(line, ','));
      if (columns < kColumns) numbers[columns] = number_of(word);
    }
    if (columns != kColumns) {
      fail(fmt::format("the line has {} columns: give the eight of {}", columns, kHeader));
    }
    return numbers;
  }

  double number_of(std::string_view word) const {
    double number = 0;
    const auto [stop, error] = from_chars(word, number);
    if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(number)) {
      fail(fmt::format("'{}' is no finite number: write it as 12.5 or 1.25e1", printable(word)));
    }
    return number;
  }

  Waypoint waypoint_of(const std::array<double, kColumns>& n) const {
    const double largest = std::max(std::max(std::abs(n[4]), std::abs(n[5])),
                                    std::max(std::abs(n[6]), std::abs(n[7])));
    if (largest == 0) fail("the quaternion is 0: give qw = 1 for no turn");
    // Scaled by the largest first, so that no square overflows or underflows.
    Eigen::Quaterniond turn(n[4] / largest, n[5] / largest, n[6] / largest, n[7] / largest);
    turn.normalize();
    return {n[0], {turn.toRotationMatrix(), metres_ * Eigen::Vector3d(n[1], n[2], n[3])}};
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw_error(ErrorCode::kInputInvalid, "{}: line {}: {}", file_, std::max(line_, std::size_t{1}),
                what);
  }

  std::string_view text_;  // the rest of the text
  std::string file_;
  double metres_;
  std::size_t line_ = 0;
};

}  // namespace

ScriptDevice::ScriptDevice(std::vector<Waypoint> waypoints, const DeviceMechanics& mechanics)
    : plan_(std::move(waypoints)), mechanics_(mechanics) {}

std::optional<Placement> ScriptDevice::read() noexcept {
  const ScopedFloatEnvironment environment;
  return plan_.at(time_).pose;
}

void ScriptDevice::write(const Vector6& /*wrench*/, double dt) noexcept {
  const ScopedFloatEnvironment environment;
  time_ += dt;
}

std::vector<Waypoint> read_script(const std::filesystem::path& file, double metres) {
  const ScopedFloatEnvironment environment;
  if (!(std::isfinite(metres) && metres > 0)) {
    throw_error(ErrorCode::kArgumentInvalid,
                "the unit of a script is {} m: give its length in metres", metres);
  }
  InputFile input(file);
  if (input.size() > kMostBytes) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: it has {} bytes, more than {}: give fewer waypoints; the motion "
                "between them is interpolated",
                file.string(), input.size(), kMostBytes);
  }
  std::string text(input.size(), '\0');
  text.resize(input.read(text.data(), text.size()));
  return ScriptReader(text, file.string(), metres).read();
}

}  // namespace ist
