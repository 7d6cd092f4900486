#include "sweep/sweep_body.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "ist/base/cancellation.h"
#include "ist/base/checksum.h"
#include "ist/base/error.h"
#include "ist/tree/tree_stream.h"
#include "sweep/pose_source.h"

namespace ist {
namespace {

constexpr NumberRange kVoxelSize{1e-12, 1e12, "in mesh units"};
constexpr std::string_view kBody = "the name of a mesh or of a tree";
constexpr std::string_view kUnits = R"("mm", "m", "inch" or "um")";
constexpr std::string_view kFrames = R"("ras" or "lps")";

// The keys of a body. `table` is empty if the sweep file gives a name alone.
struct BodyKeys {
  std::optional<TableReader> table;
  std::string_view file;  // the key that names the file, in the table or in the sweep file
};

BodyKeys keys_of(TableReader& sweep, std::string_view name) {
  if (sweep.is_text(name)) return {std::nullopt, name};
  TableReader table = sweep.table(name);
  table.may_have({"file", "tree", "hash", "voxel_size", "unit", "frame"});
  // Older sweep files have `tree`.
  const bool is_older = table.has("tree");
  if (is_older && table.has("file")) {
    table.fail("tree", table.name() + " has both 'file' and 'tree'", "take out 'tree'");
  }
  if (!is_older && !table.has("file")) table.fail_missing("file", kBody);
  return {std::move(table), is_older ? "tree" : "file"};
}

// Whether the questions need voxels. Triangles answer the other questions.
bool need_voxels(const RowQuestions& asked) { return asked.leaf_pairs || asked.contacts; }

// Returns the unit or frame that the sweep file or the mesh says. Throws if they contradict.
template <typename Word>
Word agreed(const SweepBody& body, const char* key, Word told, Word said) {
  if (!contradict(told, said)) return told == Word::kUnknown ? said : told;
  throw Error(ErrorCode::kInputInvalid,
              fmt::format("{0} says that its {1} is {2}, and '{1}' says {3}: take the key out",
                          body.file.string(), key, to_string(said), to_string(told)));
}

SphereTree build(const SweepBody& body, std::optional<SpherePolicy> spheres) {
  TriangleMesh mesh = read_mesh(body.file);
  mesh.unit = agreed(body, "unit", body.unit, mesh.unit);
  mesh.frame = agreed(body, "frame", body.frame, mesh.frame);
  BuildOptions options;
  options.voxel_size = body.voxel_size;  // 0: a tree without voxels
  options.spheres = spheres.value_or(options.spheres);
  Progress progress;
  // Only the thread that called has a cancellation, and it takes part in the build.
  progress.watch([&progress] {
    if (is_cancelled()) progress.stop();
  });
  return build_tree(std::move(mesh), options, nullptr, &progress);
}

// Runs `read`. Its errors get the place of the body.
template <typename Read>
auto at_place(const SweepBody& body, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kCancelled) throw;
    throw Error(error.code(), fmt::format("{}: {}", body.place, error.what()));
  }
}

}  // namespace

std::string SweepBody::identity() const {
  if (!is_mesh) return hash;
  return fmt::format("{} voxels {} unit {} frame {}", hash, bits_of(voxel_size), to_string(unit),
                     to_string(frame));
}

SweepBody read_sweep_body(TableReader& sweep, std::string_view name,
                          const RowQuestions& questions) {
  BodyKeys keys = keys_of(sweep, name);
  TableReader& reader = keys.table ? *keys.table : sweep;
  SweepBody body;
  body.file = sweep.file().parent_path() / reader.text(keys.file, kBody);
  body.place = reader.place(keys.file);
  std::error_code unknown;
  if (!std::filesystem::exists(body.file, unknown)) {
    reader.fail(keys.file, fmt::format("there is no file {}", body.file.string()),
                fmt::format("check '{}'; a relative path starts at the folder of the sweep file",
                            keys.file));
  }
  body.is_mesh =
      body.file.extension() != ".ist" && !at_place(body, [&] { return is_tree_file(body.file); });
  if (keys.table) {
    TableReader& table = *keys.table;
    static_cast<void>(table.has("hash"));
    for (const char* key : {"voxel_size", "unit", "frame"}) {
      if (!table.has(key) || body.is_mesh) continue;
      table.fail(key, fmt::format("'{}' is for a mesh, and {} is a tree", key, body.file.string()),
                 "take the key out, or name the mesh");
    }
    if (table.has("voxel_size")) body.voxel_size = table.number("voxel_size", kVoxelSize);
    if (table.has("unit")) body.unit = table.choice("unit", length_unit, kUnits);
    if (table.has("frame")) body.frame = table.choice("frame", patient_frame, kFrames);
  }
  if (body.is_mesh && body.voxel_size == 0 && need_voxels(questions)) {
    reader.fail(keys.file,
                fmt::format("{} is a mesh, and \"leaf_pairs\" and \"contacts\" need voxels",
                            body.file.string()),
                fmt::format("give [{}] a 'voxel_size', or name a tree", name));
  }
  return body;
}

void compute_hash(TableReader& sweep, std::string_view name, SweepBody& body) {
  at_place(body, [&] {
    if (!body.is_mesh) static_cast<void>(TreeReader(body.file));
    body.hash = hash_of_file(body.file);
  });
  if (sweep.is_text(name)) return;
  TableReader table = sweep.table(name);
  if (!table.has("hash")) return;
  const std::string expected =
      table.text("hash", "the 32 hexadecimal digits of the file's XXH3-128");
  if (expected == body.hash) return;
  table.fail(
      "hash",
      fmt::format("{} changed: its hash is {}, not {}", body.file.string(), body.hash, expected),
      "take the file that the sweep was made for, or write the new hash and begin anew");
}

SphereTree load_tree(const SweepBody& body, std::optional<SpherePolicy> spheres) {
  return at_place(body, [&] {
    SphereTree tree = body.is_mesh ? build(body, spheres) : read_tree(body.file);
    if (hash_of_file(body.file) == body.hash) return tree;
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{} changed since the sweep was opened: take the file that the sweep "
                            "was made for, or begin anew, with a folder of its own",
                            body.file.string()));
  });
}

}  // namespace ist
