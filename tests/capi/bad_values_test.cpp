// Invalid values and their error codes.

#include <cmath>
#include <limits>
#include <vector>

#include "capi/c_bodies.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

// One handle of each kind, and all other arguments of a call.
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
  ist_mesh* mesh_ = nullptr;
  ist_tree* tree_ = nullptr;
  ist_query* query_ = nullptr;
  ist_servo* servo_ = nullptr;

  // The other arguments and the outputs of a call.
  std::array<double, 16> pose_ = c_shift(1.5, 0, 0);
  std::array<double, 9> corners_ = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::array<float, 9> floats_ = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::array<std::uint32_t, 3> indices_ = {0, 1, 2};
  ist_build_options build_ = sized<ist_build_options>();
  ist_query_options query_options_ = sized<ist_query_options>();
  ist_servo_options servo_options_ = sized<ist_servo_options>();
  ist_budget budget_ = sized<ist_budget>();
  ist_query_result result_ = sized<ist_query_result>();
  ist_contact_sums sums_ = sized<ist_contact_sums>();
  ist_distance_result distance_ = sized<ist_distance_result>();
  ist_triangle_pairs_result triangle_result_ = sized<ist_triangle_pairs_result>();
  ist_near_pairs_result near_result_ = sized<ist_near_pairs_result>();
  ist_leaf_pair leaf_pairs_[4] = {};
  ist_contact contacts_[4] = {};
  ist_triangle_pair triangle_pairs_[4] = {};
  ist_near_pair near_pairs_[4] = {};
  std::int32_t answer_ = 0;
  double force_[3] = {}, torque_[3] = {};
  ist_mesh* no_mesh_ = nullptr;
  ist_tree* no_tree_ = nullptr;
  ist_query* no_query_ = nullptr;
  ist_servo* no_servo_ = nullptr;
};

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
    ASSERT_GT(result_.leaf_pairs, 0u);
    EXPECT_EQ(name(query(pose)), "pose-invalid");
    EXPECT_EQ(result_.leaf_pairs + result_.written + result_.sphere_tests, 0u);
    EXPECT_EQ(result_.complete, 0);
    EXPECT_EQ(result_.resolution, 0);

    for (const ist_budget* budget : std::array<const ist_budget*, 2>{nullptr, &budget_}) {
      result_.complete = result_.distance_known = 7;
      EXPECT_EQ(name(ist_query_leaf_pairs(query_, pose, budget, leaf_pairs_, 4, &result_)),
                "pose-invalid");
      EXPECT_EQ(result_.complete + result_.distance_known, 0);
      sums_.weight = 7;
      result_.contacts = 7;
      EXPECT_EQ(name(ist_query_contacts(query_, pose, budget, contacts_, 4, &sums_, &result_)),
                "pose-invalid");
      EXPECT_EQ(sums_.weight, 0);
      EXPECT_EQ(result_.contacts, 0u);
    }
    distance_.lower = distance_.upper = distance_.complete = 7;
    EXPECT_EQ(name(ist_query_distance(query_, pose, 0.1, nullptr, &distance_)), "pose-invalid");
    EXPECT_EQ(distance_.lower + distance_.upper + distance_.complete, 0);
    answer_ = IST_ANSWER_NO;
    EXPECT_EQ(name(ist_query_intersects(query_, pose, nullptr, &answer_)), "pose-invalid");
    EXPECT_EQ(answer_, IST_ANSWER_UNKNOWN);
    triangle_result_.pairs = 7;
    EXPECT_EQ(name(ist_query_triangle_pairs(query_, pose, nullptr, triangle_pairs_, 4,
                                            &triangle_result_)),
              "pose-invalid");
    EXPECT_EQ(triangle_result_.pairs, 0u);
    near_result_.pairs = 7;
    EXPECT_EQ(name(ist_query_near_pairs(query_, pose, 0.1, nullptr, near_pairs_, 4, &near_result_)),
              "pose-invalid");
    EXPECT_EQ(near_result_.pairs, 0u);
    near_result_.pairs = 7;
    EXPECT_EQ(name(ist_query_near_parts(query_, pose, 0, 0, 9, near_pairs_, 4, &near_result_)),
              "pose-invalid");
    EXPECT_EQ(near_result_.pairs, 0u);
    force_[1] = torque_[2] = 7;
    EXPECT_EQ(name(ist_servo_on_tick(servo_, pose, force_, torque_)), "pose-invalid");
    EXPECT_EQ(force_[1] + torque_[2], 0);
  }
}

