#include "models/jaw/jaw_tooth.h"

#include <algorithm>
#include <cmath>

#include "models/jaw/jaw_spline.h"

namespace ist {
namespace {

// A silhouette from tongue to cheek: outward in half depths, rise in heights above the gum.
struct Silhouette {
  std::array<double, kCrownControls> outward, rise;
};

constexpr Silhouette kMolar{{-.88, -1.04, -1.10, -.94, -.54, 0, .54, .94, 1.10, 1.04, .88},
                            {0, .22, .54, .90, 1.0, .60, 1.0, .90, .54, .22, 0}};
constexpr Silhouette kPremolar{{-.86, -1.03, -1.08, -.92, -.52, 0, .52, .92, 1.08, 1.04, .86},
                               {0, .22, .52, .82, .92, .66, 1.0, .88, .56, .24, 0}};
constexpr Silhouette kFront{{-1.0, -1.06, -.92, -.58, -.26, -.02, .22, .58, .90, 1.06, 1.0},
                            {0, .20, .42, .68, .94, 1.06, .98, .72, .44, .20, 0}};

const Silhouette& silhouette(ToothKind kind) {
  if (kind == ToothKind::kMolar) return kMolar;
  return kind == ToothKind::kPremolar ? kPremolar : kFront;
}

// Returns the height that the cusps, the ridges and the fissure add to one control; mm.
double relief(ToothKind kind, std::size_t control, double place, double wear) {
  const double sharp = 1 - wear;
  const double middle = bump(place), ends = place * place;
  // Two cusps, one behind the other, with a groove between them that runs out over the cheek's
  // side.
  const double pair = bump((place - 0.48) / 0.50) + bump((place + 0.48) / 0.50);
  switch (kind) {
    case ToothKind::kMolar:
      if (control == 4 || control == 6) return sharp * (1.9 * pair - 0.9);
      if (control == 3 || control == 7) return 0.9 * pair - 0.6;
      if (control == 5) return 1.2 * ends - 0.5 * sharp * middle;
      return 0;
    case ToothKind::kPremolar:
      if (control == 6) return sharp * (2.3 * middle - 1.0);
      if (control == 4) return sharp * (1.7 * middle - 0.9);
      if (control == 7) return 0.8 * middle - 0.4;
      if (control == 5) return 1.3 * ends;
      return 0;
    case ToothKind::kCanine:
      return control >= 4 && control <= 6 ? sharp * (2.4 * middle - 1.4) : 0;
    case ToothKind::kIncisor:
      return control >= 4 && control <= 6 ? 0.25 * pair - 0.2 : 0;
  }
  return 0;
}

// Returns the crown as if it continued unchanged to both ends.
CrownSection full_crown(const Tooth& tooth, double place) {
  const ToothShape& shape = tooth.shape;
  const Silhouette& outline = silhouette(shape.kind);
  CrownSection section;
  for (std::size_t k = 0; k < kCrownControls; ++k) {
    const double rise = outline.rise[k];
    // The groove between two cusps dents the molar's flank as well.
    const double dent =
        shape.kind == ToothKind::kMolar && k != 5 ? 0.07 * bump(place / 0.3) * rise : 0;
    section[k].outward = shape.lateral + shape.depth / 2 * outline.outward[k] * (1 - dent) +
                         shape.edge * rise + tooth.turn * place;
    section[k].rise =
        shape.tip - shape.height * (1 - rise) + relief(shape.kind, k, place, tooth.wear);
  }
  return section;
}

// Returns the crown shrunk to the saddle between two teeth.
CrownSection drawn_together(const Tooth& tooth, double place) {
  CrownSection section = full_crown(tooth, place);
  const ToothShape& shape = tooth.shape;
  const double gum = shape.tip - shape.height;
  for (std::size_t k = 0; k < kCrownControls; ++k) {
    const double middle = shape.lateral + shape.edge * 0.5;
    section[k].outward = middle + 0.52 * (section[k].outward - middle);
    section[k].rise = gum + 1.2 + 0.34 * (section[k].rise - gum);
  }
  return section;
}

}  // namespace

std::vector<Tooth> grow_row(std::span<const ToothShape> shapes, double row_length,
                            std::uint64_t seed) {
  std::vector<Tooth> row;
  double total = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto vary = [&](std::uint64_t key, double by) {
      return by * random_signed(seed, 16 * i + key);
    };
    Tooth tooth{shapes[i], 0, 0, 0, 0};
    tooth.shape.width *= 1 + vary(0, 0.04);
    tooth.shape.depth *= 1 + vary(1, 0.03);
    tooth.shape.height += vary(2, 0.3);
    tooth.shape.lateral += vary(3, 0.15);
    tooth.shape.tip += vary(4, 0.12);
    tooth.shape.edge += vary(5, 0.2);
    tooth.turn = vary(6, 0.35);
    tooth.wear = 0.2 + vary(7, 0.2);
    total += tooth.shape.width;
    row.push_back(tooth);
  }
  double place = 0;
  for (Tooth& tooth : row) {
    tooth.begin = place;
    place += tooth.shape.width * (row_length / total);
    tooth.end = place;
  }
  return row;
}

CrownSection crown_section(std::span<const Tooth> row, std::size_t index, double place) {
  // A superellipse seen from above and one seen from the cheek give upright walls between two
  // teeth.
  const double p2 = place * place, p4 = p2 * p2;
  const double around = std::sqrt(std::max(0.0, 1 - 0.5 * (p2 + p4)));
  const double upright = std::sqrt(std::max(0.0, 1 - p4 * p4));
  const bool towards_midline = place < 0;
  const bool serial = towards_midline ? index == 0 : index + 1 == row.size();
  const Tooth& tooth = row[index];
  const Tooth& neighbour = serial ? tooth : row[towards_midline ? index - 1 : index + 1];

  CrownSection section = full_crown(tooth, place);
  const double end = towards_midline ? -1 : 1;
  const CrownSection mine = drawn_together(tooth, end);
  const CrownSection theirs = drawn_together(neighbour, serial ? end : -end);
  for (std::size_t k = 0; k < kCrownControls; ++k) {
    const double outward = (mine[k].outward + theirs[k].outward) / 2;
    const double rise = (mine[k].rise + theirs[k].rise) / 2;
    section[k].outward = outward + around * (section[k].outward - outward);
    section[k].rise = rise + upright * (section[k].rise - rise);
  }
  return section;
}

}  // namespace ist
