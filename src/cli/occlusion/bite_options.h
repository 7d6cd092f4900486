#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "answers/bodies.h"
#include "answers/occlusion/bite_maker.h"
#include "cli/cli11_fwd.h"
#include "cli/load_bodies.h"

namespace ist::cli {

/// The name of a preset whose limits the user named.
inline constexpr std::string_view kOwnPreset = "own";

/// The options of a bite in the words of a user.
struct BiteOptions {
  BodyFiles files;
  answers::BiteQuestions questions;
  std::string preset{answers::presets().front().name};
  std::string limits, numbering, region;
  std::vector<double> own_limits;  ///< of `own`, micrometres
  answers::Preset own;             ///< with `limits`
};

/// Adds the options that say what is measured: --preset, --limits, --reach, --scanner-band,
/// --region, units and frame.
void add_measure_options(CLI::App& command, BiteOptions& options);

/// Adds the options about the patient: sides and teeth.
void add_patient_options(CLI::App& command, BiteOptions& options);

/// Returns the questions of the options. Reads no file. The questions refer to `options`, if it
/// holds limits. Throws a Refusal.
[[nodiscard]] answers::BiteQuestions questions_of(BiteOptions& options);

/// Returns the names and hashes of the files of two bodies.
[[nodiscard]] answers::BiteSources sources_of(const answers::Bodies& bodies,
                                              const BodyFiles& files);

}  // namespace ist::cli
