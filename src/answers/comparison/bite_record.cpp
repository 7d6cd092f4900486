#include "answers/comparison/bite_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "answers/json_file.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"
#include "ist/mesh/mesh.h"

namespace ist::answers {
namespace {

using nlohmann::ordered_json;

constexpr const char* kBiteRemedy = "give a file that ist occlusion -o FILE.json wrote";

// An object of the file, and its place in it.
class Fields {
 public:
  Fields(const ordered_json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object())
      throw_error(ErrorCode::kInputInvalid, "{} no object; {}", place_, kBiteRemedy);
  }

  [[nodiscard]] double number(const char* key) const {
    const ordered_json& value = at(key);
    if (!value.is_number() || !std::isfinite(value.get<double>())) fail(key, "no number");
    return value.get<double>();
  }
  [[nodiscard]] std::optional<double> number_if_any(const char* key) const {
    return at(key).is_null() ? std::nullopt : std::optional(number(key));
  }
  [[nodiscard]] double positive(const char* key) const {
    const double value = number(key);
    if (!(value > 0)) fail(key, "not above 0");
    return value;
  }
  [[nodiscard]] std::size_t count(const char* key) const {
    const ordered_json& value = at(key);
    if (!value.is_number_integer() || value < 0) fail(key, "no whole number from 0 on");
    return value.get<std::size_t>();
  }
  [[nodiscard]] int tooth(const char* key) const {
    if (at(key).is_null()) return 0;
    const std::size_t number = count(key);
    if (number > 99) fail(key, "no number of a tooth");
    return static_cast<int>(number);
  }
  [[nodiscard]] bool truth(const char* key) const {
    if (!at(key).is_boolean()) fail(key, "neither true nor false");
    return at(key).get<bool>();
  }
  [[nodiscard]] std::string text(const char* key) const {
    if (!at(key).is_string()) fail(key, "no text");
    return at(key).get<std::string>();
  }
  [[nodiscard]] std::string text_if_any(const char* key) const {
    return at(key).is_null() ? "" : text(key);
  }
  [[nodiscard]] std::vector<double> numbers(const char* key) const {
    std::vector<double> numbers;
    for (const ordered_json& value : list(key)) {
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        fail(key, "no list of numbers");
      numbers.push_back(value.get<double>());
    }
    return numbers;
  }
  [[nodiscard]] std::vector<double> numbers(const char* key, std::size_t size) const {
    std::vector<double> numbers = this->numbers(key);
    if (numbers.size() != size) fail(key, fmt::format("no list of {} numbers", size));
    return numbers;
  }
  [[nodiscard]] Eigen::Vector3d point(const char* key) const {
    return Eigen::Vector3d(numbers(key, 3).data());
  }
  [[nodiscard]] const ordered_json& list(const char* key) const {
    if (!at(key).is_array()) fail(key, "no list");
    return at(key);
  }
  [[nodiscard]] bool has(const char* key) const { return !at(key).is_null(); }
  [[nodiscard]] Fields object(const char* key) const { return {at(key), inner(key)}; }
  // The objects of a list.
  [[nodiscard]] std::vector<Fields> objects(const char* key) const {
    std::vector<Fields> objects;
    for (const ordered_json& value : list(key)) {
      objects.emplace_back(value, fmt::format("{}[{}]", inner(key), objects.size()));
    }
    return objects;
  }
  [[nodiscard]] std::vector<std::string> keys() const {
    std::vector<std::string> keys;
    for (const auto& item : json_.items()) keys.push_back(item.key());
    return keys;
  }
  [[noreturn]] void fail(const char* key, const std::string& what) const {
    throw_error(ErrorCode::kInputInvalid, "{} is {}; {}", inner(key), what, kBiteRemedy);
  }

 private:
  [[nodiscard]] const ordered_json& at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) fail(key, "missing");
    return *found;
  }
  [[nodiscard]] std::string inner(const char* key) const {
    return fmt::format("{}{}{}", place_, place_.ends_with(':') ? " " : ".", key);
  }

  const ordered_json& json_;
  std::string place_;
};

double units_per_mm(const Fields& bite) {
  const std::optional<LengthUnit> unit = length_unit(bite.text("unit"));
  if (!unit || *unit == LengthUnit::kUnknown) bite.fail("unit", "no unit of length");
  return 1e-3 / metres_per_unit(*unit);
}

