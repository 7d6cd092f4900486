#pragma once

/// Stands before each class and function that is meant for users: the shared library exports it,
/// and nothing else of `ist`. What an installed header declares without it is there because a
/// public class is made of it, and is no one's to call.
#define IST_API __attribute__((visibility("default")))

/// Stands before what is private in such a class: not exported, and so free to change.
#define IST_LOCAL __attribute__((visibility("hidden")))