// A failed call clears all outputs, whichever argument is wrong.
TEST_F(CMisuse, LeavesNoSumsOfTheCallBefore) {
  const auto fails = [&](const ist_budget* budget, const ist_contact* contacts,
                         const char* status) {
    sums_.weight = 7;
    result_.leaf_pairs = 7;
    EXPECT_EQ(name(ist_query_contacts(query_, pose_.data(), budget,
                                      const_cast<ist_contact*>(contacts), 4, &sums_, &result_)),
              status);
    EXPECT_EQ(sums_.weight, 0);
  };
  fails(nullptr, nullptr, "null-argument");
  EXPECT_EQ(result_.leaf_pairs, 0u);
  ist_budget unsized{};
  fails(&unsized, contacts_, "struct-size");
  EXPECT_EQ(result_.leaf_pairs, 0u);
  result_.struct_size = 0;
  fails(&budget_, contacts_, "struct-size");

  result_ = sized<ist_query_result>();
  result_.leaf_pairs = 7;
  sums_.struct_size = 4;
  EXPECT_EQ(name(ist_query_contacts(query_, pose_.data(), nullptr, contacts_, 4, &sums_, &result_)),
            "struct-size");
  EXPECT_EQ(result_.leaf_pairs, 0u);
  EXPECT_STREQ(ist_last_error_message(),
               "ist_query_contacts: sums->struct_size is 4: set it to sizeof, which is 144");
}

// A failed call clears each wrench output that it has.
TEST_F(CMisuse, OfAWrenchIsToldAndGivesNoForce) {
  sums_.spring_force[0] = 2;
  sums_.spring_torque[1] = 3;
  const auto fails = [&](const ist_contact_sums* sums, double stiffness, double* force,
                         double* torque, const char* status) {
    std::fill_n(force_, 3, 7.0);
    std::fill_n(torque_, 3, 7.0);
    EXPECT_EQ(name(ist_contact_sums_wrench(sums, stiffness, force, torque)), status);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(force_[i], force == nullptr ? 7 : 0);
      EXPECT_EQ(torque_[i], torque == nullptr ? 7 : 0);
    }
  };
  fails(nullptr, 1, force_, torque_, "null-argument");
  fails(&sums_, 1, nullptr, torque_, "null-argument");
  fails(&sums_, 1, force_, nullptr, "null-argument");
  for (const double bad : {static_cast<double>(NAN), HUGE_VAL, -HUGE_VAL}) {
    fails(&sums_, bad, force_, torque_, "argument-invalid");
  }
  EXPECT_STREQ(ist_last_error_message(),
               "ist_contact_sums_wrench: stiffness is -inf: pass a finite number");
  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::size_t{100}, SIZE_MAX}) {
    sums_.struct_size = size;
    fails(&sums_, 1, force_, torque_, "struct-size");
  }
  ist_contact_sums longer[2] = {sums_, sums_};
  longer[0].struct_size = sizeof(ist_contact_sums) + 8;
  longer[1].struct_size = 1;  // the member that follows
  fails(longer, 1, force_, torque_, "struct-size");
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
  EXPECT_STREQ(
      ist_last_error_message(),
      "ist_mesh_create: triangle 0 has the vertex index 2, but there are 2 vertices: count "
      "from 0");
  corners_[5] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(created(3, 1), "mesh-not-finite");
  floats_[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(name(ist_mesh_create_float(floats_.data(), 3, indices_.data(), 1, &no_mesh_)),
            "mesh-not-finite");
  EXPECT_EQ(no_mesh_, nullptr);

  // An empty array is valid; an array longer than any memory is not.
  EXPECT_EQ(name(ist_query_leaf_pairs(query_, pose_.data(), nullptr, nullptr, 0, &result_)), "ok");
  EXPECT_EQ(result_.truncated, 1);
  EXPECT_EQ(
      name(ist_query_leaf_pairs(query_, pose_.data(), nullptr, leaf_pairs_, SIZE_MAX, &result_)),
      "argument-invalid");
  EXPECT_STREQ(ist_last_error_message(),
               "ist_query_leaf_pairs: pairs has 18446744073709551615 elements: pass at most "
               "36028797018963967");
  EXPECT_EQ(name(ist_query_contacts(query_, pose_.data(), nullptr, contacts_, SIZE_MAX, nullptr,
                                    &result_)),
            "argument-invalid");
  EXPECT_EQ(name(ist_query_triangle_pairs(query_, pose_.data(), nullptr, triangle_pairs_, SIZE_MAX,
                                          &triangle_result_)),
            "argument-invalid");
}

