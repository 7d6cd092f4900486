#include "c/handle_table.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "capi/c_bodies.h"

namespace ist::test {
namespace {

using capi::HandleKind;
using capi::HandleTable;
using capi::HandleUse;

// An object that tells how often it was destroyed.
struct Counted {
  std::atomic<int> destroyed{0};
  static void destroy(void* object) noexcept { ++static_cast<Counted*>(object)->destroyed; }
};

class CHandles : public ::testing::Test {
 protected:
  [[nodiscard]] std::uint64_t insert(Counted& object, HandleKind kind = HandleKind::kMesh) {
    return table_->insert(kind, &object, Counted::destroy);
  }
  [[nodiscard]] std::string taken(std::uint64_t handle, HandleKind kind = HandleKind::kMesh,
                                  HandleUse use = HandleUse::kShared) {
    return name(table_->take(handle, kind, use).status);
  }
  [[nodiscard]] std::string removed(std::uint64_t handle, HandleKind kind = HandleKind::kMesh) {
    return name(table_->remove(handle, kind));
  }

  const std::unique_ptr<HandleTable> table_ = std::make_unique<HandleTable>();
};

TEST_F(CHandles, LeadToTheirObjects) {
  Counted a, b;
  const std::uint64_t to_a = insert(a), to_b = insert(b, HandleKind::kTree);
  EXPECT_EQ(table_->take(to_a, HandleKind::kMesh, HandleUse::kShared).object, &a);
  EXPECT_EQ(table_->take(to_b, HandleKind::kTree, HandleUse::kAlone).object, &b);
  table_->give_back(to_a, HandleUse::kShared);
  table_->give_back(to_b, HandleUse::kAlone);
  EXPECT_EQ(removed(to_a), "ok");
  EXPECT_EQ(a.destroyed, 1);
  EXPECT_EQ(b.destroyed, 0);
}

TEST_F(CHandles, AreKnownWhenTheyAreWrong) {
  Counted object;
  const std::uint64_t handle = insert(object);
  EXPECT_EQ(taken(0), "null-argument");
  EXPECT_EQ(taken(1), "not-a-handle");
  EXPECT_EQ(taken(reinterpret_cast<std::uintptr_t>(&object)), "not-a-handle");
  EXPECT_EQ(taken(UINT64_MAX), "not-a-handle");
  EXPECT_EQ(taken(handle, HandleKind::kTree), "handle-kind");
  EXPECT_EQ(removed(handle, HandleKind::kQuery), "handle-kind");
  EXPECT_EQ(taken(handle ^ 1), "handle-freed");          // another slot
  EXPECT_EQ(taken(handle + (1 << 16)), "handle-freed");  // given out later
  EXPECT_EQ(removed(handle), "ok");
  EXPECT_EQ(removed(handle), "handle-freed");
  EXPECT_EQ(taken(handle), "handle-freed");
  EXPECT_EQ(object.destroyed, 1);
}

// All slots in turn, and then again: none of the old handles leads to a new object.
TEST_F(CHandles, AreNeverUsedAgain) {
  std::vector<std::uint64_t> old;
  Counted object;
  for (std::size_t i = 0; i < 2 * HandleTable::kSlots; ++i) {
    const std::uint64_t handle = insert(object);
    ASSERT_NE(handle, 0u);
    ASSERT_EQ(removed(handle), "ok");
    if (i % 1000 == 0) old.push_back(handle);
  }
  const std::uint64_t now = insert(object);
  for (const std::uint64_t handle : old) {
    EXPECT_NE(handle, now);
    EXPECT_EQ(taken(handle), "handle-freed");
  }
}

TEST_F(CHandles, EndWhereTheTableIsFull) {
  Counted object;
  std::vector<std::uint64_t> all;
  for (std::size_t i = 0; i < HandleTable::kSlots; ++i) all.push_back(insert(object));
  EXPECT_EQ(std::count(all.begin(), all.end(), 0u), 0);
  EXPECT_EQ(insert(object), 0u);
  EXPECT_EQ(removed(all[4711]), "ok");
  EXPECT_NE(insert(object), 0u);
  EXPECT_EQ(insert(object), 0u);
}

TEST_F(CHandles, LetOneUserBeAloneBesideSharedOnes) {
  Counted object;
  const std::uint64_t handle = insert(object);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(taken(handle, HandleKind::kMesh, HandleUse::kShared), "ok");
    EXPECT_EQ(taken(handle, HandleKind::kMesh, HandleUse::kAlone), "ok");
    EXPECT_EQ(taken(handle, HandleKind::kMesh, HandleUse::kAlone), "handle-busy");
    EXPECT_EQ(taken(handle, HandleKind::kMesh, HandleUse::kShared), "ok");
    table_->give_back(handle, HandleUse::kShared);
    EXPECT_EQ(taken(handle, HandleKind::kMesh, HandleUse::kAlone), "handle-busy");
    table_->give_back(handle, HandleUse::kAlone);
  }
}

TEST_F(CHandles, CountSharedUsersUpToTheirRoom) {
  Counted object;
  const std::uint64_t handle = insert(object);
  constexpr int kMost = 0x3FFF;
  for (int i = 0; i < kMost; ++i) ASSERT_EQ(taken(handle), "ok") << i;
  EXPECT_EQ(taken(handle), "handle-busy");
  EXPECT_EQ(taken(handle, HandleKind::kMesh, HandleUse::kAlone), "ok");
  EXPECT_EQ(removed(handle), "ok");
  for (int i = 0; i < kMost; ++i) table_->give_back(handle, HandleUse::kShared);
  EXPECT_EQ(object.destroyed, 0);
  table_->give_back(handle, HandleUse::kAlone);
  EXPECT_EQ(object.destroyed, 1);
}

TEST_F(CHandles, ThatAreRemovedInUseGoWithTheLastUser) {
  Counted object;
  const std::uint64_t handle = insert(object);
  EXPECT_EQ(taken(handle), "ok");
  EXPECT_EQ(taken(handle), "ok");
  EXPECT_EQ(removed(handle), "ok");
  EXPECT_EQ(removed(handle), "handle-freed");
  EXPECT_EQ(taken(handle), "handle-freed");
  table_->give_back(handle, HandleUse::kShared);
  EXPECT_EQ(object.destroyed, 0);
  table_->give_back(handle, HandleUse::kShared);
  EXPECT_EQ(object.destroyed, 1);
}

// Threads that use, remove and replace the same few handles: each object is destroyed once, and
// nobody uses it after; and one who is to be alone is.
class CHandlesThread : public ::testing::TestWithParam<HandleUse> {};

TEST_P(CHandlesThread, UseRemoveAndReplaceTheSame) {
  struct Object {
    std::atomic<int> users{0};
    std::atomic<bool> destroyed{false};
  };
  static constexpr int kThreads = 4, kRounds = 3000, kShared = 3;
  const auto table = std::make_unique<HandleTable>();
  std::vector<Object> objects(kThreads * kRounds);
  std::array<std::atomic<std::uint64_t>, kShared> handles{};
  std::atomic<int> wrong{0}, used{0}, removed{0};
  const auto work = [&](int thread) {
    for (int i = 0; i < kRounds; ++i) {
      Object& object = objects[static_cast<std::size_t>(thread * kRounds + i)];
      auto& shared = handles[static_cast<std::size_t>((i + thread) % kShared)];
      const std::uint64_t before =
          shared.exchange(table->insert(HandleKind::kQuery, &object, [](void* of) noexcept {
            static_cast<Object*>(of)->destroyed = true;
          }));
      for (const auto& handle : handles) {
        const std::uint64_t to = handle;
        const auto taken = table->take(to, HandleKind::kQuery, GetParam());
        if (taken.status != IST_OK) continue;
        auto& of = *static_cast<Object*>(taken.object);
        ++used;
        wrong += (++of.users > 1 && GetParam() == HandleUse::kAlone) || of.destroyed;
        --of.users;
        table->give_back(to, GetParam());
      }
      if (before != 0) removed += table->remove(before, HandleKind::kQuery) == IST_OK;
    }
  };
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < kThreads; ++thread) threads.emplace_back(work, thread);
  threads.clear();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(used, kThreads * kRounds / 4);
  EXPECT_EQ(removed, kThreads * kRounds - kShared);
  for (auto& handle : handles) EXPECT_EQ(table->remove(handle, HandleKind::kQuery), IST_OK);
  EXPECT_EQ(std::count_if(objects.begin(), objects.end(),
                          [](const Object& object) { return object.destroyed.load(); }),
            kThreads * kRounds);
}

INSTANTIATE_TEST_SUITE_P(Use, CHandlesThread,
                         ::testing::Values(HandleUse::kShared, HandleUse::kAlone),
                         [](const auto& use) {
                           return use.param == HandleUse::kAlone ? "Alone" : "Shared";
                         });

}  // namespace
}  // namespace ist::test
