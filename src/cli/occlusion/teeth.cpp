#include "cli/occlusion/teeth.h"

#include <cmath>
#include <limits>
#include <map>

namespace ist::cli {

std::vector<Tooth> teeth_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                            const ToothLabels& labels) {
  std::map<int, Tooth> teeth;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0) continue;
    const auto [place, is_new] = teeth.try_emplace(labels[i]);
    Tooth& tooth = place->second;
    if (is_new) {
      tooth.number = labels[i];
      tooth.least_distance = std::numeric_limits<double>::quiet_NaN();
    }
    for (const std::uint32_t v : mesh.triangles[i]) {
      // The number, where only one of them is.
      tooth.least_distance = std::fmin(tooth.least_distance, surface.vertices[v].distance);
    }
  }
  double all = 0, all_thinner = 0, all_thicker = 0;
  for (const ContactRegion& region : surface.regions) {
    for (const ContactTriangle& contact : region.triangles) {
      all += contact.pressed;
      all_thinner += contact.pressed_thinner;
      all_thicker += contact.pressed_thicker;
      const auto found = teeth.find(labels[contact.triangle]);
      if (found == teeth.end()) continue;
      Tooth& tooth = found->second;
      tooth.area += contact.area;
      tooth.share += contact.pressed;
      tooth.share_thinner += contact.pressed_thinner;
      tooth.share_thicker += contact.pressed_thicker;
      tooth.least_distance = std::fmin(tooth.least_distance, contact.least_distance);
    }
  }
  const auto part = [](double& sum, double of) { sum = of > 0 ? sum / of : 0; };
  std::vector<Tooth> list;
  for (auto& [number, tooth] : teeth) {
    part(tooth.share, all);
    part(tooth.share_thinner, all_thinner);
    part(tooth.share_thicker, all_thicker);
    list.push_back(tooth);
  }
  return list;
}

}  // namespace ist::cli
