#include <algorithm>

#include "simd/contact_lanes.h"

namespace ist {

void add_contacts_scalar(const SearchStep& step, const SearchPose& pose, ContactAdder& out) {
  ContactLanes& lanes = out.lanes;
  ContactTerms& terms = out.terms;
  for (std::size_t first = 0; first < lanes.count; first += kContactBatch) {
    terms.count = std::min(kContactBatch, lanes.count - first);
    terms.fixed = lanes.fixed + first;
    for (std::size_t i = 0; i < terms.count; ++i) {
      const std::size_t at = first + i;
      const std::uint32_t leaf = leaf_of(step.moving, lanes.moving[at]);
      const PairTerms pair =
          pair_terms(out.rule, pose, lanes, at, step.moving_normals[leaf].word());
      add_pair(out.rule, pair, out.totals);
      terms.weight[i] = pair.weight;
      terms.depth[i] = pair.depth;
      terms.x[i] = pair.position.x;
      terms.y[i] = pair.position.y;
      terms.z[i] = pair.position.z;
      terms.force_x[i] = pair.force.x;
      terms.force_y[i] = pair.force.y;
      terms.force_z[i] = pair.force.z;
    }
    if (out.stream != nullptr) out.stream->take(terms);
  }
  out.totals.pairs += lanes.count;
  lanes.count = 0;
}

}  // namespace ist
