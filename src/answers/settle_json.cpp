#include "answers/settle_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "answers/json_parts.h"
#include "ist/base/angles.h"

namespace ist::answers {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json six(const Vector6& numbers) {
  Json array = Json::array();
  for (Eigen::Index i = 0; i < 6; ++i) array.push_back(numbers[i]);
  return array;
}

// The motion as a screw, fixed coordinates: an axis, an angle in degrees and a way along the axis.
Json screw_of(const Settlement& settled) {
  const Eigen::Vector3d way = settled.moved.head<3>(), turn = settled.moved.tail<3>();
  const double angle = turn.norm();
  if (!(angle > 0)) {
    const double length = way.norm();
    const Eigen::Vector3d axis = length > 0 ? Eigen::Vector3d(way / length) : way;
    return {{"axis", point_json(axis)}, {"point", nullptr}, {"degrees", 0}, {"along", length}};
  }
  const Eigen::Vector3d axis = turn / angle;
  const Eigen::Vector3d start = settled.pose() * settled.load_point - way;
  const double along = axis.dot(way);
  const Eigen::Vector3d across = way - along * axis;
  const auto [sine, cosine] = sine_cosine(0.5 * angle);
  const Eigen::Vector3d point = start + 0.5 * (across + cosine / sine * axis.cross(across));
  return {{"axis", point_json(axis)},
          {"point", point_json(point)},
          {"degrees", angle * 180 / std::numbers::pi},
          {"along", along}};
}

}  // namespace

Json json_of(const Settlement& settled) {
  using Status = Settlement::Status;
  const bool has_pose = settled.status != Status::kInvalidPose &&
                        settled.status != Status::kNoFreePose && settled.status != Status::kBusy;
  Json json{{"status", to_string(settled.status)}, {"rocks", has_pose && settled.rocks}};
  json["pose"] = has_pose ? pose_json(settled.pose()) : Json(nullptr);
  json["free"] = settled.free;
  json["distance_lower"] = has_pose ? Json(settled.distance.lower) : Json(nullptr);
  json["distance_upper"] = has_pose ? finite(settled.distance.upper) : Json(nullptr);
  Json contacts = Json::array();
  for (const SettleContact& contact : settled.contacts) {
    contacts.push_back({{"point", point_json(contact.point)},
                        {"normal", point_json(contact.normal)},
                        {"force", contact.force},
                        {"gap", contact.gap},
                        {"triangles", pair_json(contact.triangles)},
                        {"pairs", contact.pairs}});
  }
  json["contacts"] = std::move(contacts);
  json["residual"] = finite(settled.residual);
  json["remaining"] = finite(settled.remaining);
  json["second_order"] = finite(settled.second_order);
  json["reach"] = settled.reach;
  json["margin"] = finite(settled.margin);
  Json level = Json::array();
  for (const Vector6& direction : settled.level) level.push_back(six(direction));
  json["level"] = std::move(level);
  json["moved"] = has_pose ? Json{{"coordinates", six(settled.moved)}, {"screw", screw_of(settled)}}
                           : Json(nullptr);
  json["closed"] = has_pose ? Json(settled.closed) : Json(nullptr);
  json["load_point"] = point_json(settled.load_point);
  json["radius"] = settled.radius;
  json["guessed"] = {{"load_point", settled.load_guessed}, {"unit", settled.unit_guessed}};
  json["opened"] = settled.opened;
  json["steps"] = settled.steps;
  json["rotation_error"] = finite(settled.rotation_error);
  return json;
}

}  // namespace ist::answers
