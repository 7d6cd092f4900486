// A build without cairo (IST_WITH_CAIRO=OFF).
#include "answers/refusals.h"
#include "cli/occlusion/figure/canvas.h"

namespace ist::cli {
namespace {

[[noreturn]] void refuse() { refuse_without_canvas("a report with pictures"); }

}  // namespace

struct Canvas::State {};

Canvas::Canvas(FigureKind, double, double, double) { refuse(); }
Canvas::~Canvas() = default;
void Canvas::fill(double, double, double, double, const answers::Colour&) {}
void Canvas::line(std::span<const double>, double, const answers::Colour&) {}
void Canvas::circle(double, double, double, const answers::Colour&, double,
                    const answers::Colour&) {}
void Canvas::text(double, double, const std::string&, const TextStyle&) {}
double Canvas::width_of(const std::string&, const TextStyle&) const { return 0; }
void Canvas::picture(double, double, double, double, const Picture&) {}
void Canvas::hatch(double, double, double, double) {}
std::string Canvas::finish() { refuse(); }

bool has_canvas() { return false; }
std::string png_of(const Picture&) { refuse(); }

}  // namespace ist::cli
