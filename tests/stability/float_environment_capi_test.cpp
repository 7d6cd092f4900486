// In any arithmetic of the caller: what a program in C sees, of every kind of object.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "capi/c_bodies.h"
#include "ist/capi/ist_measure.h"
#include "ist/capi/ist_models.h"
#include "ist/capi/ist_world.h"
#include "stability/float_environment_case.h"

namespace ist::test {
namespace {

using CPose = std::array<double, 16>;

class FloatEnvironmentOfTheCInterface : public FloatEnvironmentOfTheCaller {
 protected:
  // A struct as it lies there: those of the interface have no gaps.
  template <class Struct>
  static void say(const Struct& given, Record& record) {
    static_assert(std::is_trivially_copyable_v<Struct>);
    record.add(std::string(reinterpret_cast<const char*>(&given), sizeof given));
  }
  // Whether a call did what it was asked; no text is made of it where it did.
  static void fine(ist_status status) {
    if (status != IST_OK) ADD_FAILURE() << ist_last_error_message();
  }

  [[nodiscard]] ist_mesh* mesh(const TriangleMesh& of) const {
    ist_mesh* made = nullptr;
    fine(ist_mesh_create(of.vertices.front().data(), of.vertices.size(),
                         of.triangles.front().data(), of.triangles.size(), &made));
    return made;
  }
  [[nodiscard]] ist_tree* built(const TriangleMesh& of) const {
    ist_mesh* from = mesh(of);
    auto options = sized<ist_build_options>();
    options.voxel_size = voxel_size_;
    ist_tree* made = nullptr;
    fine(ist_tree_build(from, &options, &made));
    fine(ist_mesh_free(from));
    return made;
  }
  // Oblique, of numbers that are exact in any arithmetic.
  [[nodiscard]] CPose oblique(double distance) const {
    return {0.28, 0.96, 0, 0, -0.96, 0.28, 0, 0, 0, 0, 1, 0, distance * unit_, 0, 0, 1};
  }

  // `call` takes two trees that were built before, and the record.
  template <class Call>
  void changes_nothing_of_trees(const std::string& name, std::size_t least, const Call& call) {
    ist_tree *fixed = built(fixed_), *moving = built(moving_);
    changes_nothing(name, least, [&](Record& record) { call(fixed, moving, record); });
    fine(ist_tree_free(fixed));
    fine(ist_tree_free(moving));
  }
  // `call` takes a query that is made in the caller's arithmetic, a pose and the record.
  template <class Call>
  void changes_no_answer(const std::string& name, std::size_t least, const Call& call) {
    changes_nothing_of_trees(name, least, [&](ist_tree* fixed, ist_tree* moving, Record& record) {
      ist_query* query = nullptr;
      fine(ist_query_create(fixed, moving, nullptr, &query));
      for (const CPose& pose : poses_) call(query, pose.data(), record);
      fine(ist_query_free(query));
    });
  }

