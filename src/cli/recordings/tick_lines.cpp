#include "cli/recordings/tick_lines.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "answers/json_parts.h"
#include "ist/base/throw_error.h"

namespace ist::cli {

using namespace answers;

namespace {

constexpr std::size_t kFlush = 1 << 16;  // bytes

constexpr const char* kCsvBegin =
    "tick,dt,device_known,device_x,device_y,device_z,device_xx,device_xy,device_xz,device_yx,"
    "device_yy,device_yz,device_zx,device_zy,device_zz,tool_x,tool_y,tool_z,tool_xx,tool_xy,"
    "tool_xz,tool_yx,tool_yy,tool_yz,tool_zx,tool_zy,tool_zz,force_x,force_y,force_z,torque_x,"
    "torque_y,torque_z,contacts,leaf_pairs,complete,proximity_complete,held,fault,"
    "steps,halved,points,points_force_x,points_force_y,points_force_z";
// The columns of a point. Each has the prefix "pointN_".
constexpr std::array kPointColumns{
    "x",       "y",       "z",   "normal_x",       "normal_y",      "normal_z",   "force_x",
    "force_y", "force_z", "gap", "triangle_fixed", "triangle_held", "body_fixed", "body_held"};
constexpr const char* kCsvEnd = ",late_microseconds,microseconds,cpu_microseconds\n";

std::string csv_header() {
  std::string header = kCsvBegin;
  for (std::size_t point = 1; point <= Tick::kMostPoints; ++point) {
    for (const char* column : kPointColumns) header += fmt::format(",point{}_{}", point, column);
  }
  return header + kCsvEnd;
}

std::span<const ContactRecord> points_of(const TickRecord& record) {
  return std::span(record.points).first(record.point_count);
}

double microseconds(std::int64_t nanoseconds) { return 1e-3 * static_cast<double>(nanoseconds); }

// Calls `use` with name and value of each number between the wrench and the points. A value is
// empty if its query was not made.
template <typename Use>
void for_each_number(const TickRecord& record, const Use& use) {
  const auto of = [](const auto* result, auto member) {
    return result != nullptr ? std::optional(result->*member) : std::nullopt;
  };
  const auto* contacts = record.contacts ? &*record.contacts : nullptr;
  const auto* proximity = record.proximity ? &*record.proximity : nullptr;
  // The clock decided the numbers of a query that a deadline ended.
  const bool known = contacts != nullptr && contacts->complete;
  use("contacts", of(known ? contacts : nullptr, &QueryResult::leaf_pairs));
  use("leaf_pairs", std::optional(record.leaf_pairs));
  use("complete", of(contacts, &QueryResult::complete));
  use("proximity_complete", of(proximity, &QueryResult::complete));
  use("held", std::optional(record.held));
  use("fault", std::optional(record.fault));
  use("steps", std::optional(record.steps));
  use("halved", std::optional(record.halved));
}

// The same for the numbers behind the points.
template <typename Use>
void for_each_time(const TickRecord& record, const Use& use) {
  use("late_microseconds", std::optional(microseconds(record.late_ns)));
  use("microseconds", std::optional(microseconds(record.execution_ns)));
  use("cpu_microseconds", std::optional(microseconds(record.cpu_ns)));
}

void append_json(const TickRecord& record, std::string& lines) {
  const auto end = std::back_inserter(lines);
  fmt::format_to(end, "{{\"tick\":{},\"dt\":{},\"device\":", record.tick, record.dt);
  if (record.device_known) {
    fmt::format_to(end, "[{}]", fmt::join(record.device, ","));
  } else {
    lines += "null";
  }
  fmt::format_to(end, ",\"tool\":[{}],\"wrench\":[{}]", fmt::join(record.tool, ","),
                 fmt::join(record.wrench, ","));
  const auto append = [&](const char* name, const auto& value) {
    fmt::format_to(end, ",\"{}\":", name);
    if (value) {
      fmt::format_to(end, "{}", *value);
    } else {
      lines += "null";
    }
  };
  for_each_number(record, append);
  lines += ",\"points\":[";
  const char* before = "";
  for (const ContactRecord& point : points_of(record)) {
    fmt::format_to(end,
                   "{}{{\"position\":[{}],\"normal\":[{}],\"force\":[{}],\"gap\":{},"
                   "\"triangles\":[{},{}],\"bodies\":[{},{}]}}",
                   std::exchange(before, ","), fmt::join(point.position, ","),
                   fmt::join(point.normal, ","), fmt::join(point.force, ","), point.gap,
                   point.fixed_triangle, point.held_triangle, point.fixed, point.held);
  }
  lines += ']';
  for_each_time(record, append);
  lines += "}\n";
}

void append_csv(const TickRecord& record, std::string& lines) {
  const auto end = std::back_inserter(lines);
  fmt::format_to(end, "{},{},{},{},{},{}", record.tick, record.dt, record.device_known ? 1 : 0,
                 fmt::join(record.device, ","), fmt::join(record.tool, ","),
                 fmt::join(record.wrench, ","));
  const auto append = [&](const char*, const auto& value) {
    lines += ',';
    if (value) fmt::format_to(end, "{}", +*value);  // + makes a flag 0 or 1
  };
  for_each_number(record, append);
  std::array<double, 3> force{};
  for (const ContactRecord& point : points_of(record)) {
    for (std::size_t axis = 0; axis < 3; ++axis) force[axis] += point.force[axis];
  }
  fmt::format_to(end, ",{},{}", record.point_count, fmt::join(force, ","));
  for (const ContactRecord& point : points_of(record)) {
    fmt::format_to(end, ",{},{},{},{},{},{},{},{}", fmt::join(point.position, ","),
                   fmt::join(point.normal, ","), fmt::join(point.force, ","), point.gap,
                   point.fixed_triangle, point.held_triangle, point.fixed, point.held);
  }
  lines.append((Tick::kMostPoints - record.point_count) * kPointColumns.size(), ',');
  for_each_time(record, append);
  lines += '\n';
}

}  // namespace

TickWriter::TickWriter(const std::filesystem::path& file, const RecordingHeader& header)
    : file_(file), csv_(file.extension() == ".csv"), names_(header.body_names()) {
  lines_ += csv_ ? csv_header() : header.line() + '\n';
}

void TickWriter::append_change(const TickRecord& record) {
  const HandChange& change = *record.change;
  const nlohmann::ordered_json line{{"tick", record.tick},
                                    {change.attach ? "attach" : "release", names_[change.body]},
                                    {"status", to_string(change.status)}};
  lines_ += json_text(line) + '\n';
}

void TickWriter::write(const TickRecord& record) {
  if (record.change && !csv_) append_change(record);
  csv_ ? append_csv(record, lines_) : append_json(record, lines_);
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

TickReader::TickReader(std::filesystem::path file, RecordingHeader header)
    : lines_(std::move(file)), header_(std::move(header)) {}

void TickReader::refuse(const std::string& what) const {
  throw_error(ErrorCode::kInputInvalid, "{}:{}: {}: give a file that --record wrote as JSON lines",
              lines_.path().string(), line_, what);
}

std::optional<std::string> TickReader::next_line(const std::atomic<bool>& stop) {
  std::optional<std::string> text = lines_.next(stop);
  if (!text) return text;
  ++line_;
  bytes_read_ += text->size() + 1;
  return text;
}

std::optional<RecordedTick> TickReader::next(const std::atomic<bool>& stop) {
  RecordedTick tick{};
  nlohmann::json line;
  for (;;) {
    const std::optional<std::string> text = next_line(stop);
    if (!text) return std::nullopt;
    line = nlohmann::json::parse(*text, nullptr, /*allow_exceptions=*/false);
    if (!line.is_object()) refuse("not a JSON object");
    if (line_ == 1) {
      header_.check(line, lines_.path());
    } else if (line.contains("attach") || line.contains("release")) {
      // The scene plans its changes itself; a deadline may have ended the query of one.
      const auto status = line.find("status");
      if (status == line.end() || !status->is_string()) refuse("a change without a text 'status'");
      if (*status == to_string(ChangeStatus::kUnfinished)) tick.budget.change.tests = 0;
    } else {
      break;
    }
  }
  const auto value = [&](const char* key) -> const nlohmann::json& {
    const auto found = line.find(key);
    if (found == line.end()) refuse(fmt::format("no key '{}'", key));
    return *found;
  };
  const nlohmann::json& number = value("tick");
  if (!number.is_number_unsigned()) refuse("'tick' is not a whole number");
  tick.tick = number.get<std::uint64_t>();
  const auto limit = [&](const char* key, Budget& budget) {
    const nlohmann::json& complete = value(key);
    if (!complete.is_null() && !complete.is_boolean()) {
      refuse(fmt::format("'{}' is neither true, false nor null", key));
    }
    if (complete == false) budget.tests = 0;
  };
  limit("proximity_complete", tick.budget.proximity);
  const nlohmann::json& held = value("held");
  if (!held.is_boolean()) refuse("'held' is neither true nor false");
  const nlohmann::json& steps = value("steps");
  if (!steps.is_number_unsigned() || steps > std::numeric_limits<int>::max()) {
    refuse("'steps' is not a whole number");
  }
  if (held == true) tick.budget.steps = steps.get<int>();
  // A tick with steps makes them again in full. A tick without steps searches nothing.
  Budget none;
  limit("complete", steps == 0 ? tick.budget.contacts : none);

  const auto dt = line.find("dt");
  if (dt == line.end() || !dt->is_number()) refuse("no number 'dt'");
  const double own = header_.dt();
  if (dt->get<double>() != own) {
    throw_error(
        ErrorCode::kInputInvalid,

        "{}:{}: it was recorded at {:.6g} Hz, and the scene runs at {:.6g}: give --rate {:.6g}",
        lines_.path().string(), line_, 1 / dt->get<double>(), 1 / own, 1 / dt->get<double>());
  }
  const auto device = line.find("device");
  if (device == line.end()) refuse("no key 'device'");
  if (device->is_null()) return tick;
  TickRecord::Pose pose;
  if (!device->is_array() || device->size() != pose.size())
    refuse("'device' is not an array of 12 numbers");
  for (std::size_t i = 0; i < pose.size(); ++i) {
    if (!(*device)[i].is_number()) refuse("'device' is not an array of 12 numbers");
    pose[i] = (*device)[i].get<double>();
  }
  tick.device = to_placement(pose);
  if (!tick.device) refuse("'device' is not a rigid motion");
  return tick;
}

}  // namespace ist::cli
