#include <array>
#include <cmath>

#include "models/jaw/jaw_section.h"
#include "models/jaw/jaw_spline.h"

namespace ist {
namespace {

// A section's controls run over the crown from tongue to cheek, down the cheek's side, and up
// again.
constexpr std::size_t kFlank = 4;  // controls on each side between the crown and the lower border

using LowerProfile = std::array<double, 16>;  // every kProfileStep from the midline to the condyle

// Heights of the crest (coronoid process, notch, condyle) and of the lower border with the jaw's
// angle.
constexpr LowerProfile kTop{40, 40, 40, 40, 40, 40, 40, 40, 42, 52, 68, 80, 60, 56, 86, 84};
constexpr LowerProfile kBottom{7,  7,    8.5,  11, 13, 14.5, 15.5, 16,
                               16, 16.5, 17.5, 18, 22, 36,   53,   72};
// Half thickness, and outward shift of the middle line, at the crest, half way down and at the
// border.
constexpr std::array<LowerProfile, 3> kThickness{
    LowerProfile{4.6, 4.6, 4.8, 5, 5.4, 6, 6.6, 6.6, 5.5, 4, 2.4, 1.7, 1.6, 1.0, 11.5, 10},
    LowerProfile{4.6, 4.6, 5, 5.4, 5.8, 6.4, 6.8, 6.8, 5.6, 4.4, 3.4, 2.9, 2.7, 2.6, 3.4, 3.6},
    LowerProfile{5.8, 5.6, 5.2, 5, 4.8, 4.8, 4.8, 4.6, 4.2, 3.8, 3.6, 3.6, 3.4, 3, 2.8, 2.8}};
constexpr std::array<LowerProfile, 3> kShift{
    LowerProfile{0, 0, 0, 0, .2, .4, .5, 1, 3, 4.5, 4, 2.5, 1, 0, -1, -1},
    LowerProfile{-.6, -.6, -.4, 0, .8, 1.6, 2.2, 2.8, 3.6, 4, 3.4, 2, 1, .5, 0, 0},
    LowerProfile{2.2, 2, 1.4, 1.2, 1.4, 1.6, 1.6, 2, 3, 4, 4.2, 4, 3.2, 2, 1, 0}};

// The relative depth of each control: along the teeth from the gum, behind them from the crest.
constexpr std::array<double, kFlank + 1> kDentalDepth{0.03, 0.24, 0.52, 0.82, 1};
constexpr std::array<double, kFlank + 1> kPlainDepth{0.46, 0.58, 0.72, 0.88, 1};
constexpr std::array<double, kCrownControls> kCrestDepth{.36, .27, .18, .09, .02, 0,
                                                         .02, .09, .18, .27, .36};
constexpr std::array<double, kCrownControls> kCrestSide{-1, -1, -1, -.95, -.6, 0, .6, .95, 1, 1, 1};

double at_depth(const std::array<LowerProfile, 3>& profiles, double depth, double position) {
  const double top = spline(profiles[0], position), middle = spline(profiles[1], position),
               bottom = spline(profiles[2], position);
  const double up = bump(depth / 0.6), down = bump((1 - depth) / 0.6);
  return middle + up * (top - middle) + down * (bottom - middle);
}

using UpperProfile =
    std::array<double, 10>;  // every kProfileStep from the midline to the tuberosity

// Sections meet the midline at even steps from behind the incisors to the palate's end.
constexpr double kMiddleFront = -36, kMiddleStep = 0.66;
// Heights of the palate and of the nose's floor at the midline.
constexpr UpperProfile kPalate{60.5, 61.2, 63, 65, 66.5, 67.2, 67.5, 67.5, 67.5, 67.5};
constexpr UpperProfile kFloor{68, 68.5, 70, 71.5, 72.5, 73, 73, 73, 73, 73};
// Height and lean of the rim of the nose and the cheek bone; the gum's half thickness and the
// outward shift of its middle line.
constexpr UpperProfile kRim{69, 71, 84, 93, 92, 88, 86, 85, 82, 78};
constexpr UpperProfile kLean{-1.5, -1.5, -2.5, -3.5, -4.5, -5, -5, -5, -5, -5};
constexpr UpperProfile kGum{4.8, 4.8, 5, 5.2, 5.5, 6, 6.5, 6.6, 6.2, 6};
constexpr UpperProfile kMiddleLine{1.6, 1.6, 1.7, 1.8, 1.9, 2, 2, 1.8, 0.5, -1};

constexpr double kGumLine = 57;
constexpr std::array<double, 4> kPalateAcross{0.10, 0.38, 0.66, 0.90};
constexpr std::array<double, 4> kPalateRise{1, 0.97, 0.80, 0.38};

// The cheek bone's process leaves the flank at one place and sweeps outward and back.
constexpr double kProcessAt = 43, kProcessHalfWidth = 11.5;
constexpr std::array<double, 5> kFlankHeight{0.14, 0.26, 0.36, 0.62, 0.74};  // gum 0, rim 1
constexpr std::array<double, 5> kProcessShare{0, 0.28, 1, 1, 0.28};
constexpr double kProcessOut = 25, kProcessBack = 40;

}  // namespace

std::vector<Eigen::Vector3d> lower_section(const Arch& arch, const JawSide& side,
                                           const Station& station) {
  const double position = station.distance / kProfileStep;
  const double crest = spline(kTop, position), bottom = spline(kBottom, position);
  // The crowns fade into the ramus; the ramus ends in a rounded edge.
  const double dental = 1 - smooth_step(station.behind / 0.18);
  const double to_edge = std::max(0.0, (station.behind - 0.84) / 0.16);
  const double rounding = std::sqrt(1 - 0.97 * to_edge * to_edge);
  const double top = crest - 5 * (1 - rounding);
  const double root = bump(station.place) * dental;

  const ArchFrame frame = arch.at(station.distance);
  const auto place = [&](double outward, double z) {
    const Eigen::Vector2d p = frame.point + outward * frame.outward;
    return Eigen::Vector3d(side.mirror * p.x(), p.y(), z);
  };
  const auto bone = [&](double depth, double across) {
    return SectionPoint{at_depth(kShift, depth, position) +
                            across * rounding * at_depth(kThickness, depth, position),
                        top + depth * (bottom - top)};
  };

  std::vector<Eigen::Vector3d> controls;
  const CrownSection crown = crown_section(side.row, station.tooth, station.place);
  for (std::size_t k = 0; k < kCrownControls; ++k) {
    const SectionPoint plain = bone(kCrestDepth[k], kCrestSide[k]);
    controls.push_back(place(plain.outward + dental * (crown[k].outward - plain.outward),
                             plain.rise + dental * (kOcclusalPlane + crown[k].rise - plain.rise)));
  }
  for (std::size_t i = 0; i < 2 * (kFlank + 1); ++i) {
    const bool cheek = i <= kFlank;
    const std::size_t k = cheek ? i : 2 * kFlank + 1 - i;
    const double depth = kPlainDepth[k] + dental * (kDentalDepth[k] - kPlainDepth[k]);
    SectionPoint point = bone(depth, (cheek ? 1 : -1) * (k == kFlank ? 0.62 : 1.0));
    // Roots bulge the bone, most on the cheek's side.
    point.outward += (cheek ? 0.6 : -0.2) * root * bump((depth - 0.16) / 0.3);
    point.outward +=
        0.35 * rounding * unevenness(side.bone_seed, i, side.mirror * station.distance);
    point.rise +=
        k == kFlank ? 0.4 * unevenness(side.bone_seed, 20, side.mirror * station.distance) : 0;
    controls.push_back(place(point.outward, point.rise));
  }
  return controls;
}

std::vector<Eigen::Vector3d> upper_section(const Arch& arch, const JawSide& side,
                                           const Station& station) {
  const double position = station.distance / kProfileStep;
  const double along = side.mirror * station.distance;
  const double dental = 1 - smooth_step(station.behind / 0.7);
  const double rounding = std::sqrt(1 - 0.9 * station.behind * station.behind);
  const double root = bump(station.place) * dental;
  const double gum_line = kGumLine + 6 * (1 - rounding);
  const double rim = spline(kRim, position) - 6 * (1 - rounding);
  const double half = spline(kGum, position) * (0.3 + 0.7 * rounding);
  const double middle_line = spline(kMiddleLine, position);

  const ArchFrame frame = arch.at(station.distance);
  const auto place = [&](double outward, double z) {
    const Eigen::Vector2d p = frame.point + outward * frame.outward;
    return Eigen::Vector3d(side.mirror * p.x(), p.y(), z);
  };
  // Interpolates between the midline, part 0, and a point of the section, part 1.
  const auto across = [&](const Eigen::Vector3d& outer, double part, double z) {
    const double y = kMiddleFront + kMiddleStep * station.distance;
    return Eigen::Vector3d(part * outer.x(), y + part * (outer.y() - y), z);
  };

  std::vector<Eigen::Vector3d> controls;
  const Eigen::Vector3d tongue = place(middle_line - half - 0.6, gum_line + 0.6);
  const double palate = spline(kPalate, position);
  for (std::size_t k = 0; k < kPalateAcross.size(); ++k) {
    const double z = tongue.z() + kPalateRise[k] * (palate - tongue.z()) +
                     0.3 * unevenness(side.bone_seed, k, along);
    controls.push_back(across(tongue, kPalateAcross[k], z));
  }
  controls.push_back(tongue);

  const CrownSection crown = crown_section(side.row, station.tooth, station.place);
  for (std::size_t k = 0; k < kCrownControls; ++k) {
    const double u = static_cast<double>(k) / (kCrownControls - 1) * 2 - 1;
    const SectionPoint plain{middle_line + 0.92 * half * u, gum_line - 1.5 * (1 - u * u)};
    controls.push_back(place(plain.outward + dental * (crown[k].outward - plain.outward),
                             plain.rise + dental * (kOcclusalPlane - crown[k].rise - plain.rise)));
  }
  controls.push_back(place(middle_line + half + 0.5, gum_line + 0.6));

  const double lean = spline(kLean, position);
  const double leaf = bump((station.distance - kProcessAt) / kProcessHalfWidth);
  const double process = leaf * (2 - leaf);
  for (std::size_t k = 0; k < kFlankHeight.size(); ++k) {
    const double h = kFlankHeight[k];
    const double outward = middle_line + half + h * lean + 0.6 * root * bump((h - 0.14) / 0.3) +
                           0.4 * unevenness(side.bone_seed, 8 + k, along);
    Eigen::Vector3d p = place(outward, gum_line + h * (rim - gum_line));
    p.x() += side.mirror * process * kProcessShare[k] * kProcessOut;
    p.y() += process * kProcessShare[k] * kProcessBack;
    controls.push_back(p);
  }
  const Eigen::Vector3d crest = place(middle_line + half + lean - 1.5, rim);
  const double floor = spline(kFloor, position);
  controls.push_back(crest);
  controls.push_back(across(crest, 0.72, floor + 0.55 * (rim - floor)));
  controls.push_back(across(crest, 0.40, floor));
  controls.push_back(across(crest, 0.10, floor));
  return controls;
}

}  // namespace ist
