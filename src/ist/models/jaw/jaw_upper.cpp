#include <array>
#include <cmath>

#include "ist/models/jaw/jaw_section.h"
#include "ist/models/jaw/jaw_spline.h"

namespace ist {
namespace {

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
