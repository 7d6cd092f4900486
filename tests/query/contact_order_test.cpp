#include "ist/query/contact_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace ist {
namespace {

// Contacts of a few fixed leaves in each range of indices that a pass of the sort tells apart.
std::vector<Contact> some_contacts(std::size_t count) {
  std::mt19937 random(7);
  std::vector<Contact> contacts(count);
  for (Contact& contact : contacts) {
    const auto digits = static_cast<std::uint32_t>(random() % 64);
    contact = {digits % 4 | (digits / 4 % 4) << 11 | (digits / 16) << 22,
               static_cast<std::uint32_t>(random())};
  }
  return contacts;
}

TEST(ContactOrder, IsByFixedLeafAndElseAsFound) {
  for (const std::size_t count : {0U, 1U, 2U, 10'000U}) {
    std::vector<Contact> contacts = some_contacts(count), expected = contacts;
    std::stable_sort(expected.begin(), expected.end(),
                     [](const Contact& a, const Contact& b) { return a.fixed < b.fixed; });
    std::vector<Contact> room(3, Contact{1, 1});
    sort_by_fixed(contacts, room);
    EXPECT_EQ(contacts, expected) << count;
  }
}

TEST(ContactOrder, TellsTheLargestIndicesApart) {
  constexpr std::uint32_t kLast = std::numeric_limits<std::uint32_t>::max();
  std::vector<Contact> contacts = {{kLast, 0}, {0, 1}, {kLast - 1, 2}, {1U << 31, 3}}, room;
  sort_by_fixed(contacts, room);
  const std::vector<Contact> expected = {{0, 1}, {1U << 31, 3}, {kLast - 1, 2}, {kLast, 0}};
  EXPECT_EQ(contacts, expected);
}

}  // namespace
}  // namespace ist
