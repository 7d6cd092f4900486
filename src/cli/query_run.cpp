#include "cli/query_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "answers/engine.h"
#include "cli/answer_words.h"
#include "cli/contact_file.h"
#include "cli/exit_code.h"
#include "cli/progress_bar.h"
#include "cli/terminal.h"
#include "ist/measure/penetration.h"
#include "ist/tree/implicit_ball.h"
#include "verify/answer_verifier.h"

namespace ist::cli {

using namespace answers;

namespace {

std::vector<PoseAnswer> ask(Engines& engines, Examiner& examiner,
                            const std::vector<AskedPose>& poses, int repeat,
                            std::optional<ContactWriter>& writer) {
  std::vector<PoseAnswer> answers(poses.size());
  ProgressBar progress;
  progress.begin_stage("asking", static_cast<std::uint64_t>(repeat) * poses.size());
  for (int round = 0; round < repeat; ++round) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const auto& [pose, displacement, rotation_error] = poses[i];
      if (round == 0) {
        answers[i] = {pose, displacement, examiner.at(pose),
                      std::vector<EngineAnswer>(engines.size())};
        answers[i].findings.rotation_error = rotation_error;
      }
      for (std::size_t e = 0; e < engines.size(); ++e) {
        const Engine::Answer given = engines[e].ask(pose);
        answers[i].engines[e].result = given.result;
        answers[i].engines[e].microseconds.push_back(given.microseconds);
        if (writer && round == 0 && e == 0) {
          writer->write(i, pose, engines[e].leaf_pairs(), given.result.complete);
        }
      }
      progress.add(1);
    }
  }
  return answers;
}

// Runs each engine at each pose once more, untimed, and checks the answers against the guarantee.
// Prints the checked properties to stderr; throws a Failure that names pose, engine and pair.
void verify(Engines& engines, const Bodies& bodies, const std::vector<AskedPose>& poses) {
  const AnswerVerifier check(bodies.fixed, bodies.moving, bodies.policy);
  {
    ProgressBar progress;
    progress.begin_stage("verifying", poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      std::vector<GivenAnswer> answers;
      for (Engine& engine : engines) {
        const QueryResult result = engine.ask(poses[i].pose).result;
        answers.push_back({result, engine.leaf_pairs(), engine.nested()});
      }
      if (const std::optional<Violation> violation = check.check(poses[i].pose, answers)) {
        throw Failure(kGuaranteeBroken,
                      fmt::format("pose {}, engine {}: {}. This is an error in ist: please report "
                                  "it with both bodies and the pose",
                                  i, engines[violation->answer].name(), violation->detail));
      }
      progress.add(1);
    }
  }
  const bool by_triangles = !is_implicit(bodies.policy) && check.knows_geometry();
  for (const Engine& engine : engines) {
    std::fprintf(stderr,
                 "verified, %s: at each of %zu poses, the bounds of every leaf pair overlap, and "
                 "no pair of voxels whose %s is missing\n",
                 std::string(engine.name()).c_str(), poses.size(),
                 !engine.nested() ? "cubes intersect"
                 : by_triangles   ? "bounds overlap or whose triangles cross"
                                  : "bounds overlap");
  }
}

}  // namespace

Meeting run_queries(const Bodies& bodies, const std::vector<AskedPose>& poses,
                    const QuestionOptions& options) {
  Examiner examiner(bodies, options.questions, options.target);
  Engines engines;  // none without voxels
  for (const std::string& name : options.asked_engines()) {
    if (!bodies.have_voxels()) break;
    engines.emplace_back(
        name, bodies.fixed, bodies.moving,
        EngineOptions{bodies.policy, options.target, options.workers, options.questions.max_tests});
  }
  std::optional<ContactWriter> writer;
  if (!options.contacts.empty()) writer.emplace(options.contacts, bodies);
  {
    ProgressBar progress;
    prepare_depth_for(poses.size(), bodies.fixed, bodies.moving, &progress);
  }
  const std::vector<PoseAnswer> answers = ask(engines, examiner, poses, options.repeat, writer);
  if (options.verify) verify(engines, bodies, poses);
  if (writer) writer->commit();
  const bool timing = options.timing || options.repeat > 1;
  if (options.json) {
    print_header(options.subcommand,
                 {{"fixed", options.files.fixed}, {"moving", options.files.moving}}, bodies);
    print_answer_lines(engines, bodies, answers);
  } else {
    print_answers(engines, bodies, answers, timing);
  }
  Meeting most = Meeting::kNone;
  for (const PoseAnswer& answer : answers) most = std::max(most, answer.findings.meeting());
  return most;
}

void fail_where_they_meet(Meeting meeting) {
  if (meeting == Meeting::kNone) return;
  const bool unknown = meeting == Meeting::kUnknown || meeting == Meeting::kMayBeInside;
  throw Failure(unknown ? kFailed : kTouching, to_string(meeting));
}

}  // namespace ist::cli
