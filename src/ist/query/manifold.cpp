#include "ist/query/manifold.h"

#include <utility>

#include "ist/base/float_environment.h"
#include "ist/query/contacts/contact_reducer.h"

namespace ist {

ContactManifold::ContactManifold(const SphereTree& fixed, const SphereTree& moving,
                                 SpherePolicy policy, const ManifoldOptions& options)
    : reducer_(std::make_unique<detail::ContactReducer>(fixed, moving, policy, options)) {}
ContactManifold::ContactManifold(std::unique_ptr<detail::ContactReducer> reducer) noexcept
    : reducer_(std::move(reducer)) {}
ContactManifold::~ContactManifold() = default;
ContactManifold::ContactManifold(ContactManifold&&) noexcept = default;
ContactManifold& ContactManifold::operator=(ContactManifold&&) noexcept = default;

std::span<const Contact> ContactManifold::points() const noexcept { return reducer_->points(); }
const ContactSums& ContactManifold::sums() const noexcept { return reducer_->sums(); }
const ContactRates& ContactManifold::rates() const noexcept { return reducer_->rates(); }
SpherePolicy ContactManifold::policy() const noexcept { return reducer_->policy(); }
std::size_t ContactManifold::bytes() const noexcept { return reducer_->bytes(); }

Wrench ContactManifold::wrench(double stiffness) const noexcept {
  const ScopedFloatEnvironment environment;
  return {stiffness * sums().spring.force, stiffness * sums().spring.torque};
}

}  // namespace ist