TEST_F(CMisuse, OfOptionsIsTold) {
  const auto built = [&](auto change) {
    ist_build_options options = build_;
    change(options);
    return name(ist_tree_build(mesh_, &options, &no_tree_));
  };
  EXPECT_EQ(built([](auto& o) { o.voxel_size = -1; }), "voxel-size-invalid");
  EXPECT_EQ(built([](auto& o) { o.voxel_size = NAN; }), "voxel-size-invalid");
  EXPECT_EQ(built([](auto& o) { o.voxel_size = 1e-9; }), "voxel-size-too-small");
  EXPECT_EQ(built([](auto& o) { o.voxel_size = 0, o.drop_triangles = 1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.voxel_size = 0, o.proximity = 1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.max_memory = 1; }), "memory-limit");
  EXPECT_EQ(built([](auto& o) { o.spheres = 5; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.spheres = -1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.drop_triangles = 2; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.proximity = -1; }), "argument-invalid");
  EXPECT_EQ(built([](auto& o) { o.no_weld = 2; }), "argument-invalid");
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
  EXPECT_EQ(queried([](auto& o) { o.near_pairs = (1 << 26) + 1; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.contacts = 4097; }), "argument-invalid");
  EXPECT_EQ(queried([](auto& o) { o.contacts = -2; }), "argument-invalid");
  for (const double bad : {2.001, -0.5, -1.0, -2.0, HUGE_VAL, -HUGE_VAL, double{NAN}}) {
    EXPECT_EQ(queried([bad](auto& o) { o.margin = bad; }), "argument-invalid") << bad;
  }
  EXPECT_STREQ(ist_last_error_message(),
               "ist_query_create: options->margin is nan: pass a number from 0, where surfaces "
               "meet, to 2 mean voxel sizes");
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
  EXPECT_EQ(opened([](auto& o) { o.query_time_fraction = -0.1; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.query_time_fraction = 1.1; }), "argument-invalid");
  EXPECT_EQ(opened([](auto& o) { o.query_time_fraction = NAN; }), "argument-invalid");
  EXPECT_STREQ(ist_last_error_message(),
               "ist_servo_open_scene: options->query_time_fraction is nan: pass a fraction of a "
               "tick, from 0 to 1");
  EXPECT_EQ(opened([](auto& o) { o.struct_size = 1 << 20; }), "struct-size");

  budget_.struct_size = 4;
  EXPECT_EQ(name(ist_query_leaf_pairs(query_, pose_.data(), &budget_, leaf_pairs_, 4, &result_)),
            "struct-size");
  EXPECT_EQ(
      name(ist_query_contacts(query_, pose_.data(), &budget_, contacts_, 4, &sums_, &result_)),
      "struct-size");
  distance_.upper = 7;
  EXPECT_EQ(name(ist_query_distance(query_, pose_.data(), NAN, nullptr, &distance_)),
            "argument-invalid");
  EXPECT_EQ(distance_.upper, 0);
  EXPECT_EQ(name(ist_query_distance(query_, pose_.data(), -1, nullptr, &distance_)),
            "argument-invalid");
  EXPECT_TRUE(!no_tree_ && !no_query_ && !no_servo_);
}

