#include "viewer/engine/asked.h"

#include "ist/base/error.h"
#include "ist/base/pose.h"
#include "ist/base/throw_error.h"

namespace ist::viewer {

Asked::Asked(const std::string& text)
    : members_(nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false)) {
  if (!members_.is_object()) {
    throw Error(ErrorCode::kArgumentInvalid, "the page asked without members");
  }
}

const nlohmann::json* Asked::find(const char* name) const {
  const auto found = members_.find(name);
  return found == members_.end() || found->is_null() ? nullptr : &*found;
}

void Asked::refuse(const char* name, const char* wanted) {
  throw_error(ErrorCode::kArgumentInvalid, "{}: give {}", name, wanted);
}

double Asked::number(const char* name) const {
  const nlohmann::json* found = find(name);
  if (found == nullptr || !found->is_number()) refuse(name, "a number");
  return found->get<double>();
}

std::uint64_t Asked::count(const char* name) const {
  const nlohmann::json* found = find(name);
  if (found == nullptr || !found->is_number_unsigned()) refuse(name, "a whole number from 0 on");
  return found->get<std::uint64_t>();
}

std::string Asked::text(const char* name) const {
  const nlohmann::json* found = find(name);
  if (found == nullptr || !found->is_string()) refuse(name, "a text");
  return found->get<std::string>();
}

std::string Asked::text_or_none(const char* name) const {
  return find(name) == nullptr ? std::string() : text(name);
}

std::optional<double> Asked::number_or_none(const char* name) const {
  if (find(name) == nullptr) return std::nullopt;
  return number(name);
}

Eigen::Isometry3d Asked::pose(const char* name) const {
  const nlohmann::json* found = find(name);
  if (found == nullptr || !found->is_array() || found->size() != 16) {
    refuse(name, "16 numbers, column by column");
  }
  Eigen::Isometry3d pose;
  for (std::size_t i = 0; i < 16; ++i) {
    if (!(*found)[i].is_number()) refuse(name, "16 numbers, column by column");
    pose.matrix().data()[i] = (*found)[i].get<double>();
  }
  if (!project_to_rigid(pose)) {
    throw_error(ErrorCode::kPoseInvalid, "{}: it is no rigid motion: {}", name,
                why_not_rigid(pose));
  }
  return pose;
}

Role Asked::role() const {
  const std::string role = text("role");
  if (role != "fixed" && role != "moving") refuse("role", "fixed or moving");
  return role == "fixed" ? Role::kFixed : Role::kMoving;
}

std::optional<SpherePolicy> Asked::policy() const {
  const std::string name = text_or_none("policy");
  if (name.empty()) return std::nullopt;
  const std::optional<SpherePolicy> policy = sphere_policy(name);
  if (!policy) refuse("policy", "simple, table, tight or slab");
  return policy;
}

LengthUnit Asked::unit() const {
  const std::string name = text_or_none("unit");
  if (name.empty()) return LengthUnit::kUnknown;
  const std::optional<LengthUnit> unit = length_unit(name);
  if (!unit) refuse("unit", "mm, m, inch or µm");
  return *unit;
}

PatientFrame Asked::to_frame() const {
  const std::string name = text_or_none("to_frame");
  if (name.empty()) return PatientFrame::kUnknown;
  const std::optional<PatientFrame> frame = patient_frame(name);
  if (!frame) refuse("to_frame", "ras or lps");
  return *frame;
}

}  // namespace ist::viewer
