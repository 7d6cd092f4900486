#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>

#include "ist/haptics/effects/effect.h"
#include "ist/haptics/simulation.h"
#include "loop/haptics/devices/hand_device.h"
#include "loop/scene/table_reader.h"

namespace ist {

/// The ranges of a scene's numbers: wide enough for any device, and narrow enough to catch a wrong
/// unit or sign. Lengths are in the scene's unit, all else is SI.
inline constexpr NumberRange kRate{1, 1e4, "Hz"};
inline constexpr NumberRange kDuration{1e-3, 1e6, "s"};
inline constexpr NumberRange kInstant{0, 1e6, "s"};
inline constexpr NumberRange kLength{1e-12, 1e12, "in the scene's unit"};
inline constexpr NumberRange kOpening{0, 20, "mm"};
inline constexpr NumberRange kLengthOrNone{0, 1e12, "in the scene's unit"};
inline constexpr NumberRange kArea{0, 1e12, "in the scene's unit squared"};
inline constexpr NumberRange kPlace{-1e12, 1e12, "in the scene's unit"};
inline constexpr NumberRange kStiffness{0, 1e6, "N/m"};
inline constexpr NumberRange kAngularStiffness{0, 1e6, "N m/rad"};
inline constexpr NumberRange kDamping{0, 1e4, "N s/m"};
inline constexpr NumberRange kAngularDamping{0, 1e4, "N m s/rad"};
inline constexpr NumberRange kDelay{0, HandDevice::kLongestDelay, "s"};
inline constexpr NumberRange kMass{1e-6, 1e3, "kg"};
inline constexpr NumberRange kInertia{1e-9, 1e3, "kg m²"};
inline constexpr NumberRange kAcceleration{-1e3, 1e3, "m/s²"};
inline constexpr NumberRange kSteps{1, 10, ""};
inline constexpr NumberRange kFriction{0, 10, ""};
inline constexpr NumberRange kAngle{1e-6, 3.14, "rad"};
inline constexpr NumberRange kAngularResolution{0, 1, "rad"};
inline constexpr NumberRange kForce{1e-6, 1e3, "N"};
inline constexpr NumberRange kTorque{1e-9, 1e3, "N m"};
inline constexpr NumberRange kForceSlew{1e-3, 1e9, "N/s"};
inline constexpr NumberRange kTorqueSlew{1e-6, 1e9, "N m/s"};
inline constexpr NumberRange kSoftStart{0, 60, "s"};
inline constexpr NumberRange kWorkers{1, 2, ""};
inline constexpr NumberRange kSeed{0, std::numeric_limits<double>::infinity(), ""};

/// A number of a table: its key, its place in the settings, its range. The reader of scene files
/// and the check of scenes that programs make go by the same lists.
template <typename Settings>
struct NumberKey {
  const char* name;
  double Settings::*member;
  NumberRange range;
};
inline constexpr NumberKey<DeviceMechanics> kMechanicsKeys[] = {
    {"damping", &DeviceMechanics::damping, kDamping},
    {"angular_damping", &DeviceMechanics::angular_damping, kAngularDamping},
    {"delay", &DeviceMechanics::delay, kDelay}};
inline constexpr NumberKey<CouplingSettings> kCouplingKeys[] = {
    {"stiffness", &CouplingSettings::stiffness, kStiffness},
    {"damping", &CouplingSettings::damping, kDamping},
    {"angular_stiffness", &CouplingSettings::angular_stiffness, kAngularStiffness},
    {"angular_damping", &CouplingSettings::angular_damping, kAngularDamping},
    {"max_force", &CouplingSettings::max_force, kForce},
    {"max_torque", &CouplingSettings::max_torque, kTorque}};
inline constexpr NumberKey<SafetySettings> kSafetyKeys[] = {
    {"max_force", &SafetySettings::max_force, kForce},
    {"max_torque", &SafetySettings::max_torque, kTorque},
    {"force_slew", &SafetySettings::force_slew, kForceSlew},
    {"torque_slew", &SafetySettings::torque_slew, kTorqueSlew},
    {"soft_start", &SafetySettings::soft_start, kSoftStart}};
inline constexpr NumberKey<ContactSettings> kContactKeys[] = {
    {"skin", &ContactSettings::skin, kLengthOrNone},
    {"trust", &ContactSettings::trust, kLengthOrNone}};
inline constexpr NumberKey<FrictionSettings> kFrictionKeys[] = {
    {"coefficient", &FrictionSettings::coefficient, kFriction}};
inline constexpr NumberKey<SnapSettings> kSnapKeys[] = {
    {"stiffness", &SnapSettings::stiffness, kStiffness},
    {"angular_stiffness", &SnapSettings::angular_stiffness, kAngularStiffness},
    {"angle", &SnapSettings::angle, kAngle}};

/// Reads the numbers of a table whose keys are listed. A key that is missing leaves its default.
template <typename Settings, std::size_t kCount>
[[nodiscard]] Settings read_numbers(TableReader table, const NumberKey<Settings> (&keys)[kCount],
                                    std::type_identity_t<Settings> settings = {}) {
  for (const auto& [name, member, range] : keys) {
    settings.*member = table.number(name, range, settings.*member);
  }
  return settings;
}

/// Returns the metres in a unit of length, "m", "cm", "mm", "um" or "inch", or nullopt for another
/// name.
[[nodiscard]] constexpr std::optional<double> metres_in(std::string_view unit) noexcept {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  if (unit == "um") return 1e-6;
  if (unit == "inch") return 0.0254;
  return std::nullopt;
}

}  // namespace ist
