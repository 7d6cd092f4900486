#pragma once

#include <optional>
#include <string>
#include <vector>

#include "answers/comparison/bite_comparison.h"
#include "answers/comparison/change_map.h"
#include "answers/occlusion/bite.h"
#include "answers/occlusion/map_scale.h"
#include "cli/occlusion/figure/canvas.h"
#include "ist/base/files.h"

namespace ist::cli {

/// How the colours of a figure follow the distance.
struct FigureOptions {
  bool continuous = false;  ///< else in the bands of the preset
  /// Both ends of a continuous scale, mesh units: one range makes a series of figures comparable.
  /// Empty: from the least distance to the reach, rounded outwards.
  std::optional<std::pair<double, double>> range = std::nullopt;
};

/// Returns the scale of a bite's figure.
[[nodiscard]] answers::MapScale scale_of(const answers::Bite& bite, const FigureOptions& options);

/// Returns the scale of a map of change: to `most` mesh units either way, or to the largest change,
/// rounded up.
[[nodiscard]] answers::MapScale scale_of(const answers::ChangeMap& map, double reach,
                                         const std::optional<double>& most);

/// Writes a figure of a bite, 170 mm wide, as a page of a journal is: both distance maps from their
/// occlusal sides, with the names of the sides, a bar of length and the numbers of the contacts;
/// below them a legend, and a histogram of the distances. PNG has 300 dots per inch; in SVG and PDF
/// the maps are pictures of 300 dots per inch, and all else is drawn. A bite without contact gives
/// a figure that says so.
///
/// Throws kFileUnwritable, what a Canvas throws, and a Refusal in a build without cairo.
void write_bite_figure(const answers::Bite& bite, const answers::MapScale& scale, FigureKind kind,
                       OutputFile& file);

/// Writes a figure of a comparison likewise: the change of the distance on both bodies at the
/// second pose. Contacts have their numbers of the second bite. A lost contact is a cross, with its
/// number of the first bite in brackets.
void write_change_figure(const answers::Bite& after, const answers::BiteComparison& comparison,
                         const answers::ChangeMap& map, const answers::MapScale& scale,
                         FigureKind kind, OutputFile& file);

}  // namespace ist::cli
