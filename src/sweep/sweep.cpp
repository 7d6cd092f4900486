#include "sweep/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <system_error>
#include <utility>
#include <vector>

#include "ist/base/cancellation.h"
#include "ist/base/checksum.h"
#include "ist/base/files.h"
#include "ist/base/float_environment.h"
#include "ist/base/parallel.h"
#include "ist/base/throw_error.h"
#include "ist/measure/penetration.h"
#include "ist/measure/require.h"
#include "ist/tree/mesh_source.h"
#include "ist/tree/sphere_tree.h"
#include "ist/tree/tree_parts.h"
#include "sweep/npy_file.h"
#include "sweep/pose_source.h"
#include "sweep/start_mark.h"
#include "sweep/sweep_record.h"

namespace ist {
namespace {

// Makes the depths of all rows faster, with the same balls in each process. Has cancellation
// points.
void prepare_depths(std::uint64_t rows, const SphereTree& fixed, const SphereTree& moving) {
  Progress progress;
  progress.watch([&progress] {
    if (is_cancelled()) progress.stop();
  });
  prepare_depth_for(rows, fixed, moving, &progress);
}

// Poses that are computed, and rows that are written, at a time: a block. Threads make their
// queries anew for each block, some milliseconds each, so a block grows with them.
constexpr std::uint64_t kRowsAThread = 4096;

std::uint64_t rows_at_once(std::size_t threads) {
  return kRowsAThread * (threads > 0 ? std::min(threads, thread_count()) : thread_count());
}

std::string questions_text(const SweepFile& file) {
  const RowQuestions& asked = file.questions;
  return fmt::format(
      "intersects {:d} leaf_pairs {:d} distance {:d} contacts {:d} penetration {:d} tolerance {} "
      "tests {} spheres {} margin {} stiffness {} rows_per_part {}",
      asked.intersects, asked.leaf_pairs, asked.distance, asked.contacts, asked.penetration,
      bits_of(asked.tolerance), asked.budget.tests,
      file.spheres ? to_string(*file.spheres) : "default", bits_of(file.margin),
      bits_of(file.stiffness), file.rows_per_part);
}

SweepIdentity identity_of(const SweepFile& file) {
  const std::string text = fmt::format(
      "ist sweep {}\nfixed {}\nmoving {}\nposes {}\n{}\n", kRowLayoutVersion, file.fixed.identity(),
      file.moving.identity(), file.poses->identity(), questions_text(file));
  Checksum hash;
  hash.add(text.data(), text.size());
  return {hash.text(), file.poses->count(), file.rows_per_part};
}

// A mesh without voxels answers by its triangles alone, so the other body must have some too.
void require_answers(const SweepBody& mesh, const SweepBody& other, const SphereTree& other_tree) {
  if (!mesh.is_mesh || mesh.voxel_size > 0 || other_tree.triangles() != nullptr) return;
  throw_error(
      ErrorCode::kInputInvalid,
      "{}: {} is a mesh without voxels, and {} is a tree without triangles: give the mesh a "
      "'voxel_size'",
      mesh.place, mesh.file.string(), other.file.string());
}

}  // namespace

struct Sweep::Bodies {
  SphereTree fixed, moving;
};

Sweep::Sweep(const std::filesystem::path& file)
    : file_(read_sweep_file(file)),
      layout_(layout_of(file_.questions, file_.poses->value_names())),
      identity_(identity_of(file_)) {}

void Sweep::poses(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const {
  const ScopedFloatEnvironment environment;
  file_.poses->read(first, poses);
  file_.poses->require_unchanged();
}

std::shared_ptr<const Sweep::Bodies> Sweep::bodies() const {
  const std::lock_guard lock(loading_);
  if (!bodies_) {
    const SweepBody &fixed = file_.fixed, &moving = file_.moving;
    auto loaded = std::make_shared<const Bodies>(
        Bodies{load_tree(fixed, file_.spheres), load_tree(moving, file_.spheres)});
    require_answers(fixed, moving, loaded->moving);
    require_answers(moving, fixed, loaded->fixed);
    for (const auto& [body, tree] :
         {std::pair(&fixed, &loaded->fixed), {&moving, &loaded->moving}}) {
      const std::string name = fmt::format("{}: {}", body->place, body->file.string());
      if (file_.questions.penetration) require_triangles(*tree, name);
      if (file_.questions.leaf_pairs || file_.questions.contacts) require_voxels(*tree, name);
      if (file_.spheres) tree->require(*file_.spheres, name);
    }
    const std::string reason =
        contradiction(loaded->moving, moving.file.string(), loaded->fixed, fixed.file.string());
    if (!reason.empty()) {
      throw_error(ErrorCode::kInputInvalid, "{}: {}", moving.place, reason);
    }
    if (file_.questions.penetration) prepare_depths(rows(), loaded->fixed, loaded->moving);
    const Query needs_the_spheres(loaded->fixed, loaded->moving, {.policy = file_.spheres});
    bodies_ = std::move(loaded);
  }
  return bodies_;
}

SweepFolder Sweep::open_folder(const std::filesystem::path& folder) const {
  std::error_code unknown;
  if (!std::filesystem::exists(folder / "sweep.json", unknown)) static_cast<void>(bodies());
  return {folder, identity_, layout_, SweepFolder::Access::kWrite};
}

bool Sweep::write_rows(std::uint64_t part, const Bodies& bodies, std::size_t threads,
                       const std::function<void(std::span<const std::byte>)>& write,
                       const Proceed& proceed) const {
  QueryOptions query_options;
  query_options.policy = file_.spheres;
  ManifoldOptions manifold_options;
  manifold_options.margin = file_.margin;
  Query query(bodies.fixed, bodies.moving, query_options);
  const std::uint64_t first = part * identity_.rows_per_part, rows = identity_.rows_of(part),
                      most = rows_at_once(threads);
  std::vector<Eigen::Isometry3d> poses;
  std::vector<std::byte> block;
  const std::size_t names = file_.poses->value_names().size();
  std::vector<double> values;
  for (std::uint64_t done = 0; done < rows; done += poses.size()) {
    poses.resize(std::min(most, rows - done));
    block.resize(poses.size() * layout_.bytes);
    values.resize(poses.size() * names);
    this->poses(first + done, poses);
    const auto give = [&](std::size_t index, const PoseRow& row) {
      const std::uint64_t number = first + done + index;
      const std::span<double> named = std::span(values).subspan(index * names, names);
      file_.poses->values(number, named);
      write_row(file_.questions, {number, named, poses[index]}, numbers_of(row, file_.stiffness),
                std::span(block).subspan(index * layout_.bytes, layout_.bytes));
    };
    const auto share = [&](double part_of_block) {
      const double now =
          static_cast<double>(done) + part_of_block * static_cast<double>(poses.size());
      return !proceed || proceed(now / static_cast<double>(rows));
    };
    if (!answer_rows({query, query_options, manifold_options}, poses, file_.questions, threads,
                     give, share)) {
      return false;
    }
    write(block);
  }
  return true;
}

Sweep::Outcome Sweep::run_part(const SweepFolder& folder, std::uint64_t part, std::size_t threads,
                               const Proceed& proceed) const {
  const ScopedFloatEnvironment environment;
  const PartStatus status = folder.look(part);
  if (status.state == PartState::kDone) {
    remove_marks(folder, part);
    return Outcome::kWasThere;
  }
  if (status.state == PartState::kGivenUp) return Outcome::kGivenUp;
  if (status.state == PartState::kDamaged) fail_damaged(folder, part);
  if (starts_of(folder, part).live) fail_overlap(folder, part);
  const StartMark mark(folder, part);
  const auto begin = std::chrono::steady_clock::now();
  const std::shared_ptr<const Bodies> loaded = bodies();
  OutputFile rows(folder.part_file(part)), record(folder.record_file(part));
  Checksum hash;
  const auto write = [&](const void* data, std::size_t bytes) {
    rows.write(data, bytes);
    hash.add(data, bytes);
  };
  const std::string header = npy_header(layout_, identity_.rows_of(part));
  write(header.data(), header.size());
  const auto write_block = [&](std::span<const std::byte> block) {
    write(block.data(), block.size());
  };
  if (!write_rows(part, *loaded, threads, write_block, proceed)) return Outcome::kStopped;
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  const std::string text = json_of(
      PartRecord{identity_.hash, part, identity_.rows_of(part), hash.text(), seconds.count()});
  record.write(text.data(), text.size());
  // The record gets its name first, so that a part that is there has one.
  const std::array<OutputFile*, 2> files = {&record, &rows};
  OutputFile::commit_all(files);
  remove_marks(folder, part);
  return Outcome::kMade;
}

}  // namespace ist
