#pragma once

#include "ist/scene.h"

namespace ist::test {

/// A ball that a hand puts on a box and pushes along, with all six effects. Millimetres, 1 kHz.
[[nodiscard]] Scene scene_with_all_effects();

}  // namespace ist::test
