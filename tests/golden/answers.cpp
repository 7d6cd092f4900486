// What is hashed: the built-in jaws as they close and turn, at poses of whole numbers and
// quotients, so that no sine of a platform comes in.

#include "golden/answers.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "golden/hasher.h"
#include "ist/ist.h"
#include "ist/measure.h"
#include "ist/models/models.h"
#include "query/scenes.h"

namespace ist::test {
namespace {

// The jaws, a step along their closing: turned about y by an angle of tangent-half step / 256.
Eigen::Isometry3d closing(int step) {
  const double half = step / 256.0, cosine = (1 - half * half) / (1 + half * half),
               sine = 2 * half / (1 + half * half);
  Eigen::Matrix3d rotation;
  rotation << cosine, 0, sine, 0, 1, 0, -sine, 0, cosine;
  return pose_of(rotation, {0, 0, -1.5 + step / 8.0});
}
constexpr int kSteps = 16;

SphereTree tree_of(Jaw jaw) { return build_tree(make_jaw(jaw, 1), {.voxel_size = 0.8}); }
const SphereTree& upper() {
  static const SphereTree tree = tree_of(Jaw::kUpper);
  return tree;
}
const SphereTree& lower() {
  static const SphereTree tree = tree_of(Jaw::kLower);
  return tree;
}

Query query_of(const std::string& target, SpherePolicy policy = SpherePolicy::kSlab) {
  return {upper(), lower(), options_of(policy, target)};
}

// A file's name in a folder that no other process has, gone with this object. An address would not
// tell processes apart: an emulator gives each the same.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& name) {
    const auto root = std::filesystem::temp_directory_path();
    for (int i = 0; folder_.empty(); ++i) {
      const auto folder = root / ("ist-golden-" + std::to_string(i));
      if (std::filesystem::create_directory(folder)) folder_ = folder;
    }
    path_ = folder_ / name;
  }
  ~ScratchFile() { std::filesystem::remove_all(folder_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_, path_;
};

std::uint64_t hash_mesh_file(const std::string&) {
  const ScratchFile file("golden.obj");
  std::ofstream(file.path()) << "v 0.1 1e-3 -2.5\nv 1.7976931348623157 -0 3\nv 4 .25 1e-40\n"
                                "v 1 2 3.00000000000000044\nf 1 2 3 4\nf -1 -2 -4\n";
  const TriangleMesh mesh = read_mesh(file.path());
  Hasher hasher;
  for (const Eigen::Vector3d& vertex : mesh.vertices) hasher.add(vertex);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) hasher.add(corner);
  return hasher.value();
}

std::uint64_t hash_tree_file(const std::string&) {
  const ScratchFile file("golden.ist");
  Hasher hasher;
  for (const SphereTree* tree : {&upper(), &lower()}) {
    write_tree(*tree, file.path());
    std::ifstream stream(file.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    hasher.add(bytes.size()).add(bytes);
    hasher.add(read_tree(file.path()).leaf_count());
  }
  return hasher.value();
}

void add(Hasher& hasher, const FoundPairs& found) {
  hasher.add(found.result.leaf_pairs).add(found.result.resolution);
  for (const LeafPair& pair : found.leaf_pairs) hasher.add(pair.fixed).add(pair.moving);
}

std::uint64_t hash_leaf_pairs(const std::string& target) {
  Hasher hasher;
  for (const SpherePolicy policy : kSpherePolicies) {
    Query query = query_of(target, policy);
    for (int step = 0; step < kSteps; ++step) {
      const FoundPairs found = ask(query, closing(step));
      add(hasher, found);
      hasher.add(found.result.sphere_tests);
    }
  }
  return hasher.value();
}

// Sixteen ticks a step. How many tests a kept cache takes is not promised.
std::uint64_t hash_coherent_ticks(const std::string& target) {
  QueryOptions options = options_of(SpherePolicy::kSlab, target);
  options.front_pairs = 1 << 14;
  Query query(upper(), lower(), options);
  Hasher hasher;
  for (int tick = 0; tick < 16 * kSteps; ++tick) {
    Eigen::Isometry3d pose = closing(tick / 16);
    pose.translation()[2] += (tick % 16) / 128.0;
    add(hasher, ask(query, pose));
  }
  return hasher.value();
}

std::uint64_t hash_contacts(const std::string& target) {
  Query query = query_of(target);
  ContactManifold manifold(upper(), lower(), SpherePolicy::kSlab, {.margin = 2});
  Hasher hasher;
  for (int step = 0; step < kSteps; ++step) {
    hasher.add(query.contacts(closing(step), manifold).sphere_tests);
    for (const Contact& contact : manifold.points())
      hasher.add(contact.position).add(contact.normal).add(contact.depth).add(contact.weight);
    const ContactSums& sums = manifold.sums();
    hasher.add(sums.weight).add(sums.pairs);
    for (const Wrench& wrench : {sums.pressure, sums.spring})
      hasher.add(wrench.force).add(wrench.torque);
  }
  return hasher.value();
}

std::uint64_t hash_distances(const std::string& target) {
  Query query = query_of(target);
  Hasher hasher;
  for (int step = 0; step < kSteps; ++step) {
    for (const double tolerance : {1.0, 1e-6}) {
      const DistanceResult found = query.distance(closing(step), tolerance);
      hasher.add(found.distance.lower).add(found.distance.upper).add(found.sphere_tests);
    }
    hasher.add(static_cast<int>(query.intersects(closing(step)).answer) -
               static_cast<int>(ist::Answer::kNo));
  }
  return hasher.value();
}

std::uint64_t hash_triangle_pairs(const std::string& target) {
  Query query = query_of(target);
  std::vector<TrianglePair> pairs(1 << 14);
  Hasher hasher;
  for (int step = 0; step < kSteps; ++step) {
    const TrianglePairsResult found = query.triangle_pairs(closing(step), pairs);
    hasher.add(found.triangle_pairs);
    for (std::size_t i = 0; i < found.triangle_pairs; ++i)
      hasher.add(pairs[i].fixed).add(pairs[i].moving);
  }
  return hasher.value();
}

std::uint64_t hash_depths(const std::string& target) {
  Query query = query_of(target);
  Hasher hasher;
  for (int step = 0; step < kSteps; step += 4) {
    const Penetration found = penetration(query, closing(step), 1e-3);
    hasher.add(found.lower).add(found.upper).add(found.point).add(found.direction);
    hasher.add(found.triangle).add(found.points);
  }
  return hasher.value();
}

std::uint64_t hash_first_contact(const std::string& target) {
  Query query = query_of(target);
  Hasher hasher;
  const FirstContact found = first_contact(query, shift({0, 0, -8}), shift({0, 0, 0}), 1e-6);
  hasher.add(static_cast<int>(found.status)).add(found.lower).add(found.upper);
  return hasher.add(found.distances).add(found.verdicts).value();
}

std::uint64_t hash_distance_maps(const std::string&) {
  Hasher hasher;
  for (const SurfaceDistance& found : distance_map(lower(), upper(), closing(8), 2.0))
    hasher.add(found.distance).add(found.closest).add(found.triangle).add(found.is_signed);
  return hasher.value();
}

std::uint64_t hash_occlusion(const std::string& target) {
  const Occlusion found = occlusion(query_of(target), closing(8));
  Hasher hasher;
  for (const SurfaceOcclusion* surface : {&found.fixed, &found.moving}) {
    for (const double area : surface->areas) hasher.add(area);
    hasher.add(surface->depth_integral).add(surface->depth_at_vertices);
    for (const ContactRegion& region : surface->regions)
      hasher.add(region.area).add(region.centre).add(region.share).add(region.triangle);
  }
  return hasher.value();
}

constexpr std::array kAnswers = {
    GoldenAnswers{"mesh file", 0xc0542f7b2473c8ba, hash_mesh_file},
    GoldenAnswers{"tree files", 0xf5d2a9ee2adff184, hash_tree_file},
    GoldenAnswers{"leaf pairs and tests", 0x924b5bda8f1fa5e1, hash_leaf_pairs},
    GoldenAnswers{"coherent ticks", 0xd704caff42bef0a4, hash_coherent_ticks},
    GoldenAnswers{"contacts and sums", 0xf800fbf00066d2c0, hash_contacts},
    GoldenAnswers{"distances", 0xe47c88ee01fc4669, hash_distances},
    GoldenAnswers{"triangle pairs", 0xf4fb385f0075206d, hash_triangle_pairs},
    GoldenAnswers{"penetration depths", 0x2adc10e0063bd7f3, hash_depths},
    GoldenAnswers{"first contact", 0xf510ec2d6e67eea0, hash_first_contact},
    GoldenAnswers{"distance maps", 0x0b43056e86f61326, hash_distance_maps},
    GoldenAnswers{"occlusion", 0x816fa098faf3e09c, hash_occlusion},
};

}  // namespace

std::span<const GoldenAnswers> golden_answers() { return kAnswers; }

}  // namespace ist::test
