#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "capi/c_bodies.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {

/// One handle of each kind, and all other arguments of a call.
class CMisuse : public ::testing::Test {
 protected:
  CMisuse() {
    mesh_ = c_mesh(box({0, 0, 0}, {2, 2, 2}));
    tree_ = c_tree(box({0, 0, 0}, {2, 2, 2}), 0.5);
    EXPECT_EQ(name(ist_query_create(tree_, tree_, nullptr, &query_)), "ok");
    servo_options_.unit = IST_UNIT_MM;
    EXPECT_EQ(name(ist_servo_open_scene(scene_.c_str(), &servo_options_, &servo_)), "ok")
        << ist_last_error_message();
    build_.voxel_size = 0.5;
  }
  ~CMisuse() override {
    EXPECT_EQ(name(ist_servo_free(servo_)), "ok");
    EXPECT_EQ(name(ist_query_free(query_)), "ok");
    EXPECT_EQ(name(ist_tree_free(tree_)), "ok");
    EXPECT_EQ(name(ist_mesh_free(mesh_)), "ok");
  }

  [[nodiscard]] ist_status query(const double* pose) {
    return ist_query_leaf_pairs(query_, pose, nullptr, leaf_pairs_, 4, &result_);
  }

  const TempDir folder_;
  const std::string scene_ = folder_.write("scene.toml", kSmallScene).string();
  const std::string file_ = (folder_.path() / "body.ist").string();
  ist_mesh* mesh_ = nullptr;
  ist_tree* tree_ = nullptr;
  ist_query* query_ = nullptr;
  ist_servo* servo_ = nullptr;

  // The other arguments and the outputs of a call.
  std::array<double, 16> pose_ = c_shift(1.5, 0, 0);
  std::array<double, 9> corners_ = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::array<float, 9> floats_ = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::array<std::uint32_t, 3> indices_ = {0, 1, 2};
  ist_mesh_info mesh_info_ = sized<ist_mesh_info>();
  std::uint64_t count_ = 0;
  ist_tree_info tree_info_ = sized<ist_tree_info>();
  ist_query_info query_info_ = sized<ist_query_info>();
  ist_servo_info servo_info_ = sized<ist_servo_info>();
  ist_build_options build_ = sized<ist_build_options>();
  ist_query_options query_options_ = sized<ist_query_options>();
  ist_servo_options servo_options_ = sized<ist_servo_options>();
  ist_budget budget_ = sized<ist_budget>();
  ist_query_result result_ = sized<ist_query_result>();
  ist_contact_sums sums_ = sized<ist_contact_sums>();
  ist_distance_result distance_ = sized<ist_distance_result>();
  ist_triangle_pairs_result triangle_result_ = sized<ist_triangle_pairs_result>();
  ist_leaf_pair leaf_pairs_[4] = {};
  ist_contact contacts_[4] = {};
  ist_triangle_pair triangle_pairs_[4] = {};
  std::int32_t answer_ = 0;
  double force_[3] = {}, torque_[3] = {};
  ist_mesh* no_mesh_ = nullptr;
  ist_tree* no_tree_ = nullptr;
  ist_query* no_query_ = nullptr;
  ist_servo* no_servo_ = nullptr;
};

}  // namespace ist::test