  const double voxel_size_ = 0.11 * unit_, tolerance_ = 0x1p-10 * unit_;
  const TriangleMesh fixed_ = icosphere(2, unit_), moving_ = icosphere(1, 0.75 * unit_);
  // In each other, across each other, and apart.
  const std::vector<CPose> poses_ = {oblique(0.125), oblique(1.5), oblique(2.5)};
};

INSTANTIATE_TEST_SUITE_P(Units, FloatEnvironmentOfTheCInterface, ::testing::Values(1.0, 0x1p-20),
                         [](const auto& unit) { return unit.param == 1 ? "one" : "small"; });

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoMesh) {
  // A denormal float is a normal double.
  const std::array<float, 9> narrow = {1e-40F, -3e-42F, 0, 1, 2e-39F, 0.1F, 0, 1e-44F, 0.7F};
  const std::array<std::uint32_t, 3> corners = {0, 1, 2};
  changes_nothing("ist_mesh_create_float, ist_mesh_copy and ist_mesh_get_info", 1000,
                  [&](Record& record) {
                    ist_mesh* of_floats = nullptr;
                    fine(ist_mesh_create_float(narrow.data(), 3, corners.data(), 1, &of_floats));
                    ist_mesh* of_doubles = mesh(meshes_.a);
                    ist_mesh* jaw = nullptr;
                    fine(ist_jaw_create(IST_JAW_UPPER, 3, &jaw));
                    for (ist_mesh* each : {of_floats, of_doubles, jaw}) {
                      auto info = sized<ist_mesh_info>();
                      fine(ist_mesh_get_info(each, nullptr, &info));
                      say(info, record);
                      std::vector<double> copied(3 * info.vertices);
                      fine(ist_mesh_copy(each, copied.data(), info.vertices, nullptr, 0));
                      record.add(copied);
                      fine(ist_mesh_free(each));
                    }
                  });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoTree) {
  changes_nothing("ist_tree_build and what tells of a tree", 10'000, [&](Record& record) {
    ist_tree* tree = built(meshes_.a);
    auto info = sized<ist_tree_info>();
    fine(ist_tree_get_info(tree, &info));
    say(info, record);
    std::vector<double> centres(3 * info.leaves);
    fine(ist_tree_copy_leaf_centres(tree, centres.data(), info.leaves));
    record.add(centres);
    std::uint64_t bytes = 0;
    fine(ist_tree_to_memory(tree, nullptr, 0, nullptr, &bytes));
    std::string file(bytes, '\0');
    fine(ist_tree_to_memory(tree, file.data(), bytes, nullptr, &bytes));
    record.add(file);
    fine(ist_tree_free(tree));
    fine(ist_tree_from_memory(file.data(), bytes, nullptr, &tree));
    ist_mesh* kept = nullptr;
    fine(ist_tree_get_mesh(tree, &kept));
    auto report = sized<ist_mesh_info>();
    fine(ist_mesh_get_info(kept, nullptr, &report));
    say(report, record);
    fine(ist_mesh_free(kept));
    fine(ist_tree_free(tree));
  });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoLeafPair) {
  changes_no_answer(
      "ist_query_leaf_pairs", 1000, [](ist_query* query, const double* pose, Record& record) {
        std::vector<ist_leaf_pair> pairs(1 << 12);
        auto result = sized<ist_query_result>();
        fine(ist_query_leaf_pairs(query, pose, nullptr, pairs.data(), pairs.size(), &result));
        say(result, record);
        for (std::size_t i = 0; i < result.written; ++i) say(pairs[i], record);
      });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoNearPair) {
  const double margin = 0.25 * unit_;
  changes_no_answer("ist_query_near_pairs and ist_query_near_parts", 500,
                    [margin](ist_query* query, const double* pose, Record& record) {
                      std::vector<ist_near_pair> pairs(1 << 12);
                      auto result = sized<ist_near_pairs_result>();
                      fine(ist_query_near_pairs(query, pose, margin, nullptr, pairs.data(),
                                                pairs.size(), &result));
                      say(result, record);
                      for (std::size_t i = 0; i < result.written; ++i) say(pairs[i], record);
                      fine(ist_query_near_parts(query, pose, 3, 5, 16 * margin, pairs.data(),
                                                pairs.size(), &result));
                      say(result, record);
                      for (std::size_t i = 0; i < result.written; ++i) say(pairs[i], record);
                    });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoContact) {
  changes_no_answer("ist_query_contacts and ist_contact_sums_wrench", 1000,
                    [](ist_query* query, const double* pose, Record& record) {
                      std::array<ist_contact, 32> contacts{};
                      auto sums = sized<ist_contact_sums>();
                      auto result = sized<ist_query_result>();
                      fine(ist_query_contacts(query, pose, nullptr, contacts.data(),
                                              contacts.size(), &sums, &result));
                      say(result, record);
                      say(sums, record);
                      for (std::size_t i = 0; i < result.written; ++i) say(contacts[i], record);
                      std::array<double, 3> force{}, torque{};
                      fine(ist_contact_sums_wrench(&sums, 0.3, force.data(), torque.data()));
                      say(force, record);
                      say(torque, record);
                    });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoAnswerOfTriangles) {
  changes_no_answer(
      "ist_query_distance, intersects and triangle_pairs", 500,
      [this](ist_query* query, const double* pose, Record& record) {
        auto gap = sized<ist_distance_result>();
        fine(ist_query_distance(query, pose, tolerance_, nullptr, &gap));
        say(gap, record);
        std::int32_t answer = 0;
        fine(ist_query_intersects(query, pose, nullptr, &answer));
        record.add(answer);
        double error = 0;
        fine(ist_rotation_error(pose, &error));
        record.add(error);
        std::vector<ist_triangle_pair> pairs(1 << 12);
        auto result = sized<ist_triangle_pairs_result>();
        fine(ist_query_triangle_pairs(query, pose, nullptr, pairs.data(), pairs.size(), &result));
        say(result, record);
        for (std::size_t i = 0; i < result.written; ++i) say(pairs[i], record);
      });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoDistanceOfAPoint) {
  changes_nothing_of_trees("ist_tree_signed_distance and ist_tree_distance_map", 1000,
                           [&](ist_tree* fixed, ist_tree* moving, Record& record) {
                             const std::size_t count = moving_.vertices.size();
                             std::vector<ist_surface_distance> distances(count);
                             fine(ist_tree_signed_distance(fixed, moving_.vertices.front().data(),
                                                           count, 9, nullptr, distances.data()));
                             for (const ist_surface_distance& each : distances) say(each, record);
                             std::uint64_t vertices = 0;
                             fine(ist_tree_distance_map(moving, fixed, poses_[1].data(), 9, nullptr,
                                                        distances.data(), count, &vertices));
                             for (const ist_surface_distance& each : distances) say(each, record);
                           });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoDepth) {
  changes_no_answer(
      "ist_query_penetration", 300, [this](ist_query* query, const double* pose, Record& record) {
        auto depth = sized<ist_penetration>();
        fine(ist_query_penetration(query, pose, tolerance_, nullptr, nullptr, nullptr, &depth));
        say(depth, record);
      });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoEscape) {
  changes_no_answer("ist_query_escape", 300,
                    [this](ist_query* query, const double* pose, Record& record) {
                      auto found = sized<ist_escape>();
                      fine(ist_query_escape(query, pose, tolerance_, INFINITY, nullptr, &found));
                      say(found, record);
                    });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoFirstContact) {
  const CPose to = poses_[0];
  changes_no_answer(
      "ist_query_first_contact", 400, [&](ist_query* query, const double* pose, Record& record) {
        for (const double* end : {to.data(), static_cast<const double*>(nullptr)}) {
          ist_motion motion{sizeof(ist_motion), pose, end, {0.1, 0.2, 0.3}, {1, 2, 3}, 0.7, 0.3};
          auto found = sized<ist_first_contact>();
          fine(ist_query_first_contact(query, &motion, tolerance_, nullptr, nullptr, &found));
          say(found, record);
        }
      });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoOcclusion) {
  const std::array<double, 2> limits = {0.05 * unit_, 0.1 * unit_};
  auto options = sized<ist_occlusion_options>();
  options.reach = unit_;
  options.contact = 0.1 * unit_;
  options.least_area = -1;
  options.longest_edge = 0.2 * unit_;
  options.foundation = 0.1 * unit_;
  options.change = 0.05 * unit_;
  options.limits = limits.data();
  options.limit_count = limits.size();
  changes_no_answer(
      "ist_query_occlusion", 1000, [&](ist_query* query, const double* pose, Record& record) {
        std::vector<ist_surface_distance> distances(fixed_.vertices.size());
        std::vector<ist_contact_region> regions(8);
        std::array<double, 2> areas{};
        auto arrays = sized<ist_occlusion_arrays>();
        arrays.distances = distances.data();
        arrays.distance_capacity = distances.size();
        arrays.regions = regions.data();
        arrays.region_capacity = regions.size();
        arrays.areas = areas.data();
        auto fixed = sized<ist_occlusion>(), moving = sized<ist_occlusion>();
        fine(
            ist_query_occlusion(query, pose, &options, nullptr, &arrays, nullptr, &fixed, &moving));
        say(fixed, record);
        say(moving, record);
        for (const ist_surface_distance& each : distances) say(each, record);
        for (const ist_contact_region& each : regions) say(each, record);
        say(areas, record);
      });
}

