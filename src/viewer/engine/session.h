#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ist/base/progress.h"
#include "viewer/engine/asked.h"
#include "viewer/engine/fronts.h"
#include "viewer/engine/page_body.h"
#include "viewer/engine/pair.h"
#include "viewer/engine/reply.h"

namespace ist::viewer {

/// The page's two bodies, and the answers to all questions of page/protocol.js. Files lie in
/// folders of their own in memory, `fixed` and `moving` below the working folder.
class Session {
 public:
  /// Answers a question by its name. Throws kArgumentInvalid for an unknown name, and for
  /// members that are missing; and the errors of the functions that answer.
  [[nodiscard]] Reply answer(const std::string& question, const Asked& asked, Progress& progress);

 private:
  struct Recorded {
    Eigen::Isometry3d pose;
    SpherePolicy policy;
    std::vector<StepFront> fronts;
  };

  void make_jaws(const Asked& asked, Reply& reply);
  void open(const Asked& asked, Reply& reply);
  /// Gives each body the other one's role.
  void swap();
  void build(const Asked& asked, Progress& progress, Reply& reply);
  void first_contact(const Asked& asked, Progress& progress, Reply& reply);
  void level(const Asked& asked, Reply& reply);
  void touched(const Asked& asked, Reply& reply);
  void fronts(const Asked& asked, Reply& reply);
  void front(const Asked& asked, Reply& reply);
  void save_body(const Asked& asked, Reply& reply);

  /// Puts a body in the place of another, and forgets their pairs. All that may fail is done
  /// before: where memory ends, the bodies that the page shows are those that answer.
  void take(Role role, PageBody read);
  [[nodiscard]] std::optional<PageBody>& body(Role role) {
    return role == Role::kFixed ? fixed_ : moving_;
  }
  /// The body of that role. Throws kArgumentInvalid where the page has none.
  [[nodiscard]] PageBody& present(Role role);
  /// The queries of both trees. Throws kArgumentInvalid before build().
  [[nodiscard]] Pairs& pairs();
  /// Both bodies as `ist occlusion` takes them.
  [[nodiscard]] answers::Bodies whole();
  /// Gives the bodies the names of their files, and refuses two frames.
  void name(answers::Bodies& bodies);
  [[nodiscard]] const std::vector<StepFront>& recorded(const Asked& asked);

  std::optional<PageBody> fixed_, moving_;
  std::unique_ptr<Pairs> pairs_;
  std::optional<Recorded> recorded_;  // the fronts that were asked for last
};

}  // namespace ist::viewer
