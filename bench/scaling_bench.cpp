// What a query's time grows with: leaves, overlap, the area of bodies that lie along each other,
// workers; and what memory grows with, up to jaws that take most of 16 GiB.
#include "scaling/series.h"

namespace ist::bench {
namespace {

const int kRegistered = [] {
  add_leaves();
  add_overlap();
  add_conformal();
  add_workers();
  return 0;
}();

}  // namespace
}  // namespace ist::bench
