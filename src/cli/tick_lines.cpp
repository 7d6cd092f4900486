#include "cli/tick_lines.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>

#include "ist/base/error.h"

namespace ist::cli {
namespace {

constexpr std::size_t kFlush = 1 << 16;  // bytes

constexpr const char* kCsvHeader =
    "tick,dt,device_known,device_x,device_y,device_z,device_xx,device_xy,device_xz,device_yx,"
    "device_yy,device_yz,device_zx,device_zy,device_zz,tool_x,tool_y,tool_z,tool_xx,tool_xy,"
    "tool_xz,tool_yx,tool_yy,tool_yz,tool_zx,tool_zy,tool_zz,force_x,force_y,force_z,torque_x,"
    "torque_y,torque_z,contacts,leaf_pairs,gap_lower,gap_upper,level,complete,sphere_tests,"
    "proximity_tests,held,fault,late_microseconds,microseconds,cpu_microseconds\n";

double microseconds(std::int64_t nanoseconds) { return 1e-3 * static_cast<double>(nanoseconds); }

template <typename Numbers>
void append_list(std::string& line, const Numbers& numbers) {
  fmt::format_to(std::back_inserter(line), "{}", fmt::join(numbers, ","));
}

// A number, or what stands for none.
template <typename Number>
void append(std::string& line, const std::optional<Number>& number, const char* none) {
  if (number) {
    fmt::format_to(std::back_inserter(line), "{}", *number);
  } else {
    line += none;
  }
}

// What a query told, each nothing where it was not asked.
struct Told {
  std::optional<std::uint64_t> contacts, sphere_tests, proximity_tests;
  std::optional<double> gap_lower, gap_upper;
  std::optional<int> level;
  std::optional<bool> complete;

