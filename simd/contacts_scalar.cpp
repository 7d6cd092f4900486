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
      const PairTerms pair = pair_terms(
          out.rule, lanes.share[at], {lanes.fixed_x[at], lanes.fixed_y[at], lanes.fixed_z[at]},
          {lanes.moving_x[at], lanes.moving_y[at], lanes.moving_z[at]},
          turned(pose, unpack_normal(lanes.fixed_normal[at])),
          unpack_normal(step.moving_normals[leaf].word()));
      add_pair(out.rule, pair, out.totals);
      store_terms(pair, terms, i);
    }
    if (out.stream != nullptr) out.stream->take(terms);
  }
  out.totals.pairs += lanes.count;
  lanes.count = 0;
}

}  // namespace ist
