#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/models/models.h"
#include "models/jaw/jaw_section.h"
#include "models/jaw/jaw_spline.h"

namespace ist {
namespace {

using enum ToothKind;

// The members of ToothShape: kind, width, depth, height, lateral, tip, edge, stations.
constexpr std::array<ToothShape, 7> kLowerTeeth{{{kIncisor, 5.4, 6.0, 8.6, 0, 1.2, 0.3, 15},
                                                 {kIncisor, 5.9, 6.2, 8.6, 0, 1.2, 0.2, 15},
                                                 {kCanine, 6.9, 7.4, 8.8, -0.4, 0.9, -0.3, 18},
                                                 {kPremolar, 7.1, 7.8, 8.2, 0, 1.0, -0.3, 18},
                                                 {kPremolar, 7.3, 8.3, 8.2, 0, 1.2, -0.4, 18},
                                                 {kMolar, 11.2, 10.2, 7.8, 0, 1.2, -0.6, 29},
                                                 {kMolar, 10.8, 10.0, 7.6, 0, 1.2, -0.7, 29}}};
constexpr std::array<ToothShape, 7> kUpperTeeth{{{kIncisor, 8.4, 7.0, 10.4, 2.3, 2.4, 1.6, 21},
                                                 {kIncisor, 6.7, 6.6, 9.6, 2.6, 1.7, 1.6, 22},
                                                 {kCanine, 7.6, 8.0, 10.4, 3.2, 2.2, 1.3, 24},
                                                 {kPremolar, 7.0, 9.0, 8.8, 2.0, 1.2, 0.2, 24},
                                                 {kPremolar, 6.8, 9.2, 8.6, 2.0, 1.2, 0.2, 24},
                                                 {kMolar, 10.4, 11.0, 8.0, 2.0, 1.0, 0.2, 38},
                                                 {kMolar, 9.8, 11.0, 7.6, 2.0, 0.7, 0.2, 38}}};
constexpr double kRowLength = 54.5;

constexpr std::size_t kLowerBehind = 56, kUpperBehind = 18;
constexpr double kLowerLength = 100, kUpperLength = 62;
constexpr double kMidlineGap = 0.05;  // from the midline to each upper half's first section

// The number of points on each span of a section's spline: many on the crown, few on bone.
constexpr std::array<int, 21> kLowerSpans{8, 8, 8, 8, 8, 8, 8, 8, 8, 8, 7,
                                          7, 6, 6, 6, 6, 6, 6, 6, 7, 7};
constexpr std::array<int, 26> kUpperSpans{5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6,
                                          6, 6, 4, 4, 4, 6, 3, 6, 4, 3, 3, 3, 2};

// Appends points of the closed spline with these controls, spans[i] of them between control i and
// the next control.
void sample_ring(std::span<const Eigen::Vector3d> controls, std::span<const int> spans,
                 std::vector<Eigen::Vector3d>& points) {
  const std::size_t n = controls.size();
  IST_ASSERT(spans.size() == n);
  for (std::size_t i = 0; i < n; ++i) {
    const int count = spans[i];
    for (int k = 0; k < count; ++k) {
      const std::array<double, 4> w = spline_weights((k + 0.5) / count);
      points.push_back(w[0] * controls[(i + n - 1) % n] + w[1] * controls[i] +
                       w[2] * controls[(i + 1) % n] + w[3] * controls[(i + 2) % n]);
    }
  }
}

double distance2(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  const Eigen::Vector3d d = mesh.vertices[a] - mesh.vertices[b];
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

// Closes a ring with triangles, walking from the seam both ways at once and cutting along the
// shorter diagonal. `flip` reverses their winding, for the opposite end.
void sew_end(TriangleMesh& mesh, std::size_t first_vertex, std::size_t ring_size, std::size_t seam,
             bool flip) {
  const auto at = [&](std::size_t i) {
    return static_cast<std::uint32_t>(first_vertex + i % ring_size);
  };
  std::size_t ahead = seam, behind = seam + ring_size - 1;
  while (behind - ahead > 1) {
    const bool step_ahead =
        distance2(mesh, at(ahead + 1), at(behind)) <= distance2(mesh, at(ahead), at(behind - 1));
    const std::uint32_t third = step_ahead ? at(ahead + 1) : at(behind - 1);
    if (flip) {
      mesh.triangles.push_back({at(ahead), at(behind), third});
    } else {
      mesh.triangles.push_back({at(ahead), third, at(behind)});
    }
    if (step_ahead) {
      ++ahead;
    } else {
      --behind;
    }
  }
}

// The seams of a tube's two ends. The sewing of an end starts at the edge that leads to this
// vertex of the ring and goes both ways from there.
struct TubeSeams {
  std::size_t first, last;
};

// Makes a closed surface of genus 0 from a stack of rings: quads between neighbours, cut along the
// shorter diagonal, and both ends sewn up without new vertices. n vertices give 2n - 4 triangles.
// Coordinates are rounded to float, so that a binary STL holds them without loss.
//
// @param vertices ring after ring; seen along the stack, each ring turns clockwise
// @param ring_size vertices a ring, at least 3; divides vertices.size()
TriangleMesh sew_tube(std::span<const Eigen::Vector3d> vertices, std::size_t ring_size,
                      TubeSeams seams) {
  IST_ASSERT(ring_size >= 3 && vertices.size() % ring_size == 0 && vertices.size() > 0);
  TriangleMesh mesh;
  mesh.vertices.reserve(vertices.size());
  for (const Eigen::Vector3d& v : vertices) {
    mesh.vertices.push_back(v.cast<float>().cast<double>());
  }
  mesh.triangles.reserve(2 * vertices.size() - 4);

  for (std::size_t ring = 0; ring + ring_size < vertices.size(); ring += ring_size) {
    for (std::size_t i = 0; i < ring_size; ++i) {
      const std::size_t j = (i + 1) % ring_size;
      const auto a = static_cast<std::uint32_t>(ring + i), b = static_cast<std::uint32_t>(ring + j);
      const auto c = static_cast<std::uint32_t>(b + ring_size);
      const auto d = static_cast<std::uint32_t>(a + ring_size);
      if (distance2(mesh, a, c) <= distance2(mesh, b, d)) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  }
  sew_end(mesh, 0, ring_size, seams.first, true);
  sew_end(mesh, vertices.size() - ring_size, ring_size, seams.last, false);
  return mesh;
}

JawSide grow_side(std::span<const ToothShape> teeth, double mirror, std::uint64_t seed) {
  return {mirror, seed, grow_row(teeth, kRowLength, mirror < 0 ? ~seed : seed)};
}

// Makes the lower jaw of sections across the arch, from one condyle round to the other.
TriangleMesh make_lower(const Arch& arch, std::uint64_t seed) {
  const JawSide left = grow_side(kLowerTeeth, -1, seed);
  const JawSide right = grow_side(kLowerTeeth, 1, seed);
  std::vector<Eigen::Vector3d> points;
  const std::vector<Station> back = lay_out_stations(left.row, kLowerBehind, kLowerLength);
  for (std::size_t i = back.size() - 1; i > 0; --i) {
    sample_ring(lower_section(arch, left, back[i]), kLowerSpans, points);
  }
  for (const Station& station : lay_out_stations(right.row, kLowerBehind, kLowerLength)) {
    sample_ring(lower_section(arch, right, station), kLowerSpans, points);
  }
  const auto ring_size =
      static_cast<std::size_t>(std::accumulate(kLowerSpans.begin(), kLowerSpans.end(), 0));
  const std::size_t crest = 40;  // the middle of the crown's spans
  return sew_tube(points, ring_size, {crest, crest});
}

// Makes the upper jaw. Sections of both sides join over the palate and the nasal floor, so each
// ring runs once round the jaw. The first ring is thin and lies in the middle plane, the last one
// is the back wall.
TriangleMesh make_upper(const Arch& arch, std::uint64_t seed) {
  const JawSide left = grow_side(kUpperTeeth, -1, seed);
  const JawSide right = grow_side(kUpperTeeth, 1, seed);
  std::vector<Station> on_left = lay_out_stations(left.row, kUpperBehind, kUpperLength);
  std::vector<Station> on_right = lay_out_stations(right.row, kUpperBehind, kUpperLength);
  on_left.front().distance = on_right.front().distance = kMidlineGap;
  std::vector<Eigen::Vector3d> points;
  // The ring's second half runs backwards, and so do its spans.
  std::vector<int> spans(kUpperSpans.begin(), kUpperSpans.end());
  spans.insert(spans.end(), kUpperSpans.rbegin() + 1, kUpperSpans.rend());
  spans.push_back(kUpperSpans.back());
  for (std::size_t i = 0; i < on_left.size(); ++i) {
    std::vector<Eigen::Vector3d> ring = upper_section(arch, left, on_left[i]);
    const std::vector<Eigen::Vector3d> other = upper_section(arch, right, on_right[i]);
    ring.insert(ring.end(), other.rbegin(), other.rend());
    sample_ring(ring, spans, points);
  }
  const auto ring_size = static_cast<std::size_t>(std::accumulate(spans.begin(), spans.end(), 0));
  const std::size_t midline = ring_size - 1, cheek = 88;  // the left half's first point; its gum
  return sew_tube(points, ring_size, {midline, cheek});
}

}  // namespace

TriangleMesh make_jaw(Jaw jaw, std::uint64_t seed) {
  const ScopedFloatEnvironment environment;
  const Arch arch;
  return jaw == Jaw::kLower ? make_lower(arch, seed) : make_upper(arch, seed);
}

}  // namespace ist
