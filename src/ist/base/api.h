#pragma once

/// @file
/// Checks the language of a program, and defines IST_API and IST_LOOP_API.
#if __cplusplus < 202002L
#error "IST needs C++20: compile with -std=c++20, or ask CMake for cxx_std_20"
#endif

/// Marks each class and function of the public interface. The shared libraries export it.
#define IST_API __attribute__((visibility("default")))
/// Marks internals of libist that libist_loop calls. No public header declares them, and they may
/// change with each build: both libraries come from one package.
#define IST_LOOP_API __attribute__((visibility("default")))