  explicit Told(const TickRecord& record) {
    if (record.proximity) proximity_tests = record.proximity->sphere_tests;
    if (!record.contacts) return;
    contacts = record.contacts->contacts;
    sphere_tests = record.contacts->sphere_tests;
    level = record.contacts->level;
    complete = record.contacts->complete;
    if (!record.contacts->gap) return;
    gap_lower = record.contacts->gap->lower;
    gap_upper = record.contacts->gap->upper;
  }
};

}  // namespace

TickWriter::TickWriter(const std::filesystem::path& file)
    : file_(file), csv_(file.extension() == ".csv") {
  if (csv_) lines_ += kCsvHeader;
}

void TickWriter::write(const TickRecord& record) {
  csv_ ? write_csv(record) : write_json(record);
  if (lines_.size() >= kFlush) flush();
}

void TickWriter::commit() {
  flush();
  file_.commit();
}

void TickWriter::flush() {
  file_.write(lines_.data(), lines_.size());
  lines_.clear();
}

void TickWriter::write_json(const TickRecord& record) {
  const Told told(record);
  const auto key = [&](const char* name) {
    fmt::format_to(std::back_inserter(lines_), ",\"{}\":", name);
  };
  fmt::format_to(std::back_inserter(lines_), "{{\"tick\":{},\"dt\":{}", record.tick, record.dt);
  key("device");
  if (record.device_known) {
    lines_ += '[';
    append_list(lines_, record.device);
    lines_ += ']';
  } else {
    lines_ += "null";
  }
  key("tool");
  lines_ += '[';
  append_list(lines_, record.tool);
  lines_ += ']';
  key("wrench");
  lines_ += '[';
  append_list(lines_, record.wrench);
  lines_ += ']';
  const auto number = [&](const char* name, const auto& value) {
    key(name);
    append(lines_, value, "null");
  };
  number("contacts", told.contacts);
  number("leaf_pairs", std::optional(record.leaf_pairs));
  number("gap_lower", told.gap_lower);
  number("gap_upper", told.gap_upper);
  number("level", told.level);
  number("complete", told.complete);
  number("sphere_tests", told.sphere_tests);
  number("proximity_tests", told.proximity_tests);
  number("held", std::optional(record.held));
  number("fault", std::optional(record.fault));
  number("late_microseconds", std::optional(microseconds(record.late_ns)));
  number("microseconds", std::optional(microseconds(record.execution_ns)));
  number("cpu_microseconds", std::optional(microseconds(record.cpu_ns)));
  lines_ += "}\n";
}

void TickWriter::write_csv(const TickRecord& record) {
  const Told told(record);
  fmt::format_to(std::back_inserter(lines_), "{},{},{},", record.tick, record.dt,
                 record.device_known ? 1 : 0);
  append_list(lines_, record.device);
  lines_ += ',';
  append_list(lines_, record.tool);
  lines_ += ',';
  append_list(lines_, record.wrench);
  const auto number = [&](const auto& value) {
    lines_ += ',';
    append(lines_, value, "");
  };
  const auto flag = [&](const std::optional<bool>& value) {
    number(value ? std::optional(*value ? 1 : 0) : std::nullopt);
  };
  number(told.contacts);
  number(std::optional(record.leaf_pairs));
  number(told.gap_lower);
  number(told.gap_upper);
  number(told.level);
  flag(told.complete);
  number(told.sphere_tests);
  number(told.proximity_tests);
  flag(record.held);
  flag(record.fault);
  number(std::optional(microseconds(record.late_ns)));
  number(std::optional(microseconds(record.execution_ns)));
  number(std::optional(microseconds(record.cpu_ns)));
  lines_ += '\n';
}

TickReader::TickReader(std::filesystem::path file, double dt)
    : file_(std::move(file)), dt_(dt), in_(file_) {
  if (!in_) {
    throw Error(ErrorCode::kFileUnreadable,
                fmt::format("{}: {}", file_.string(), std::strerror(errno)));
  }
  std::error_code none;  // a pipe has no size
  const std::uintmax_t size = std::filesystem::file_size(file_, none);
  if (!none) bytes_ = size;
}

void TickReader::refuse(const std::string& what) const {
  throw Error(ErrorCode::kInputInvalid,
              fmt::format("{}:{}: {}: give a file that --record wrote as JSON lines",
                          file_.string(), line_, what));
}

std::optional<RecordedTick> TickReader::next() {
  std::string text;
  if (!std::getline(in_, text)) {
    if (in_.bad()) refuse("cannot be read");
    return std::nullopt;
  }
  ++line_;
  bytes_read_ += text.size() + 1;
  const nlohmann::json line = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!line.is_object()) refuse("no JSON object");
  RecordedTick tick{};
  const auto count = [&](const char* key) -> std::optional<std::uint64_t> {
    const auto found = line.find(key);
    if (found == line.end()) refuse(fmt::format("no key '{}'", key));
    if (found->is_null()) return std::nullopt;
    if (!found->is_number_unsigned()) refuse(fmt::format("'{}' is no whole number", key));
    return found->get<std::uint64_t>();
  };
  const std::optional<std::uint64_t> number = count("tick");
  if (!number) refuse("'tick' is null");
  tick.tick = *number;
  if (const auto tests = count("sphere_tests")) tick.budget.contacts.sphere_tests = *tests;
  if (const auto tests = count("proximity_tests")) tick.budget.proximity.sphere_tests = *tests;

  const auto dt = line.find("dt");
  if (dt == line.end() || !dt->is_number()) refuse("no number 'dt'");
  if (dt->get<double>() != dt_) {
    throw Error(
        ErrorCode::kInputInvalid,
        fmt::format("{}:{}: it was recorded at {:.6g} Hz, and the scene runs at {:.6g}: say "
                    "--rate {:.6g}",
                    file_.string(), line_, 1 / dt->get<double>(), 1 / dt_, 1 / dt->get<double>()));
  }
  const auto device = line.find("device");
  if (device == line.end()) refuse("no key 'device'");
  if (device->is_null()) return tick;
  TickRecord::Pose pose;
  if (!device->is_array() || device->size() != pose.size()) refuse("'device' is no 12 numbers");
  for (std::size_t i = 0; i < pose.size(); ++i) {
    if (!(*device)[i].is_number()) refuse("'device' is no 12 numbers");
    pose[i] = (*device)[i].get<double>();
  }
  tick.device = to_placement(pose);
  if (!tick.device) refuse("'device' is no rigid motion");
  return tick;
}

}  // namespace ist::cli
