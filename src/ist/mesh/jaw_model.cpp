#include "ist/mesh/jaw_model.h"

#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "ist/base/assert.h"
#include "ist/base/float_environment.h"
#include "ist/mesh/jaw/jaw_section.h"
#include "ist/mesh/jaw/jaw_spline.h"
#include "ist/mesh/jaw/jaw_tube.h"

namespace ist {
namespace {

using enum ToothKind;

// Kind, width, depth, height, lateral, tip, edge, stations.
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
constexpr double kMidlineGap = 0.05;  // the upper halves' first sections, each off the midline

// Points on each span of a section's spline: many on the crown, few on bone.
constexpr std::array<int, 21> kLowerSpans{8, 8, 8, 8, 8, 8, 8, 8, 8, 8, 7,
                                          7, 6, 6, 6, 6, 6, 6, 6, 7, 7};
constexpr std::array<int, 26> kUpperSpans{5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 6,
                                          6, 6, 4, 4, 4, 6, 3, 6, 4, 3, 3, 3, 2};

// Appends points of the closed spline with these controls: spans[i] of them from control i to the
// next one.
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

JawSide grow_side(std::span<const ToothShape> teeth, double mirror, std::uint64_t seed) {
  return {mirror, seed, grow_row(teeth, kRowLength, mirror < 0 ? ~seed : seed)};
}

// Sections stand across the arch, from one condyle round to the other.
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

// Sections of both sides join over the palate and the floor of the nose, so that each ring runs
// once round the jaw; the first one is thin and lies in the middle plane, the last one is the back
// wall.
TriangleMesh make_upper(const Arch& arch, std::uint64_t seed) {
  const JawSide left = grow_side(kUpperTeeth, -1, seed);
  const JawSide right = grow_side(kUpperTeeth, 1, seed);
  std::vector<Station> on_left = lay_out_stations(left.row, kUpperBehind, kUpperLength);
  std::vector<Station> on_right = lay_out_stations(right.row, kUpperBehind, kUpperLength);
  on_left.front().distance = on_right.front().distance = kMidlineGap;
  std::vector<Eigen::Vector3d> points;
  // The ring's second half runs backwards, so its spans do, too.
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
