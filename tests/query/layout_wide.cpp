// Compiled for AVX-512: a constant alone, so that every processor can read it.
#include "query/layout.h"

namespace ist::test {

constinit const decltype(public_layout()) kWideLayout = public_layout();

}  // namespace ist::test
