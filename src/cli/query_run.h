#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "answers/answer.h"
#include "answers/bodies.h"
#include "cli/query_options.h"

namespace ist::cli {

/// A pose to ask for, and along a path its displacement, mesh units.
struct AskedPose {
  Eigen::Isometry3d pose;
  std::optional<double> displacement{};
  double rotation_error = 0;  ///< of the matrix that was given
};

/// Asks people's questions once at each pose, and runs every engine `repeat` times round the whole
/// list with the engines in turn; prints the answers, and writes contacts if a file is named. With
/// --verify, runs each engine at each pose once more and checks those answers before a line is
/// printed or the file appears. Returns how the bodies meet where they do so most certainly.
[[nodiscard]] answers::Meeting run_queries(const answers::Bodies& bodies,
                                           const std::vector<AskedPose>& poses,
                                           const QuestionOptions& options);

/// Throws a Failure of kTouching, which says how the bodies meet; of kFailed if that is unknown;
/// nothing if they are apart.
void fail_where_they_meet(answers::Meeting meeting);

}  // namespace ist::cli
