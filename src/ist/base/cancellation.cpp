#include "ist/base/cancellation.h"

#include <utility>

#include "ist/base/error.h"

namespace ist {
namespace {

thread_local const std::atomic<bool>* asked_here = nullptr;

}  // namespace

ScopedCancellation::ScopedCancellation(const std::atomic<bool>& asked) noexcept
    : before_(std::exchange(asked_here, &asked)) {}

ScopedCancellation::~ScopedCancellation() { asked_here = before_; }

bool is_cancelled() noexcept {
  return asked_here != nullptr && asked_here->load(std::memory_order_relaxed);
}

void cancellation_point() {
  if (is_cancelled()) throw Error(ErrorCode::kCancelled, "the work was ended by its caller");
}

}  // namespace ist
