#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "answers/formats/format.h"
#include "answers/refusals.h"
#include "cli/occlusion/figure/canvas.h"
#include "cli/output_files.h"

namespace ist::cli {

/// Returns the kind of a figure of that format; nothing if the format is none of a figure.
[[nodiscard]] inline std::optional<FigureKind> figure_kind(answers::FileFormat format) {
  switch (format) {
    case answers::FileFormat::kPng:
      return FigureKind::kPng;
    case answers::FileFormat::kSvg:
      return FigureKind::kSvg;
    case answers::FileFormat::kPdf:
      return FigureKind::kPdf;
    default:
      return std::nullopt;
  }
}

/// Throws a Refusal, before anything is measured, if a file is a figure and the build has no cairo.
inline void check_figures(const OutputFiles& outputs,
                          std::span<const std::filesystem::path> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (figure_kind(outputs.all()[i].format) && !has_canvas()) refuse_without_canvas(names[i]);
  }
}

}  // namespace ist::cli
