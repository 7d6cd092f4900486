#pragma once

namespace ist::test {

/// The ticks of each scene.
inline constexpr int kTicks = 200;

/// Counts the ticks of scenes with one fixed and one held body: a ball that is pressed on a box and
/// slides. In the one scene contacts push alone, the other has every effect.
void count_ticks();

}  // namespace ist::test