// The stiffness rounds: each thread multiplies by it.
TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoRow) {
  std::vector<double> poses;
  for (int copy = 0; copy < 4; ++copy) {
    for (const CPose& pose : poses_) poses.insert(poses.end(), pose.begin(), pose.end());
  }
  const std::size_t count = poses.size() / 16;
  changes_nothing_of_trees(
      "ist_query_rows", 1000, [&](ist_tree* fixed, ist_tree* moving, Record& record) {
        ist_query* query = nullptr;
        fine(ist_query_create(fixed, moving, nullptr, &query));
        auto options = sized<ist_rows_options>();
        options.questions = IST_ASK_INTERSECTS | IST_ASK_LEAF_PAIRS | IST_ASK_DISTANCE |
                            IST_ASK_CONTACTS | IST_ASK_PENETRATION;
        options.tolerance = tolerance_;
        options.stiffness = 0.3;
        for (const std::int32_t threads : {1, 2}) {
          options.threads = threads;
          std::vector<ist_row> rows(count);
          fine(ist_query_rows(query, poses.data(), count, &options, rows.data()));
          for (const ist_row& row : rows) say(row, record);
        }
        fine(ist_query_free(query));
      });
}

TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoWorld) {
  changes_nothing_of_trees(
      "an ist_world's verbs", 2000, [&](ist_tree* fixed, ist_tree* moving, Record& record) {
        auto options = sized<ist_world_options>();
        options.reach = unit_;
        ist_world* world = nullptr;
        fine(ist_world_create(&options, &world));
        std::uint32_t body = 0;
        fine(ist_world_add(world, fixed, poses_[2].data(), "large", &body));
        fine(ist_world_add(world, moving, poses_[0].data(), "small", &body));
        fine(ist_world_add(world, fixed, poses_[1].data(), "other", &body));
        fine(ist_world_reserve(world, IST_ALL_PAIRS));
        std::vector<ist_world_pair> pairs(8);
        auto result = sized<ist_world_result>();
        const auto say_all = [&](ist_status status) {
          fine(status);
          say(result, record);
          for (std::size_t i = 0; i < result.written; ++i) say(pairs[i], record);
        };
        fine(ist_world_set_pose(world, 1, poses_[1].data()));
        CPose between{};
        fine(ist_world_get_pose(world, 0, 1, between.data()));
        say(between, record);
        std::vector<ist_leaf_pair> leaves(1 << 14);
        std::vector<ist_triangle_pair> triangles(1 << 14);
        for (const int ask : {IST_ASK_NEAR, IST_ASK_INTERSECTS, IST_ASK_CONTACTS,
                              IST_ASK_LEAF_PAIRS, IST_ASK_TRIANGLE_PAIRS, IST_ASK_DISTANCE}) {
          const auto question =
              sized<ist_world_question>({0, ask, 0, tolerance_, leaves.data(), leaves.size(),
                                         triangles.data(), triangles.size()});
          say_all(ist_world_ask(world, &question, nullptr, pairs.data(), pairs.size(), &result));
        }
        auto sums = sized<ist_contact_sums>();
        std::uint64_t contacts = 0;
        fine(ist_world_get_contacts(world, 0, 1, nullptr, 0, &sums, &contacts));
        say(sums, record);
        auto least = sized<ist_least_distance>();
        fine(ist_world_distance(world, tolerance_, nullptr, &least));
        say(least, record);
        fine(ist_world_free(world));
      });
}

