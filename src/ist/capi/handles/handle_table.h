#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "ist/capi/ist_c.h"

namespace ist::capi {

/// The kind of the object of a handle.
enum class HandleKind : std::uint8_t { kMesh = 1, kTree, kQuery, kServo, kWorld, kSweep };

/// Whether any number of threads may use an object at a time, or one.
enum class HandleUse : std::uint8_t { kShared, kAlone };

/// Maps handles to objects. A handle consists of the object's kind, its slot and the number of
/// times the slot was used; no pointer of this processor has such a value. The table therefore
/// recognises a handle that was freed, has another kind or never existed, and reads no memory but
/// its own.
///
/// A call takes the object and gives it back; the last user destroys an object that was removed
/// meanwhile. take() and give_back() are one atomic operation each, repeated only while another
/// thread changes the same slot; no function locks. Any number of threads may call all functions.
class HandleTable {
 public:
  using Destroy = void (*)(void* object) noexcept;
  static constexpr std::size_t kSlots = std::size_t{1} << 16;

  constexpr HandleTable() = default;
  HandleTable(const HandleTable&) = delete;
  HandleTable& operator=(const HandleTable&) = delete;

  /// Takes ownership of the object and returns its handle. Returns 0 where all slots are in use;
  /// the caller then keeps the object.
  [[nodiscard]] std::uint64_t insert(HandleKind kind, void* object, Destroy destroy) noexcept;

  /// An object, or an error.
  struct Taken {
    ist_status status;
    void* object;
  };
  [[nodiscard]] Taken take(std::uint64_t handle, HandleKind kind, HandleUse use) noexcept;
  /// Ends a use that take() began.
  void give_back(std::uint64_t handle) noexcept;

  /// Invalidates the handle; the last user destroys the object.
  [[nodiscard]] ist_status remove(std::uint64_t handle, HandleKind kind) noexcept;

 private:
  // `state` is the handle, with the flag kAlive and the number of users in place of the slot. An
  // empty slot keeps only its count of uses, without mark and kind.
  struct Slot {
    std::atomic<std::uint64_t> state{0};
    void* object = nullptr;
    Destroy destroy = nullptr;
  };
  void empty(Slot& slot) noexcept;

  std::array<Slot, kSlots> slots_{};
  std::atomic<std::uint64_t> next_{0};  // next slot to try; slots take turns, to delay their reuse
};

/// The table of all handles of the process.
[[nodiscard]] HandleTable& handles() noexcept;

}  // namespace ist::capi
