#pragma once

#include <vector>

#include "ist/query/contact.h"

namespace ist {

/// Sorts contacts by their fixed leaf and keeps the order of those that have the same one. So what
/// a search that opens moving nodes in order has found is sorted by both.
///
/// `room` takes as many; what it holds before and after is of no interest. Cost: 10 ns a contact.
void sort_by_fixed(std::vector<Contact>& contacts, std::vector<Contact>& room);

}  // namespace ist
