#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "ist/query/query.h"
#include "verify/answer_verifier.h"

namespace ist::test {

/// All that two trees can be asked, by each policy, and what holds of any answer: it is finite,
/// sorted and within range, the scalar form and the best target give the same one, and answers to
/// different questions do not contradict each other.
class QueryChecks {
 public:
  /// How far the trees are believed.
  enum class Trees {
    kBuilt,  ///< as build_tree made them: answers must keep the guarantee, and agree with each
             ///< other
    kRead,   ///< of a file that was made up: bounds may hold no triangle, and so tell of nothing
  };

  /// Both trees must outlive it.
  QueryChecks(const SphereTree& fixed, const SphereTree& moving, Trees trees);

  /// By each policy that both trees have. Throws Finding. Whether anything touches; nothing where
  /// the pose is no rigid motion.
  std::optional<bool> at(const Eigen::Isometry3d& pose);
  /// By the policy of that number; all are counted round.
  std::optional<bool> at(const Eigen::Isometry3d& pose, std::size_t policy);

 private:
  struct Asked;
  void check_invalid(Query& query, ContactManifold& points, const Eigen::Isometry3d& pose);
  void check_list(const Asked& asked) const;
  void check_gap(Query& query, const Asked& asked, const Eigen::Isometry3d& pose) const;
  void check_points(Query& query, ContactManifold& points, const Asked& asked,
                    const Eigen::Isometry3d& pose) const;
  void check_near(Query& scalar, Query& best, const std::vector<TrianglePair>& meeting,
                  const Eigen::Isometry3d& pose) const;
  void check_exact(Query& scalar, Query& best, const Asked& asked,
                   const Eigen::Isometry3d& pose) const;

  struct Policy {
    std::unique_ptr<Query> scalar, best;
    std::unique_ptr<ContactManifold> points;
    std::unique_ptr<AnswerVerifier> guarantee;  // of trees that were built
  };
  const SphereTree& fixed_;
  const SphereTree& moving_;
  bool built_;
  bool few_pairs_;  // so few leaves that all of them may touch
  std::vector<Policy> policies_;
};

}  // namespace ist::test
