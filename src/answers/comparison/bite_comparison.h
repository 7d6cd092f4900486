#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "answers/comparison/bite_record.h"
#include "ist/measure/comparison.h"

namespace ist::answers {

/// The questions of a comparison.
struct ComparisonQuestions {
  double within = 2;   ///< millimetres: contacts with centres farther apart are two contacts
  double moved = 0.5;  ///< millimetres: a contact whose centre went farther has moved
  /// The named point of the motion, fixed coordinates, mesh units. Empty: the middle of the moving
  /// body's box in the first bite.
  std::optional<Eigen::Vector3d> about;
};

/// What became of a contact.
enum class ContactFate : std::uint8_t {
  kKept,   ///< it is in both bites
  kMoved,  ///< in both, but its centre moved by more than ComparisonQuestions::moved
  kLost,   ///< in the first bite alone
  kNew,    ///< in the second bite alone
};
/// Returns "kept", "moved", "lost" or "new".
[[nodiscard]] const char* to_string(ContactFate fate);

/// A contact of two bites. Null in the bite that lacks it.
struct ContactChange {
  ContactFate fate = ContactFate::kKept;
  const RecordedContact *before = nullptr, *after = nullptr;
  double moved = 0;  ///< distance of both centres, mesh units; 0 of one

  /// Returns the teeth of the contact as text, such as "16/46", the fixed body's first. A dash
  /// stands for no tooth; empty if neither has one.
  [[nodiscard]] std::string teeth() const;
};

/// A tooth of two bites. Empty in the bite that lacks its label.
struct ToothChange {
  int number = 0;
  std::optional<RecordedTooth> before, after;
};

/// The change of one body.
struct BodyChange {
  std::vector<ToothChange> teeth;  ///< by their numbers; empty if a bite has no labels
};

/// Two bites of the same bodies, and what changed from the first to the second. It refers to both
/// records, so it is not copied.
struct BiteComparison {
  BiteComparison() = default;
  BiteComparison(const BiteComparison&) = delete;
  BiteComparison& operator=(const BiteComparison&) = delete;

  BiteRecord before, after;
  ComparisonQuestions questions;
  PoseChange motion;                    ///< mesh units, fixed coordinates
  bool about_named = false;             ///< whether the user named the point of the motion
  std::vector<ContactChange> contacts;  ///< the first bite's by their numbers, then the new ones
  BodyChange fixed, moving;
  std::vector<std::string> notes;  ///< sentences for people

  [[nodiscard]] std::size_t count(ContactFate fate) const;
  /// Returns whether both bites have the same pose: then nothing changed.
  [[nodiscard]] bool same_pose() const;
  /// Returns the least and the largest change of the certified depth, if both bites have one.
  [[nodiscard]] std::optional<DistanceInterval> depth_change() const;
  /// Returns the least and the largest change of the distance.
  [[nodiscard]] DistanceInterval distance_change() const;
  /// Returns whether areas of each limit can be compared: both bites have the same limits.
  [[nodiscard]] bool same_limits() const { return before.limits == after.limits; }
  /// Returns whether shares by side can be compared: the sides have the same names.
  [[nodiscard]] bool same_sides() const;
};

/// Fills in a comparison whose records and questions are there.
///
/// Throws a Refusal for bites of other meshes (by their hashes and numbers of vertices), of
/// exchanged meshes, of different units, frames, regions, contact distances or foundations, with
/// different numberings of teeth, and with labels on both that share no tooth.
void compare(BiteComparison& comparison);

}  // namespace ist::answers
