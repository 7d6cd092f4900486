#pragma once

/// @file
/// Checks the language of a program, and defines IST_API.
#if __cplusplus < 202002L
#error "IST needs C++20: compile with -std=c++20, or ask CMake for cxx_std_20"
#endif

/// Marks each class and function of the public interface: the shared library exports it, and
/// nothing else of namespace ist.
#define IST_API __attribute__((visibility("default")))
