#include "ist/sweep/npy_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "ist/base/error.h"
#include "ist/sweep/file_hash.h"
#include "ist/sweep/npy_file.h"

namespace ist {

NpyPoses::NpyPoses(const std::filesystem::path& file)
    : file_(file), written_at_(file_.written_at()), hash_(hash_of_file(file_)) {
  const NpyDoubles array = read_npy_header(file_);
  if (array.shape.size() != 3 || array.shape[1] != 4 || array.shape[2] != 4) {
    throw Error(ErrorCode::kInputInvalid,
                fmt::format("{}: its shape is ({}): write poses of shape (N, 4, 4)", file.string(),
                            fmt::join(array.shape, ", ")));
  }
  count_ = array.shape[0];
  offset_ = array.offset;
}

void NpyPoses::read(std::uint64_t first, std::span<Eigen::Isometry3d> poses) const {
  using Numbers = std::array<double, 16>;
  constexpr std::size_t kAtOnce = 1024;  // poses
  std::vector<Numbers> block(std::min(kAtOnce, poses.size()));
  for (std::size_t done = 0; done < poses.size(); done += block.size()) {
    block.resize(std::min(kAtOnce, poses.size() - done));
    file_.read_at(offset_ + (first + done) * sizeof(Numbers), block.data(),
                  block.size() * sizeof(Numbers));
    for (std::size_t i = 0; i < block.size(); ++i) {
      for (int entry = 0; entry < 16; ++entry) {
        poses[done + i].matrix()(entry / 4, entry % 4) = block[i][static_cast<std::size_t>(entry)];
      }
    }
  }
}

std::string NpyPoses::identity() const { return fmt::format("file {} count {}", hash_, count_); }

void NpyPoses::require_unchanged() const {
  if (file_.written_at() == written_at_) return;
  throw Error(ErrorCode::kInputInvalid,
              fmt::format("{}: the file was written since the sweep was opened: begin anew, with a "
                          "folder of its own",
                          file_.path().string()));
}

}  // namespace ist