// Poses in millimetres: each way a number is divided by a thousandth.
TEST_P(FloatEnvironmentOfTheCInterface, ChangesNoServo) {
  const std::filesystem::path scene = folder_.write("scene.toml", kSmallScene);
  changes_nothing("ist_servo_on_tick and ist_servo_get_body", 3000, [&](Record& record) {
    auto options = sized<ist_servo_options>();
    options.unit = IST_UNIT_MM;
    options.sphere_tests = 1'000'000;  // so that no clock counts
    ist_servo* servo = nullptr;
    fine(ist_servo_open_scene(scene.c_str(), &options, &servo));
    auto info = sized<ist_servo_info>();
    fine(ist_servo_get_info(servo, &info));
    record.add(info.tick_seconds);
    CPose pose;
    std::copy_n(info.tool, 16, pose.begin());
    for (const double height : {4.5, 3.9, 3.7, 3.3, 3.1, 3.1, 3.1, 3.1}) {
      pose[12] = 0.1;
      pose[14] = height;
      std::array<double, 3> force{}, torque{};
      fine(ist_servo_on_tick(servo, pose.data(), force.data(), torque.data()));
      say(force, record);
      say(torque, record);
      fine(ist_servo_get_info(servo, &info));
      for (const double number : info.tool) record.add(number);
      auto state = sized<ist_servo_state>();
      fine(ist_servo_get_state(servo, &state));
      for (const double number : state.device) record.add(number);
      for (std::size_t i = 0; i < state.contact_count; ++i) {
        say(state.contacts[i].position, record);
        record.add(state.contacts[i].gap);
      }
      for (const std::size_t index : {0U, 1U}) {
        auto body = sized<ist_servo_body>();
        fine(ist_servo_get_body(servo, index, &body));
        for (const double number : body.pose) record.add(number);
      }
    }
    fine(ist_servo_free(servo));
  });
}

}  // namespace
}  // namespace ist::test
