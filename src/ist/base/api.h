#pragma once

/// @file
/// The requirements of the C++ headers on their compiler.
#if __cplusplus < 202002L
#error "IST needs C++20: compile with -std=c++20, or ask CMake for cxx_std_20"
#elif !defined(EIGEN_MAX_ALIGN_BYTES) || EIGEN_MAX_ALIGN_BYTES != 16
// Eigen's alignment depends on the caller's instruction set, and a program may free memory that the
// library allocated: both need the same alignment.
#error "IST needs -DEIGEN_MAX_ALIGN_BYTES=16, as CMake's ist::ist and pkg-config's ist give it"
#endif

/// Marks each class and function of the public interface: the shared library exports it, and
/// nothing else of namespace ist.
#define IST_API __attribute__((visibility("default")))
