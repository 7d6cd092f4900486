// Compiled as the library is, which makes it the library's own view.
#include "package/layout.h"
