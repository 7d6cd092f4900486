#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "answers/occlusion/bite.h"

namespace ist::answers {

/// Returns a sentence if the bodies are no pair of jaws in a bite. Nothing of them is within the
/// reach, and their surfaces are farther apart than half the size of the smaller body: then they
/// are hardly in one coordinate system. Or near surfaces face the same way, as two scans of one jaw
/// do. Or the bodies overlap by more than 2 mm. Else returns nothing.
[[nodiscard]] std::optional<std::string> warning_of(const Bite& bite);

/// Returns a sentence about contacts far from the arch, as the joints are: their numbers, and the
/// --region that leaves them out. Returns nothing if no contact is far.
///
/// Contacts with gaps of at most a third of the fixed body's largest extent hang together, and the
/// group with the most area is the arch. Another contact is far if the line to the nearest contact
/// of the arch also rises by more than 25° out of the occlusal plane: so the other side of an arch
/// is not far.
[[nodiscard]] std::optional<std::string> hint_of(const Bite& bite);

/// Returns a sentence about the region of a bite. Precondition: it has one.
[[nodiscard]] std::string region_words(const Bite& bite);

/// Returns the sentences that every file of a bite holds: its warning, its region and its hint.
[[nodiscard]] std::vector<std::string> remarks_of(const Bite& bite);

/// Returns all sentences about a bite: its remarks and its checks.
[[nodiscard]] std::vector<std::string> notes_of(const Bite& bite);

/// Returns a box in words: "x -5 to 5, y -5 to 5, z -3 to 0".
[[nodiscard]] std::string box_words(const Eigen::AlignedBox3d& box);

}  // namespace ist::answers
