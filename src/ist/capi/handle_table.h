#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "ist/capi/ist.h"

namespace ist::capi {

/// What a handle is of.
enum class HandleKind : std::uint8_t { kMesh = 1, kTree, kQuery, kServo };

/// Who may use an object at a time: any number of threads, or one.
enum class HandleUse : std::uint8_t { kShared, kAlone };

/// From handles to objects. A handle is a number that no pointer of this processor can be, made of
/// the object's kind, its slot, and how often that slot was given out: so one that was freed, is of
/// another kind or was never given is recognised without looking at any memory but the table's.
///
/// A call takes the object and gives it back; an object that is removed meanwhile is destroyed by
/// the last to give it back. take() and give_back() are one atomic operation each, tried again only
/// where another thread uses the same object just then; nothing here locks. All may be called by
/// any number of threads.
class HandleTable {
 public:
  using Destroy = void (*)(void* object) noexcept;
  static constexpr std::size_t kSlots = std::size_t{1} << 16;

  constexpr HandleTable() = default;
  HandleTable(const HandleTable&) = delete;
  HandleTable& operator=(const HandleTable&) = delete;

  /// A handle of the object, which is the table's from now on; 0 where all slots are taken, and
  /// then it is not.
  [[nodiscard]] std::uint64_t insert(HandleKind kind, void* object, Destroy destroy) noexcept;

  /// An object, or why there is none.
  struct Taken {
    ist_status status;
    void* object;
  };
  [[nodiscard]] Taken take(std::uint64_t handle, HandleKind kind, HandleUse use) noexcept;
  /// Of a handle that was taken.
  void give_back(std::uint64_t handle) noexcept;

  /// The handle is no more; its object goes with its last user.
  [[nodiscard]] ist_status remove(std::uint64_t handle, HandleKind kind) noexcept;

 private:
  // `state` is the handle with the number of users in the place of the slot, and whether it lives.
  // An empty slot keeps the count of how often it was given out, without mark and kind.
  struct Slot {
    std::atomic<std::uint64_t> state{0};
    void* object = nullptr;
    Destroy destroy = nullptr;
  };
  void empty(Slot& slot) noexcept;

  std::array<Slot, kSlots> slots_{};
  std::atomic<std::uint64_t> next_{0};  // slot to try: all in turn, so that none is soon used again
};

/// The table of all handles of the process.
[[nodiscard]] HandleTable& handles() noexcept;

}  // namespace ist::capi
