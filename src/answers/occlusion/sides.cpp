#include "answers/occlusion/sides.h"

#include <cmath>

#include "answers/refusals.h"
#include "ist/base/direction.h"

namespace ist::answers {
namespace {

// The part of a sum that lies on the first side of a plane.
struct Parted {
  double first = 0, all = 0;

  void add(double pressed, double part) {
    first += part * pressed;
    all += pressed;
  }
  [[nodiscard]] Balance::Shares shares() const {
    if (!(all > 0)) return {};
    const double percent = 100 * first / all;
    return {percent, 100 - percent, std::abs(2 * percent - 100)};
  }
};

using Vector = Eigen::Vector3d;

std::optional<Vector> triple(const std::string& text, const std::string& option) {
  if (text.empty()) return std::nullopt;
  std::optional<Vector> given = vector_of(text);
  refuse_if(!given, option, text + ": give x,y,z, such as 1,0,0");
  return given;
}

std::optional<Vector> direction(const std::string& text, const std::string& option) {
  const std::optional<Vector> given = triple(text, option);
  if (!given) return std::nullopt;
  const std::optional<Direction> towards = direction_of(*given);
  refuse_if(!towards, option, text + ": it is no direction");
  return towards->unit;
}

}  // namespace

std::optional<Balance> balance_of(const SurfaceOcclusion& surface, const TriangleMesh& mesh,
                                  const Eigen::Isometry3d& to_fixed, const Division& division) {
  Parted parted, thinner, thicker;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const ContactRegion& region : surface.regions) {
    for (const ContactTriangle& contact : region.triangles) {
      const Triangle& corners = mesh.triangles[contact.triangle];
      const Eigen::Vector3d middle =
          to_fixed * Eigen::Vector3d((mesh.vertices[corners[0]] + mesh.vertices[corners[1]] +
                                      mesh.vertices[corners[2]]) /
                                     3);
      const double beyond = division.direction.dot(middle) - division.at;
      const double part = beyond > 0 ? 1 : beyond < 0 ? 0 : 0.5;
      parted.add(contact.pressed, part);
      thinner.add(contact.pressed_thinner, part);
      thicker.add(contact.pressed_thicker, part);
      moment += contact.pressed * middle;
    }
  }
  if (!(parted.all > 0)) return {};
  return Balance{parted.shares(), thinner.shares(), thicker.shares(), moment / parted.all};
}

std::pair<Division, Division> divisions(const SideOptions& options, PatientFrame of_files,
                                        const Eigen::AlignedBox3d& box) {
  std::optional<Vector> left = direction(options.left, "--left"),
                        front = direction(options.front, "--front");
  const std::optional<Vector> midline = triple(options.midline, "--midline");
  refuse_if(!options.frame.empty() && (left || front), "--frame",
            "contradicts --left and --front, which say the same");
  const PatientFrame given = patient_frame(options.frame).value_or(PatientFrame::kUnknown);
  refuse_if(contradict(given, of_files), "--frame",
            "it is {}, and the files are in {}: leave the option out", to_string(given),
            to_string(of_files));
  const PatientFrame frame = given == PatientFrame::kUnknown ? of_files : given;
  if (frame != PatientFrame::kUnknown) {
    const double sign = frame == PatientFrame::kLps ? 1 : -1;
    const Vector to_left(sign, 0, 0), to_front(0, -sign, 0);
    refuse_if(left && !(left->dot(to_left) > 0), "--left",
              "it points to the right in the files' frame, {}", to_string(frame));
    refuse_if(front && !(front->dot(to_front) > 0), "--front",
              "it points to the back in the files' frame, {}", to_string(frame));
    if (!left) left = to_left;
    if (!front) front = to_front;
  }
  refuse_if(left && front && !(std::abs(left->dot(*front)) < 0.99), "--front",
            "it is the direction of --left: give another");
  Division sides, fore_aft;
  sides.direction = left.value_or(Vector(1, 0, 0));
  sides.first = left ? "left" : "+x";
  sides.second = left ? "right" : "-x";
  sides.assumed = !midline;
  sides.at = sides.direction.dot(midline.value_or(box.center()));
  fore_aft.direction = front.value_or(Vector(0, 1, 0));
  fore_aft.first = front ? "anterior" : "+y";
  fore_aft.second = front ? "posterior" : "-y";
  fore_aft.at = fore_aft.direction.dot(box.center());
  return {sides, fore_aft};
}

}  // namespace ist::answers
