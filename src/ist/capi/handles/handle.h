#pragma once

#include <cstdint>
#include <memory>

#include "ist/capi/guard.h"
#include "ist/capi/handles/handle_table.h"

namespace ist::capi {

static_assert(sizeof(void*) == sizeof(std::uint64_t), "a handle has the size of a pointer");

// The type T of an object declares `using Handle`, its opaque C type; kKind; kUse; kName.

template <typename Handle>
[[nodiscard]] std::uint64_t number_of(const Handle* handle) noexcept {
  return reinterpret_cast<std::uintptr_t>(handle);
}

/// Stores the message for an invalid handle, passed as `argument`, and returns the status.
ist_status fail_by_handle(const Call& call, ist_status status, const char* argument,
                          const char* kind);

/// Moves a new object into the handle table and writes its handle to `out`.
template <typename T>
[[nodiscard]] ist_status give(const Call& call, std::unique_ptr<T> object,
                              typename T::Handle** out) {
  const std::uint64_t handle = handles().insert(
      T::kKind, object.get(), [](void* taken) noexcept { delete static_cast<T*>(taken); });
  if (handle == 0) return fail_by_handle(call, IST_TOO_MANY_HANDLES, "", T::kName);
  static_cast<void>(object.release());
  // The pointer is a number, never an address.
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  *out = reinterpret_cast<typename T::Handle*>(static_cast<std::uintptr_t>(handle));
  return IST_OK;
}

/// Keeps the object of a handle alive during a call.
template <typename T>
class Held {
 public:
  Held(const Call& call, const char* argument, const typename T::Handle* handle)
      : handle_(number_of(handle)), taken_(handles().take(handle_, T::kKind, T::kUse)) {
    if (taken_.status != IST_OK) fail_by_handle(call, taken_.status, argument, T::kName);
  }
  ~Held() {
    if (taken_.status == IST_OK) handles().give_back(handle_);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  /// IST_OK, or the error; the message is then stored.
  [[nodiscard]] ist_status status() const noexcept { return taken_.status; }
  [[nodiscard]] T* operator->() const noexcept { return static_cast<T*>(taken_.object); }
  [[nodiscard]] T& operator*() const noexcept { return *static_cast<T*>(taken_.object); }

 private:
  std::uint64_t handle_;
  HandleTable::Taken taken_;
};

/// Implements every ..._free.
template <typename T>
[[nodiscard]] ist_status give_back(const char* function, typename T::Handle* handle) noexcept {
  return guarded(function, [&](const Call& call) -> ist_status {
    if (handle == nullptr) return IST_OK;
    const ist_status status = handles().remove(number_of(handle), T::kKind);
    return status == IST_OK ? status : fail_by_handle(call, status, T::kName, T::kName);
  });
}

}  // namespace ist::capi
