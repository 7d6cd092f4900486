#pragma once

#include "cli/cli11_fwd.h"

/// The subcommands, one file each. Each function adds a subcommand's options and action to `app`.
/// Data goes to stdout, everything else to stderr; a failure is an ist::Error, a Refusal or a
/// CLI::Error, which main alone catches.
namespace ist::cli {

void add_demo(CLI::App& app);
void add_build(CLI::App& app);
void add_info(CLI::App& app);
void add_export(CLI::App& app);
void add_collide(CLI::App& app);
void add_approach(CLI::App& app);
void add_occlusion(CLI::App& app);
void add_settle(CLI::App& app);
void add_compare(CLI::App& app);
void add_run(CLI::App& app);
void add_view(CLI::App& app);
void add_sweep(CLI::App& app);
void add_advise(CLI::App& app);
void add_bench(CLI::App& app);
void add_table(CLI::App& app);

}  // namespace ist::cli
