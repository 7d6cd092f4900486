#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "c/guard.h"
#include "ist/base/api.h"
#include "ist/capi/ist_c.h"

namespace ist::capi {

/// The kind of the object of a handle.
enum class HandleKind : std::uint8_t { kMesh = 1, kTree, kQuery, kServo, kWorld, kSweep };

/// How a call uses an object. A shared use runs beside any other use. Only one `kAlone` use runs at
/// a time.
enum class HandleUse : std::uint8_t { kShared, kAlone };

/// Maps handles to objects. A handle consists of the object's kind, its slot and the number of
/// times the slot was used; no pointer of this processor has such a value. The table therefore
/// recognises a handle that was freed, has another kind or never existed, and reads no memory but
/// its own.
///
/// A call takes the object and gives it back; the last user destroys an object that was removed
/// meanwhile. take() and give_back() are one atomic operation each, repeated only while another
/// thread changes the same slot; no function locks. Any number of threads may call all functions.
class IST_LOOP_API HandleTable {
 public:
  using Destroy = void (*)(void* object) noexcept;
  static constexpr std::size_t kSlots = std::size_t{1} << 16;

  constexpr HandleTable() = default;
  HandleTable(const HandleTable&) = delete;
  HandleTable& operator=(const HandleTable&) = delete;

  /// Takes ownership of the object and returns its handle. Returns 0 if all slots are in use;
  /// the caller then keeps the object.
  [[nodiscard]] std::uint64_t insert(HandleKind kind, void* object, Destroy destroy) noexcept;

  /// An object, or an error.
  struct Taken {
    ist_status status;
    void* object;
  };
  [[nodiscard]] Taken take(std::uint64_t handle, HandleKind kind, HandleUse use) noexcept;
  /// Ends a use that take() began.
  void give_back(std::uint64_t handle, HandleUse use) noexcept;

  /// Invalidates the handle; the last user destroys the object.
  [[nodiscard]] ist_status remove(std::uint64_t handle, HandleKind kind) noexcept;

 private:
  // `state` is the handle, with three things in place of the slot: the flag kAlive, the flag kAlone
  // of a user that is alone, and the number of shared users. An empty slot keeps only its count of
  // uses, without mark and kind.
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
[[nodiscard]] IST_LOOP_API HandleTable& handles() noexcept;

static_assert(sizeof(void*) == sizeof(std::uint64_t), "a handle has the size of a pointer");

/// The base of an object's type: the opaque C type of its handle, its kind and its usual use.
template <typename CHandle, HandleKind kOfKind, HandleUse kOfUse>
struct OfHandle {
  using Handle = CHandle;
  static constexpr HandleKind kKind = kOfKind;
  static constexpr HandleUse kUse = kOfUse;
  /// The argument's name in C, and the object's in messages.
  static constexpr const char* kName = std::array{
      "mesh", "tree", "query", "servo", "world", "sweep"}[static_cast<std::size_t>(kOfKind) - 1];
};

template <typename Handle>
[[nodiscard]] std::uint64_t number_of(const Handle* handle) noexcept {
  return reinterpret_cast<std::uintptr_t>(handle);
}

/// Fails with the message for an invalid handle, passed as `argument`. IST_OK does nothing.
IST_LOOP_API void fail_by_handle(Call& call, ist_status status, const char* argument,
                                 const char* kind);

/// Moves a new object into the handle table and writes its handle to `out`.
template <typename T>
void give(Call& call, std::unique_ptr<T> object, typename T::Handle** out) {
  const std::uint64_t handle = handles().insert(
      T::kKind, object.get(), [](void* taken) noexcept { delete static_cast<T*>(taken); });
  if (handle == 0) return fail_by_handle(call, IST_TOO_MANY_HANDLES, "", T::kName);
  static_cast<void>(object.release());
  // The pointer is a number, never an address.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  *out = reinterpret_cast<typename T::Handle*>(static_cast<std::uintptr_t>(handle));
}

/// Keeps the object of a handle alive during a call. A call that failed before gets no object.
template <typename T, HandleUse kUse = T::kUse>
class Held {
 public:
  Held(Call& call, const char* argument, const typename T::Handle* handle)
      : handle_(number_of(handle)) {
    if (call.status() != IST_OK) return;
    const HandleTable::Taken taken = handles().take(handle_, T::kKind, kUse);
    fail_by_handle(call, taken.status, argument, T::kName);
    object_ = static_cast<T*>(taken.object);
  }
  ~Held() {
    if (object_ != nullptr) handles().give_back(handle_, kUse);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  /// Whether there is an object. If not, the call has failed.
  explicit operator bool() const noexcept { return object_ != nullptr; }
  [[nodiscard]] T* operator->() const noexcept { return object_; }
  [[nodiscard]] T& operator*() const noexcept { return *object_; }

 private:
  std::uint64_t handle_;
  T* object_ = nullptr;
};

/// Implements every ..._free.
template <typename T>
[[nodiscard]] ist_status give_back(const char* function, typename T::Handle* handle) noexcept {
  return guarded(function, [&](Call& call) {
    if (handle == nullptr) return;
    fail_by_handle(call, handles().remove(number_of(handle), T::kKind), T::kName, T::kName);
  });
}

}  // namespace ist::capi
