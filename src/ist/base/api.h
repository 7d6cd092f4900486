#pragma once

// Eigen's alignment hangs on the instruction set of who compiles, and what the library allocates
// the program may free: so both have it alike.
#if !defined(EIGEN_MAX_ALIGN_BYTES) || EIGEN_MAX_ALIGN_BYTES != 16
#error "IST needs -DEIGEN_MAX_ALIGN_BYTES=16, as CMake's ist::ist and pkg-config's ist give it"
#endif

/// Stands before each class and function that is meant for users: the shared library exports it,
/// and nothing else of `ist`. What an installed header declares without it is there because a
/// public class is made of it, and is no one's to call.
#define IST_API __attribute__((visibility("default")))

/// Stands before what is private in such a class: not exported, and so free to change.
#define IST_LOCAL __attribute__((visibility("hidden")))
