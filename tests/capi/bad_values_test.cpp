// What a caller gives that has no sense, and the code that it gets.

#include <cmath>
#include <limits>
#include <vector>

#include "capi/misuse_case.h"

namespace ist::test {
namespace {

TEST_F(CMisuse, OfAPoseIsToldAndNothingIsAnswered) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = HUGE_VAL;
  std::vector<std::array<double, 16>> poses;
  for (std::size_t i = 0; i < 16; ++i) {
    for (const double bad : {kNan, kInf, -kInf}) {
      poses.push_back(pose_);
      poses.back()[i] = bad;
    }
  }
  for (const auto& [at, value] :
       {std::pair<std::size_t, double>{0, 1.01}, {1, 0.1}, {10, -1}, {15, 2}, {3, 1}, {15, 0}}) {
    poses.push_back(pose_);
    poses.back()[at] = value;
  }
  for (const std::array<double, 16>& at : poses) {
    const double* pose = at.data();
    ASSERT_EQ(name(query(pose_.data())), "ok");
    ASSERT_GT(result_.contacts, 0u);
    EXPECT_EQ(name(query(pose)), "pose-invalid");
    EXPECT_EQ(result_.contacts + result_.written + result_.sphere_tests, 0u);
    EXPECT_EQ(result_.complete, 0);
    EXPECT_EQ(result_.resolution, 0);

    EXPECT_EQ(name(ist_query_collide_within(query_, pose, &budget_, contacts_, 4, &result_)),
              "pose-invalid");
    EXPECT_EQ(result_.complete + result_.gap_known, 0);
    sums_.weight = 7;
    EXPECT_EQ(name(ist_query_contact_points(query_, pose, points_, 4, &sums_, &result_)),
              "pose-invalid");
    EXPECT_EQ(sums_.weight, 0);
    sums_.weight = 7;
    EXPECT_EQ(
        name(ist_query_contact_points_within(query_, pose, &budget_, points_, 4, &sums_, &result_)),
        "pose-invalid");
    EXPECT_EQ(sums_.weight, 0);
    gap_.lower = gap_.upper = 7;
    EXPECT_EQ(name(ist_query_gap(query_, pose, 0.1, &gap_)), "pose-invalid");
    EXPECT_EQ(gap_.lower + gap_.upper, 0);
    touch_ = IST_TOUCH_NO;
    EXPECT_EQ(name(ist_query_touches(query_, pose, &touch_)), "pose-invalid");
    EXPECT_EQ(touch_, IST_TOUCH_UNKNOWN);
    exact_.pairs = 7;
    EXPECT_EQ(name(ist_query_exact(query_, pose, pairs_, 4, &exact_)), "pose-invalid");
    EXPECT_EQ(exact_.pairs, 0u);
    force_[1] = torque_[2] = 7;
    EXPECT_EQ(name(ist_servo_on_tick(servo_, pose, force_, torque_)), "pose-invalid");
    EXPECT_EQ(force_[1] + torque_[2], 0);
  }
}

// However the call fails, and whichever of its arguments is wrong.
TEST_F(CMisuse, LeavesNoSumsOfTheCallBefore) {
  const auto fails = [&](const ist_budget* budget, const char* status) {
    sums_.weight = 7;
    result_.contacts = 7;
    EXPECT_EQ(name(ist_query_contact_points_within(query_, pose_.data(), budget, points_, 4, &sums_,
                                                   &result_)),
              status);
    EXPECT_EQ(sums_.weight, 0);
  };
  fails(nullptr, "null-argument");
  ist_budget unsized{};
  fails(&unsized, "struct-size");
  EXPECT_EQ(result_.contacts, 0u);
  result_.struct_size = 0;
  fails(&budget_, "struct-size");
}

TEST_F(CMisuse, OfArraysIsTold) {
  const auto created = [&](std::size_t vertices, std::size_t triangles) {
    return name(ist_mesh_create(corners_.data(), vertices, indices_.data(), triangles, &no_mesh_));
  };
  EXPECT_EQ(name(ist_mesh_create(nullptr, 0, nullptr, 0, &no_mesh_)), "mesh-empty");
  EXPECT_EQ(created(3, 0), "mesh-points-only");
  EXPECT_EQ(created(std::size_t{1} << 32, 1), "argument-invalid");
  EXPECT_EQ(created(3, SIZE_MAX), "argument-invalid");
  EXPECT_EQ(created(2, 1), "mesh-bad-index");
  EXPECT_STREQ(ist_last_error_message(),
               "ist_mesh_create: triangle 0 names vertex 2, and there are 2: count from 0");
  corners_[5] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(created(3, 1), "mesh-not-finite");
  floats_[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(name(ist_mesh_create_float(floats_.data(), 3, indices_.data(), 1, &no_mesh_)),
            "mesh-not-finite");
  EXPECT_EQ(no_mesh_, nullptr);

  // A span of nothing is one; a longer one than memory is none.
  EXPECT_EQ(name(ist_query_collide(query_, pose_.data(), nullptr, 0, &result_)), "ok");
  EXPECT_EQ(result_.truncated, 1);
  EXPECT_EQ(name(ist_query_collide(query_, pose_.data(), contacts_, SIZE_MAX, &result_)),
            "argument-invalid");
}

TEST_F(CMisuse, OfOptionsIsTold) {
  const auto built = [&](auto change) {
    ist_build_options options = build_;
    change(options);
    return name(ist_tree_build(mesh_, &options, &no_tree_));
  };
  EXPECT_EQ(built([](auto& o) { o.voxel_size = 0; }), "voxel-size-invalid");
  EXPECT_EQ(built([](auto& o) { o.voxel_size = NAN; }), "voxel-size-invalid");
  EXPECT_EQ(built([](auto& o) { o.voxel_size = 1e-9; }), "voxel-size-too-small");
  EXPECT_EQ(built([](auto& o) { o.max_memory = 1; }), "memory-limit");
  EXPECT_EQ(built([](auto& o) { o.spheres = 5; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.spheres = -1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.keep_triangles = 2; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.proximity = -1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.reserved = 1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.struct_size = 0; }), "struct-size");

  const auto queried = [&](auto change) {
    ist_query_options options = query_options_;
    change(options);
    return name(ist_query_create(tree_, tree_, &options, &no_query_));
  };
  EXPECT_EQ(queried([](auto& o) { o.spheres = 5; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.workers = 3; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.workers = -1; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.period_ns = -2; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.frontier_pairs = UINT64_MAX; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.triangle_pairs = UINT64_MAX; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.contact_points = 4097; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.contact_points = -2; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.target = "z80"; }), "target-missing");
  EXPECT_EQ(queried([](auto& o) { o.struct_size = 7; }), "struct-size");

  const auto opened = [&](auto change) {
    ist_servo_options options = servo_options_;
    change(options);
    return name(ist_servo_open_scene(scene_.c_str(), &options, &no_servo_));
  };
  EXPECT_EQ(opened([](auto& o) { o.unit = 0; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.unit = 3; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.reserved = 1; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.query_share = -0.1; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.query_share = 1.1; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.query_share = NAN; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.struct_size = 1 << 20; }), "struct-size");

  budget_.struct_size = 4;
  EXPECT_EQ(name(ist_query_collide_within(query_, pose_.data(), &budget_, contacts_, 4, &result_)),
            "struct-size");
  EXPECT_EQ(name(ist_query_gap(query_, pose_.data(), NAN, &gap_)), "argument-invalid");
  EXPECT_EQ(name(ist_query_gap(query_, pose_.data(), -1, &gap_)), "argument-invalid");
  EXPECT_TRUE(!no_tree_ && !no_query_ && !no_servo_);
}

// A sound and an unsound file; the message names it.
TEST_F(CMisuse, OfFilesIsTold) {
  const std::string none = (folder_.path() / "none").string();
  EXPECT_EQ(name(ist_tree_load(none.c_str(), &no_tree_)), "file-unreadable");
  EXPECT_NE(std::string(ist_last_error_message()).find(none), std::string::npos);
  EXPECT_EQ(name(ist_tree_load(scene_.c_str(), &no_tree_)), "not-a-tree");
  EXPECT_EQ(name(ist_mesh_read(scene_.c_str(), &no_mesh_)), "not-a-mesh");
  EXPECT_EQ(name(ist_tree_save(tree_, "/no/such/folder/body.ist")), "file-unwritable");
  EXPECT_EQ(name(ist_servo_open_scene(none.c_str(), &servo_options_, &no_servo_)),
            "file-unreadable");
  const std::string bad = folder_.write("bad.toml", "unit = \"furlong\"\n").string();
  EXPECT_EQ(name(ist_servo_open_scene(bad.c_str(), &servo_options_, &no_servo_)), "input-invalid");
  EXPECT_TRUE(!no_mesh_ && !no_tree_ && !no_servo_);
}

}  // namespace
}  // namespace ist::test
