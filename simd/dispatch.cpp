#include "simd/dispatch.h"

#include <cstdlib>
#include <string>

#include "ist/base/throw_error.h"

namespace ist {

std::span<const Kernels> all_kernels() {
  static const std::vector<Kernels> kernels = [] {
    std::vector<Kernels> all = simd::supported_kernels();
    all.push_back(kScalarKernels);
    all.back().clusters = kScalarClusterKernels;
    return all;
  }();
  return kernels;
}

const Kernels& select_kernels(std::string_view target) {
  std::string_view wanted = target;
  if (wanted.empty()) {
    const char* named = std::getenv("IST_TARGET");
    if (named != nullptr) wanted = named;
  }
  if (wanted.empty()) return all_kernels().front();
  std::string names;
  for (const Kernels& kernels : all_kernels()) {
    if (wanted == kernels.target) return kernels;
    names += names.empty() ? "" : ", ";
    names += kernels.target;
  }
  throw_error(ErrorCode::kTargetMissing,
              "{}{}: this processor has no such instruction set: name one of {}",
              target.empty() ? "IST_TARGET=" : "target ", wanted, names);
}

}  // namespace ist
