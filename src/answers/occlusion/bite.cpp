#include "answers/occlusion/bite.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace ist::answers {
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

using Regions = std::span<const ContactRegion>;

// Returns the first region of the group of each region: regions of the fixed body come
// before regions of the moving body.
std::vector<std::size_t> joined(Regions fixed, Regions moving) {
  std::vector<std::size_t> parent(fixed.size() + moving.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find = [&parent](std::size_t k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  const auto join_faced = [&](Regions regions, std::size_t first, std::size_t others) {
    for (std::size_t k = 0; k < regions.size(); ++k) {
      if (!regions[k].faces) continue;
      const std::size_t a = find(first + k), b = find(others + *regions[k].faces);
      parent[std::max(a, b)] = std::min(a, b);
    }
  };
  join_faced(fixed, 0, fixed.size());
  join_faced(moving, fixed.size(), 0);
  for (std::size_t k = 0; k < parent.size(); ++k) parent[k] = find(k);
  return parent;
}

void add(BiteContact& contact, Regions regions, const std::vector<std::uint32_t>& indices,
         bool is_first) {
  double area = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const std::uint32_t k : indices) {
    const ContactRegion& region = regions[k];
    area += region.area;
    moment += region.area * region.centre;
    contact.penetrating_area += region.penetrating_area;
    contact.depth_integral += region.depth_integral;
    contact.share += region.share;
    contact.share_thinner += region.share_thinner;
    contact.share_thicker += region.share_thicker;
    if (is_first || region.least_distance < contact.least_distance) {
      contact.least_distance = region.least_distance;
      contact.closest = region.closest;
      is_first = false;
    }
  }
  contact.area += area;
  contact.centre += moment;
}

void add_up(BiteContact& contact, Regions fixed, Regions moving) {
  add(contact, fixed, contact.fixed, true);
  add(contact, moving, contact.moving, contact.fixed.empty());
  contact.centre /= contact.area;
  if (!contact.on_both()) return;
  for (double* sum : {&contact.area, &contact.penetrating_area, &contact.depth_integral,
                      &contact.share, &contact.share_thinner, &contact.share_thicker}) {
    *sum /= 2;
  }
}

}  // namespace

std::span<const Preset> presets() { return kPresets; }

std::vector<BiteContact> contacts_of(Regions fixed, Regions moving) {
  const std::vector<std::size_t> first = joined(fixed, moving);
  std::map<std::size_t, BiteContact> by_first;
  for (std::size_t k = 0; k < first.size(); ++k) {
    BiteContact& contact = by_first[first[k]];
    const bool is_fixed = k < fixed.size();
    (is_fixed ? contact.fixed : contact.moving)
        .push_back(static_cast<std::uint32_t>(is_fixed ? k : k - fixed.size()));
  }
  std::vector<BiteContact> contacts;
  for (auto& [region, contact] : by_first) {
    add_up(contact, fixed, moving);
    contacts.push_back(std::move(contact));
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const BiteContact& a, const BiteContact& b) {
                     return a.on_both() != b.on_both() ? a.on_both() : a.area > b.area;
                   });
  return contacts;
}

void Bite::number_contacts() {
  contacts = contacts_of(fixed.surface.regions, moving.surface.regions);
  fixed.contacts.resize(fixed.surface.regions.size());
  moving.contacts.resize(moving.surface.regions.size());
  fixed.on_both = moving.on_both = static_cast<std::size_t>(std::count_if(
      contacts.begin(), contacts.end(), [](const BiteContact& each) { return each.on_both(); }));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (const std::uint32_t k : contacts[i].fixed) fixed.contacts[k] = i + 1;
    for (const std::uint32_t k : contacts[i].moving) moving.contacts[k] = i + 1;
    // Regions are in the order of their areas, the largest first.
    const auto tooth_of = [](const BiteBody& body, const std::vector<std::uint32_t>& regions) {
      return body.region_teeth.empty() || regions.empty() ? 0 : body.region_teeth[regions.front()];
    };
    contacts[i].fixed_tooth = tooth_of(fixed, contacts[i].fixed);
    contacts[i].moving_tooth = tooth_of(moving, contacts[i].moving);
  }
}

std::vector<int> region_teeth_of(const SurfaceOcclusion& surface, const ToothLabels& labels) {
  std::vector<int> teeth;
  for (const ContactRegion& region : surface.regions) {
    std::map<int, double> areas;
    for (const ContactTriangle& part : region.triangles) areas[labels[part.triangle]] += part.area;
    const auto most =
        std::max_element(areas.begin(), areas.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    teeth.push_back(most == areas.end() ? 0 : most->first);
  }
  return teeth;
}

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
      // fmin() returns the number if the other one is NaN.
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

}  // namespace ist::answers
