#include "cli/occlusion/figure/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>

namespace ist::cli {
namespace {

using answers::Colour;

using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;
using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

constexpr double kPointsInInch = 72;
constexpr const char* kFont = "DejaVu Sans";  // Debian's fontconfig installs it

void require(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  if (status != CAIRO_STATUS_SUCCESS) {
    throw std::runtime_error(std::string("a picture could not be drawn: ") +
                             cairo_status_to_string(status));
  }
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

// The CRC of PNG, bit by bit: of the few bytes of a chunk.
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes += static_cast<char>(static_cast<unsigned char>(number >> static_cast<unsigned>(shift)));
  }
  return bytes;
}

// Tells a PNG its resolution, by a chunk pHYs behind the head.
std::string with_resolution(std::string png, double dots_per_inch) {
  constexpr std::size_t kHead = 33;  // the signature and the chunk IHDR
  const auto per_metre = static_cast<std::uint32_t>(std::lround(dots_per_inch / 0.0254));
  const std::string chunk =
      "pHYs" + big_endian(per_metre) + big_endian(per_metre) + std::string(1, '\1');
  return png.insert(kHead, big_endian(9) + chunk + big_endian(crc_of(chunk)));
}

// An image of cairo: four bytes a pixel, as the processor orders a word.
Surface image_of(const Picture& picture) {
  Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture.width, picture.height),
                cairo_surface_destroy);
  require(cairo_surface_status(image.get()));
  unsigned char* const rows = cairo_image_surface_get_data(image.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(image.get()));
  const auto width = static_cast<std::size_t>(picture.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(picture.height); ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint8_t* rgb = &picture.rgb[3 * (y * width + x)];
      const std::uint32_t pixel = static_cast<std::uint32_t>(rgb[0]) << 16U |
                                  static_cast<std::uint32_t>(rgb[1]) << 8U | rgb[2];
      std::memcpy(rows + y * stride + 4 * x, &pixel, sizeof pixel);
    }
  }
  cairo_surface_mark_dirty(image.get());
  return image;
}

}  // namespace

struct Canvas::State {
  FigureKind kind;
  double dots_per_inch;
  std::string bytes;  // before the surface, which writes to it
  Surface surface{nullptr, cairo_surface_destroy};
  Context context{nullptr, cairo_destroy};

  void take(const Colour& colour) {
    cairo_set_source_rgb(context.get(), colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
  }
  void take(const TextStyle& style) {
    cairo_select_font_face(context.get(), kFont, CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context.get(), style.size);
  }
};

Canvas::Canvas(FigureKind kind, double width, double height, double dots_per_inch)
    : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.kind = kind;
  state.dots_per_inch = dots_per_inch;
  const double scale = dots_per_inch / kPointsInInch;
  if (kind == FigureKind::kPng) {
    state.surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                                   static_cast<int>(std::lround(width * scale)),
                                                   static_cast<int>(std::lround(height * scale))));
  } else if (kind == FigureKind::kSvg) {
    state.surface.reset(cairo_svg_surface_create_for_stream(append, &state.bytes, width, height));
  } else {
    state.surface.reset(cairo_pdf_surface_create_for_stream(append, &state.bytes, width, height));
    // No time of the clock, so that one bite gives one file.
    cairo_pdf_surface_set_metadata(state.surface.get(), CAIRO_PDF_METADATA_CREATE_DATE,
                                   "1980-01-01T00:00:00Z");
  }
  require(cairo_surface_status(state.surface.get()));
  state.context.reset(cairo_create(state.surface.get()));
  require(cairo_status(state.context.get()));
  if (kind == FigureKind::kPng) cairo_scale(state.context.get(), scale, scale);
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(state.context.get(), options);
  cairo_font_options_destroy(options);
  fill(0, 0, width, height, {255, 255, 255});
}

Canvas::~Canvas() = default;

void Canvas::fill(double x, double y, double width, double height, const Colour& colour) {
  state_->take(colour);
  cairo_rectangle(state_->context.get(), x, y, width, height);
  cairo_fill(state_->context.get());
}

void Canvas::line(std::span<const double> points, double width, const Colour& colour) {
  cairo_t* context = state_->context.get();
  cairo_new_path(context);  // a text leaves its end
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
    cairo_line_to(context, points[i], points[i + 1]);
  }
  state_->take(colour);
  cairo_set_line_width(context, width);
  cairo_stroke(context);
}

void Canvas::circle(double x, double y, double radius, const Colour& inside, double width,
                    const Colour& edge) {
  cairo_t* context = state_->context.get();
  cairo_new_path(context);
  cairo_arc(context, x, y, radius, 0, 6.283185307179586);
  state_->take(inside);
  cairo_fill_preserve(context);
  state_->take(edge);
  cairo_set_line_width(context, width);
  cairo_stroke(context);
}

double Canvas::width_of(const std::string& text, const TextStyle& style) const {
  cairo_text_extents_t extents;
  state_->take(style);
  cairo_text_extents(state_->context.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, const TextStyle& style) {
  cairo_t* context = state_->context.get();
  const double part = style.anchor == TextAnchor::kStart    ? 0
                      : style.anchor == TextAnchor::kMiddle ? 0.5
                                                            : 1;
  const double before = part * width_of(text, style);
  cairo_save(context);
  cairo_translate(context, x, y);
  if (style.upwards) cairo_rotate(context, -1.5707963267948966);
  cairo_move_to(context, -before, 0);
  if (style.halo) {
    cairo_text_path(context, text.c_str());
    state_->take(Colour{255, 255, 255});
    cairo_set_line_width(context, 0.28 * style.size);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(context);
    cairo_move_to(context, -before, 0);
  }
  state_->take(Colour{17, 17, 17});
  cairo_show_text(context, text.c_str());
  cairo_restore(context);
}

void Canvas::picture(double x, double y, double width, double height, const Picture& picture) {
  cairo_t* context = state_->context.get();
  const Surface image = image_of(picture);
  cairo_save(context);
  cairo_translate(context, x, y);
  cairo_scale(context, width / picture.width, height / picture.height);
  cairo_set_source_surface(context, image.get(), 0, 0);
  cairo_pattern_set_extend(cairo_get_source(context), CAIRO_EXTEND_PAD);
  cairo_rectangle(context, 0, 0, picture.width, picture.height);
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::hatch(double x, double y, double width, double height) {
  cairo_t* context = state_->context.get();
  cairo_save(context);
  cairo_rectangle(context, x, y, width, height);
  cairo_clip(context);
  for (double at = 0; at < width + height; at += 4) {
    const double points[] = {x + at, y, x + at - height, y + height};
    line(points, 1.3, {255, 255, 255});
  }
  cairo_restore(context);
}

std::string Canvas::finish() {
  State& state = *state_;
  require(cairo_status(state.context.get()));
  if (state.kind == FigureKind::kPng) {
    require(cairo_surface_write_to_png_stream(state.surface.get(), append, &state.bytes));
    return with_resolution(std::move(state.bytes), state.dots_per_inch);
  }
  cairo_surface_finish(state.surface.get());
  require(cairo_surface_status(state.surface.get()));
  return std::move(state.bytes);
}

bool has_canvas() { return true; }

std::string png_of(const Picture& picture) {
  std::string bytes;
  require(cairo_surface_write_to_png_stream(image_of(picture).get(), append, &bytes));
  return bytes;
}

}  // namespace ist::cli
