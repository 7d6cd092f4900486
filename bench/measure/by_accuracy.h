#pragma once

namespace ist::bench {

/// by_accuracy/touch/0/POSE, by_accuracy/distance/TOLERANCE/POSE and
/// by_accuracy/depth/TOLERANCE/POSE: what exact touch, the distance and the depth take, each
/// afresh, and how wide their intervals are. An interval that does not hold what the finest
/// tolerance found ends the benchmark.
void add_by_accuracy();

}  // namespace ist::bench
