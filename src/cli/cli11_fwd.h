#pragma once

/// Declares the classes of CLI11 that headers name. Including CLI11 takes seconds of compile time.
namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI
