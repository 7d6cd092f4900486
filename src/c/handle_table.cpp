#include "c/handle_table.h"

namespace ist::capi {
namespace {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

// A handle has, from the top, 8 bits of mark, 8 of kind, 32 of count and 16 of slot.
constexpr std::uint64_t kSlotBits = 0xFFFF;
constexpr int kKindAt = 48;
constexpr std::uint64_t kCountOne = kSlotBits + 1;
constexpr std::uint64_t kCountBits = 0xFFFFFFFF * kCountOne;
// In every address bits 63 to 56 are equal, with 4 or 5 levels of page tables.
constexpr std::uint64_t kMark = std::uint64_t{0x5A} << 56;
constexpr std::uint64_t kMarkBits = std::uint64_t{0xFF} << 56;
static_assert(HandleTable::kSlots == kSlotBits + 1);

// A state has these bits in place of the slot.
constexpr std::uint64_t kAlive = 0x8000, kAlone = 0x4000, kShared = 0x3FFF;
constexpr std::uint64_t kUsers = kAlone | kShared;

constexpr std::uint64_t marked(HandleKind kind) {
  return kMark | static_cast<std::uint64_t>(kind) << kKindAt;
}
constexpr std::uint64_t tag_of(std::uint64_t handle) { return handle & ~kSlotBits; }
constexpr std::uint64_t user(HandleUse use) { return use == HandleUse::kAlone ? kAlone : 1; }

// Checks the mark and the kind, without access to a slot.
ist_status check(std::uint64_t handle, HandleKind kind) noexcept {
  if (handle == 0) return IST_NULL_ARGUMENT;
  if ((handle & kMarkBits) != kMark) return IST_NOT_A_HANDLE;
  return (handle & ~(kCountBits | kSlotBits)) == marked(kind) ? IST_OK : IST_HANDLE_KIND;
}

}  // namespace

void fail_by_handle(Call& call, ist_status status, const char* argument, const char* kind) {
  switch (status) {
    case IST_OK:
      return;
    case IST_NULL_ARGUMENT:
      return call.fail(status, "{} is NULL: pass a {}", argument, kind);
    case IST_NOT_A_HANDLE:
      return call.fail(status, "{} is not a handle: pass a {} that this library created", argument,
                       kind);
    case IST_HANDLE_KIND:
      return call.fail(status, "{} is a handle of another kind: pass a {}", argument, kind);
    case IST_HANDLE_FREED:
      return call.fail(status,
                       "{} is a {} that was freed: do not use a handle after its ist_..._free",
                       argument, kind);
    case IST_HANDLE_BUSY:
      return call.fail(status, "another thread is using {}: create a {} for each thread", argument,
                       kind);
    default:
      return call.fail(status,
                       "{} handles are alive, the most possible: free a {} or another object",
                       HandleTable::kSlots, kind);
  }
}

std::uint64_t HandleTable::insert(HandleKind kind, void* object, Destroy destroy) noexcept {
  for (std::size_t tried = 0; tried < kSlots; ++tried) {
    const std::uint64_t at = next_.fetch_add(1, std::memory_order_relaxed) & kSlotBits;
    Slot& slot = slots_[at];
    std::uint64_t state = slot.state.load(std::memory_order_relaxed);
    if ((state & kMarkBits) != 0) continue;
    const std::uint64_t tag = marked(kind) | ((state + kCountOne) & kCountBits);
    if (!slot.state.compare_exchange_strong(state, tag, std::memory_order_acquire,
                                            std::memory_order_relaxed)) {
      continue;
    }
    slot.object = object;
    slot.destroy = destroy;
    slot.state.store(tag | kAlive, std::memory_order_release);
    return tag | at;
  }
  return 0;
}

HandleTable::Taken HandleTable::take(std::uint64_t handle, HandleKind kind,
                                     HandleUse use) noexcept {
  if (const ist_status wrong = check(handle, kind)) return {wrong, nullptr};
  Slot& slot = slots_[handle & kSlotBits];
  std::uint64_t state = slot.state.load(std::memory_order_relaxed);
  do {
    if ((state & ~kUsers) != (tag_of(handle) | kAlive)) return {IST_HANDLE_FREED, nullptr};
    const std::uint64_t users = use == HandleUse::kAlone ? kAlone : kShared;
    if ((state & users) == users) return {IST_HANDLE_BUSY, nullptr};
  } while (!slot.state.compare_exchange_weak(state, state + user(use), std::memory_order_acquire,
                                             std::memory_order_relaxed));
  return {IST_OK, slot.object};
}

void HandleTable::give_back(std::uint64_t handle, HandleUse use) noexcept {
  Slot& slot = slots_[handle & kSlotBits];
  const std::uint64_t before = slot.state.fetch_sub(user(use), std::memory_order_acq_rel);
  if ((before & kSlotBits) == user(use)) empty(slot);  // the last user of a removed object
}

ist_status HandleTable::remove(std::uint64_t handle, HandleKind kind) noexcept {
  if (const ist_status wrong = check(handle, kind)) return wrong;
  Slot& slot = slots_[handle & kSlotBits];
  std::uint64_t state = slot.state.load(std::memory_order_relaxed);
  do {
    if ((state & ~kUsers) != (tag_of(handle) | kAlive)) return IST_HANDLE_FREED;
  } while (!slot.state.compare_exchange_weak(state, state & ~kAlive, std::memory_order_acq_rel,
                                             std::memory_order_relaxed));
  if ((state & kUsers) == 0) empty(slot);
  return IST_OK;
}

// Only the last user of a removed object calls this.
void HandleTable::empty(Slot& slot) noexcept {
  slot.destroy(slot.object);
  slot.state.store(slot.state.load(std::memory_order_relaxed) & kCountBits,
                   std::memory_order_release);
}

HandleTable& handles() noexcept {
  static constinit HandleTable table;
  return table;
}

}  // namespace ist::capi
