#include "answers/occlusion/bite_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "answers/occlusion/bite_direction.h"
#include "answers/occlusion/bite_numbers.h"

namespace ist::answers {
namespace {

using Vector = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;
using ContactList = std::vector<std::size_t>;  // contacts, from 0

constexpr double kOutOfPlane = 0.423;  // the sine of 25°

bool maps_nothing(const BiteBody& body) {
  const auto& vertices = body.surface.vertices;
  return std::all_of(vertices.begin(), vertices.end(),
                     [](const SurfaceDistance& one) { return std::isnan(one.distance); });
}

// Groups of contacts with gaps of at most that between their centres.
std::vector<ContactList> groups_of(const std::vector<BiteContact>& contacts, double gap) {
  std::vector<ContactList> groups;
  std::vector<bool> taken(contacts.size(), false);
  for (std::size_t first = 0; first < contacts.size(); ++first) {
    if (taken[first]) continue;
    taken[first] = true;
    ContactList group{first};
    for (std::size_t at = 0; at < group.size(); ++at) {
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        if (taken[k] || (contacts[k].centre - contacts[group[at]].centre).norm() > gap) continue;
        taken[k] = true;
        group.push_back(k);
      }
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

// The largest group, and the contacts that are far from it.
struct FarContacts {
  ContactList arch, far;
  double away = 0;  // the least distance of a far contact
};

FarContacts far_contacts(const Bite& bite) {
  const std::vector<BiteContact>& contacts = bite.contacts;
  const double gap = bite.fixed.box().sizes().maxCoeff() / 3;
  std::vector<ContactList> groups = groups_of(contacts, gap);
  if (groups.size() < 2) return {};
  const auto area = [&](const ContactList& group) {
    double sum = 0;
    for (const std::size_t k : group) sum += contacts[k].area;
    return sum;
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const ContactList& a, const ContactList& b) { return area(a) > area(b); });
  const Vector towards = directions_of(bite).towards;
  FarContacts out{groups[0], {}, std::numeric_limits<double>::infinity()};
  for (std::size_t g = 1; g < groups.size(); ++g) {
    for (const std::size_t k : groups[g]) {
      Vector way = Vector::Constant(std::numeric_limits<double>::infinity());
      for (const std::size_t other : out.arch) {
        const Vector to = contacts[k].centre - contacts[other].centre;
        if (to.norm() < way.norm()) way = to;
      }
      if (!(std::abs(way.dot(towards)) > kOutOfPlane * way.norm())) continue;
      out.far.push_back(k);
      out.away = std::min(out.away, way.norm());
    }
  }
  std::sort(out.far.begin(), out.far.end());
  return out;
}

Box box_of_contact(const Bite& bite, std::size_t contact) {
  Box box;
  const auto extend = [&](const BiteBody& body, const std::vector<std::uint32_t>& regions) {
    for (const std::uint32_t k : regions) {
      for (const ContactTriangle& part : body.surface.regions[k].triangles) {
        for (const std::uint32_t v : body.mesh->triangles[part.triangle]) {
          box.extend(body.to_fixed * body.mesh->vertices[v]);
        }
      }
    }
  };
  extend(bite.fixed, bite.contacts[contact].fixed);
  extend(bite.moving, bite.contacts[contact].moving);
  return box;
}

// The box of both bodies, cut halfway between the arch and each far contact; empty if no such cut
// parts them. Its corners have few digits.
Box region_without(const Bite& bite, const FarContacts& parts) {
  Box arch, region = bite.fixed.box().merged(bite.moving.box());
  for (const std::size_t k : parts.arch) arch.extend(box_of_contact(bite, k));
  const double digit = std::pow(10, std::floor(std::log10(region.sizes().maxCoeff() / 50)));
  region.min() = digit * ((region.min() / digit).array().floor() - 1);
  region.max() = digit * ((region.max() / digit).array().ceil() + 1);
  for (const std::size_t k : parts.far) {
    const Box far = box_of_contact(bite, k);
    const Vector above = far.min() - arch.max(), below = arch.min() - far.max();
    Eigen::Index axis = 0, low = 0;
    const double gap_above = above.maxCoeff(&axis), gap_below = below.maxCoeff(&low);
    if (std::max(gap_above, gap_below) < 4 * digit) return {};
    if (gap_above >= gap_below) {
      const double cut = 0.5 * (far.min()[axis] + arch.max()[axis]);
      region.max()[axis] = std::min(region.max()[axis], digit * std::round(cut / digit));
    } else {
      const double cut = 0.5 * (far.max()[low] + arch.min()[low]);
      region.min()[low] = std::max(region.min()[low], digit * std::round(cut / digit));
    }
  }
  return region;
}

// The mean cosine between the outer normals of fixed triangles within the reach and of the moving
// triangles nearest to them, by area and nearness: -1 if the surfaces face each other, 1 if they
// face the same way.
double mean_cosine(const Bite& bite) {
  const auto normal = [](const BiteBody& body, std::uint32_t triangle) -> Vector {
    const auto& [a, b, c] = body.mesh->triangles[triangle];
    const auto& points = body.mesh->vertices;
    return body.to_fixed.linear() * (points[b] - points[a]).cross(points[c] - points[a]);
  };
  double sum = 0, area = 0;
  for (std::uint32_t t = 0; t < bite.fixed.mesh->triangles.size(); ++t) {
    const SurfaceDistance& near = bite.fixed.surface.vertices[bite.fixed.mesh->triangles[t][0]];
    if (std::isnan(near.distance)) continue;
    const Vector mine = normal(bite.fixed, t), other = normal(bite.moving, near.triangle);
    if (!(other.norm() > 0)) continue;
    const double nearness = bite.reach - std::abs(near.distance);
    sum += nearness * mine.dot(other) / other.norm();
    area += nearness * mine.norm();
  }
  return area > 0 ? sum / area : -1;
}

// How deep the bodies are in each other at least, mesh units.
double least_overlap(const Bite& bite) {
  const Findings& found = bite.findings;
  if (found.depth.certain) return found.depth.certain->lower;
  // Open surfaces have no inside. If they are apart, nothing overlaps.
  if (found.touch == Answer::kNo) return 0;
  return std::max({found.depth.at_vertices.value_or(0), bite.fixed.surface.depth_at_vertices,
                   bite.moving.surface.depth_at_vertices});
}

}  // namespace

std::optional<std::string> warning_of(const Bite& bite) {
  constexpr double kSameWay = 0.5;
  constexpr double kNoBite = 2;  // millimetres
  const bool certain = bite.findings.depth.certain.has_value();
  const BiteNumbers numbers(bite);
  if (mean_cosine(bite) > kSameWay) {
    return "The scans face the same way where they are near each other: they are probably scans of "
           "one jaw, or one of them is inside out. Name the upper and the lower jaw.";
  }
  const double overlap = least_overlap(bite);
  if (overlap > kNoBite * bite.units_per_mm) {
    return fmt::format(
        "The scans overlap by {}{}, more than a bite does: check that they are the upper and the "
        "lower jaw of one patient, in one coordinate system.",
        certain ? "" : "at least ", numbers.millimetres(overlap));
  }
  const double apart = bite.findings.distance->lower;
  const double smaller =
      std::min(bite.fixed.box().sizes().maxCoeff(), bite.moving.box().sizes().maxCoeff());
  if (!maps_nothing(bite.fixed) || !maps_nothing(bite.moving) || apart <= 0.5 * smaller) return {};
  return fmt::format(
      "The scans are {} apart: they are probably not in one coordinate system. Register them "
      "first, or give --matrix.",
      numbers.millimetres(apart));
}

std::optional<std::string> hint_of(const Bite& bite) {
  const FarContacts parts = far_contacts(bite);
  if (parts.far.empty()) return {};
  std::string numbers;
  for (std::size_t i = 0; i < parts.far.size(); ++i) {
    numbers += fmt::format("{}{}",
                           i == 0                     ? ""
                           : i + 1 < parts.far.size() ? ", "
                                                      : " and ",
                           parts.far[i] + 1);
  }
  const bool one = parts.far.size() == 1;
  std::string hint =
      fmt::format("contact{} {} {} {} or more from the others, perhaps in the joints",
                  one ? "" : "s", numbers, one ? "lies" : "lie",
                  BiteNumbers::in_millimetres(std::floor(parts.away / bite.units_per_mm)));
  const Box region = region_without(bite, parts);
  if (region.isEmpty()) return hint;
  const Vector &low = region.min(), &high = region.max();
  return hint + fmt::format(": --region {:g},{:g},{:g},{:g},{:g},{:g} leaves {} out", low.x(),
                            low.y(), low.z(), high.x(), high.y(), high.z(), one ? "it" : "them");
}

std::string region_words(const Bite& bite) {
  return fmt::format(
      "region: areas, contacts, shares, depths of vertices and the deepest point are of the "
      "triangles with their centroid in {}; all else is of the whole bodies",
      box_words(*bite.region));
}

std::vector<std::string> remarks_of(const Bite& bite) {
  std::vector<std::string> remarks;
  if (bite.warning) remarks.push_back(*bite.warning);
  if (bite.region) remarks.push_back(region_words(bite));
  if (bite.hint) remarks.push_back("hint: " + *bite.hint);
  return remarks;
}

std::vector<std::string> notes_of(const Bite& bite) {
  std::vector<std::string> notes = remarks_of(bite);
  notes.insert(notes.end(), bite.checks.begin(), bite.checks.end());
  return notes;
}

std::string box_words(const Eigen::AlignedBox3d& box) {
  std::string words;
  for (int axis = 0; axis < 3; ++axis) {
    words += fmt::format("{}{} {:.6g} to {:.6g}", axis == 0 ? "" : ", ", "xyz"[axis],
                         box.min()[axis], box.max()[axis]);
  }
  return words;
}

}  // namespace ist::answers
