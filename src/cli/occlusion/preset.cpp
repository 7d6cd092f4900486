#include "cli/occlusion/preset.h"

#include <array>

namespace ist::cli {
namespace {

constexpr double kScan[] = {0, 100};
constexpr double kOwens[] = {50, 350};
constexpr double kBiteEye[] = {9, 29, 59, 89, 149};
constexpr double kPaper[] = {200};
constexpr double kStl[] = {100, 200, 300, 400};
constexpr double kShim[] = {10};

constexpr std::array<Preset, 6> kPresets{{
    {"scan", kScan, "intersection and contact of scans: Beck 2023"},
    {"owens", kOwens, "contact and near contact, of silicone bites: Owens 2002"},
    {"biteeye", kBiteEye, "bands of silicone bites: BiteEye, J Oral Rehabil 2022"},
    {"paper", kPaper, "articulating paper of 200 µm: Rovira-Lastra 2026"},
    {"stl", kStl, "steps of 100 µm, of scans: Rovira-Lastra 2026"},
    {"shim", kShim, "shim stock holds at 10 µm: DeLong 2007"},
}};

}  // namespace

std::span<const Preset> presets() { return kPresets; }

}  // namespace ist::cli
