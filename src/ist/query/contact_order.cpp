#include "ist/query/contact_order.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace ist {

// By 11 bits at a time, the lower ones first.
void sort_by_fixed(std::vector<Contact>& contacts, std::vector<Contact>& room) {
  constexpr std::uint32_t kDigits = 1 << 11;
  std::vector<std::uint32_t> begin(kDigits);
  for (const int shift : {0, 11, 22}) {
    const auto digit = [shift](const Contact& c) { return (c.fixed >> shift) % kDigits; };
    std::fill(begin.begin(), begin.end(), 0);
    for (const Contact& contact : contacts) ++begin[digit(contact)];
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0U);
    room.resize(contacts.size());
    for (const Contact& contact : contacts) room[begin[digit(contact)]++] = contact;
    std::swap(contacts, room);
  }
}

}  // namespace ist
