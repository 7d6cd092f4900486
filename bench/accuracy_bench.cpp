// What accuracy costs in time: errors are measured, against exact triangles and closed forms,
// beside the times of the queries that make them.
#include "accuracy/sections.h"

namespace {

const int kRegistered = [] {
  ist::bench::add_first_contacts();
  ist::bench::add_gaps();
  ist::bench::add_deadlines();
  ist::bench::add_verdicts();
  ist::bench::add_forces();
  ist::bench::add_forms();
  return 0;
}();

}  // namespace