TEST_F(CMisuse, OfNearPairsIsToldAndNothingIsAnswered) {
  const auto pairs = [&](double margin, ist_near_pair* out, std::size_t room) {
    near_result_.pairs = near_result_.written = 7;
    const std::string status =
        name(ist_query_near_pairs(query_, pose_.data(), margin, nullptr, out, room, &near_result_));
    if (status != "ok") {
      EXPECT_EQ(near_result_.pairs + near_result_.written, 0u);
    }
    return status;
  };
  const auto parts = [&](std::uint32_t fixed, std::uint32_t moving, double margin,
                         ist_near_pair* out, std::size_t room) {
    near_result_.pairs = near_result_.written = 7;
    const std::string status = name(ist_query_near_parts(query_, pose_.data(), fixed, moving,
                                                         margin, out, room, &near_result_));
    if (status != "ok") {
      EXPECT_EQ(near_result_.pairs + near_result_.written, 0u);
    }
    return status;
  };
  for (const double bad : {double{NAN}, HUGE_VAL, -HUGE_VAL, -1e-300}) {
    EXPECT_EQ(pairs(bad, near_pairs_, 4), "argument-invalid") << bad;
    EXPECT_EQ(parts(0, 0, bad, near_pairs_, 4), "argument-invalid") << bad;
  }
  EXPECT_STREQ(ist_last_error_message(),
               "ist_query_near_parts: margin is -1e-300: pass a finite number of at least 0");
  EXPECT_EQ(pairs(0.1, nullptr, 4), "null-argument");
  EXPECT_EQ(parts(0, 0, 9, nullptr, 4), "null-argument");
  EXPECT_EQ(pairs(0.1, near_pairs_, SIZE_MAX), "argument-invalid");
  EXPECT_EQ(parts(12, 0, 9, near_pairs_, 4), "argument-invalid");
  EXPECT_EQ(parts(0, UINT32_MAX, 9, near_pairs_, 4), "argument-invalid");
  EXPECT_STREQ(ist_last_error_message(),
               "ist_query_near_parts: fixed is 0 and moving is 4294967295, and the meshes have 12 "
               "and 12 triangles: pass indices below these numbers");
  EXPECT_EQ(parts(11, 11, 9, near_pairs_, 4), "ok");
  near_result_.struct_size = 8;
  EXPECT_EQ(
      name(ist_query_near_pairs(query_, pose_.data(), 0.1, nullptr, near_pairs_, 4, &near_result_)),
      "struct-size");
}

// Missing and invalid files; the message names the file.
TEST_F(CMisuse, OfFilesIsTold) {
  const std::string none = (folder_.path() / "none").string();
  EXPECT_EQ(name(ist_tree_load(none.c_str(), nullptr, &no_tree_)), "file-unreadable");
  EXPECT_NE(std::string(ist_last_error_message()).find(none), std::string::npos);
  EXPECT_EQ(name(ist_tree_load(scene_.c_str(), nullptr, &no_tree_)), "not-a-tree");
  EXPECT_EQ(name(ist_mesh_read(scene_.c_str(), nullptr, &no_mesh_)), "not-a-mesh");
  EXPECT_EQ(name(ist_tree_save(tree_, "/no/such/folder/body.ist", nullptr)), "file-unwritable");
  EXPECT_EQ(name(ist_servo_open_scene(none.c_str(), &servo_options_, &no_servo_)),
            "file-unreadable");
  const std::string bad = folder_.write("bad.toml", "unit = \"furlong\"\n").string();
  EXPECT_EQ(name(ist_servo_open_scene(bad.c_str(), &servo_options_, &no_servo_)), "input-invalid");
  EXPECT_TRUE(!no_mesh_ && !no_tree_ && !no_servo_);
}

}  // namespace
}  // namespace ist::test
