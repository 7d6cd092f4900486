#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "answers/formats/poly_data.h"
#include "cli/occlusion/map_picture.h"

namespace ist::cli {

/// The kind of a figure's file.
enum class FigureKind : std::uint8_t { kPng, kSvg, kPdf };

/// Where a text stands beside its place.
enum class TextAnchor : std::uint8_t { kStart, kMiddle, kEnd };

/// How a text looks.
struct TextStyle {
  double size = 7;  ///< points
  bool bold = false;
  bool halo = false;  ///< with a white edge, for texts on a picture
  TextAnchor anchor = TextAnchor::kStart;
  bool upwards = false;  ///< turned by a quarter, read from below
};

/// A page to draw on, by cairo. Lengths are points, 1/72 inch; y runs down. A build without cairo
/// has no canvas: its constructor and png_of() throw a Refusal that says so.
class Canvas {
 public:
  /// A white page. `dots_per_inch` counts for PNG.
  Canvas(FigureKind kind, double width, double height, double dots_per_inch);
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  ~Canvas();

  void fill(double x, double y, double width, double height, const answers::Colour& colour);
  /// Draws lines from point to point, x and y in turn.
  void line(std::span<const double> points, double width, const answers::Colour& colour);
  void circle(double x, double y, double radius, const answers::Colour& inside, double width,
              const answers::Colour& edge);
  /// Writes a text whose baseline begins, ends or has its middle at a place.
  void text(double x, double y, const std::string& text, const TextStyle& style = {});
  [[nodiscard]] double width_of(const std::string& text, const TextStyle& style = {}) const;
  void picture(double x, double y, double width, double height, const Picture& picture);
  /// Draws slanted white lines over a rectangle: hatched.
  void hatch(double x, double y, double width, double height);

  /// Returns the bytes of the file. Nothing is drawn after it. Throws std::runtime_error with what
  /// cairo says.
  [[nodiscard]] std::string finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws a Refusal of a build without cairo, about a file.
[[noreturn]] void refuse_without_canvas(const std::filesystem::path& file);

/// Returns whether this build has cairo.
[[nodiscard]] bool has_canvas();

/// Returns a picture as the bytes of a PNG file: 8 bits, RGB. Throws std::bad_alloc, a
/// std::runtime_error with what cairo says, and a Refusal in a build without cairo.
[[nodiscard]] std::string png_of(const Picture& picture);

}  // namespace ist::cli