Eigen::Isometry3d pose_of(const Fields& bite) {
  Eigen::Isometry3d pose;
  const std::vector<double> numbers = bite.numbers("pose", 16);
  std::copy(numbers.begin(), numbers.end(), pose.data());
  const std::optional<Eigen::Isometry3d> rigid = project_to_rigid(pose);
  if (!rigid) bite.fail("pose", "no rigid motion");
  return *rigid;
}

// Shares of both sides, per cent, and the names of the sides.
std::vector<double> shares_of(const Fields& body, const char* key,
                              std::pair<std::string, std::string>& names) {
  if (!body.has(key)) return {};
  const Fields shares = body.object(key).object("per_cent");
  const std::vector<std::string> keys = shares.keys();
  if (keys.size() != 3) body.fail(key, "without two sides");
  names = {keys[0], keys[1]};
  return {shares.number(keys[0].c_str()), shares.number(keys[1].c_str())};
}

RecordedContact contact_of(const Fields& given) {
  RecordedContact contact;
  contact.number = given.count("number");
  contact.on_fixed = !given.list("fixed").empty();
  contact.on_moving = !given.list("moving").empty();
  contact.area = given.number("area");
  contact.overlap = given.number("penetrating_area");
  contact.depth_integral = given.number("depth_integral");
  contact.share = given.number("share");
  contact.least_distance = given.number("least_distance");
  contact.centre = given.point("centre");
  contact.closest = given.point("closest");
  const Fields teeth = given.object("teeth");
  contact.fixed_tooth = teeth.tooth("fixed");
  contact.moving_tooth = teeth.tooth("moving");
  return contact;
}

RecordedBody body_of(const Fields& given, BiteRecord& bite) {
  RecordedBody body;
  body.name = given.text("file");
  body.hash = given.text_if_any("hash");
  body.vertices = given.count("vertices");
  const std::vector<double> box = given.numbers("box", 6);
  body.box = {Eigen::Vector3d(box.data()), Eigen::Vector3d(box.data() + 3)};
  for (const Fields& region : given.objects("regions")) body.area += region.number("area");
  body.overlap = given.number("penetrating_area");
  body.depth_integral = given.number("depth_integral");
  body.deepest = given.number_if_any("depth_at_vertices");
  for (const Fields& limit : given.objects("areas")) body.areas.push_back(limit.number("area"));
  if (body.areas.size() != bite.limits.size()) given.fail("areas", "not one for each limit");
  body.side = shares_of(given, "sides", bite.side_names);
  body.fore_aft = shares_of(given, "fore_aft", bite.fore_aft_names);
  for (const Fields& tooth : given.objects("teeth")) {
    body.teeth.push_back({tooth.tooth("number"), tooth.number("area"), tooth.number("share"),
                          tooth.number_if_any("least_distance")});
  }
  return body;
}

}  // namespace

BiteRecord record_of(const ordered_json& json, std::string_view name) {
  const Fields given(json, fmt::format("{}:", name));
  constexpr std::size_t kSchema = 1;
  if (given.count("schema") != kSchema) {
    given.fail("schema",
               fmt::format("{}, and this version of IST reads {}", given.count("schema"), kSchema));
  }
  BiteRecord bite;
  bite.name = name;
  bite.unit = given.text("unit");
  bite.unit_assumed = given.truth("unit_assumed");
  bite.units_per_mm = units_per_mm(given);
  bite.frame = given.text_if_any("frame");
  bite.numbering = given.text_if_any("numbering");
  bite.pose = pose_of(given);
  bite.reach = given.positive("reach");
  bite.contact = given.positive("contact");
  bite.foundation = given.object("foundation").positive("depth");
  bite.limits = given.object("preset").numbers("micrometres");
  if (given.has("region")) bite.region = given.numbers("region", 6);
  bite.touch = given.text("touch");
  bite.distance = {given.number("distance_lower"), given.number("distance_upper")};
  if (given.has("depth_lower")) {
    bite.depth = DistanceInterval{given.number("depth_lower"), given.number("depth_upper")};
  }
  bite.warning = given.text_if_any("warning");
  bite.fixed = body_of(given.object("fixed"), bite);
  bite.moving = body_of(given.object("moving"), bite);
  for (const Fields& contact : given.objects("contacts")) {
    bite.contacts.push_back(contact_of(contact));
  }
  return bite;
}

BiteRecord read_bite(const std::filesystem::path& file) {
  return record_of(read_json(file, kBiteRemedy), file.string());
}

}  // namespace ist::answers
