// NULL pointers and invalid handles, for every function that takes one.

#include <functional>
#include <vector>

#include "capi/misuse_case.h"

namespace ist::test {
namespace {

TEST_F(CMisuse, OfANullPointerIsToldByItsName) {
  struct Case {
    const char* argument;
    ist_status status;
    std::string message;
  };
  std::vector<Case> cases;
  const auto is_null = [&](const char* argument, ist_status status) {
    cases.push_back({argument, status, ist_last_error_message()});
  };
  const double* corners = corners_.data();
  const std::uint32_t* indices = indices_.data();
  const double* pose = pose_.data();
  is_null("vertices", ist_mesh_create(nullptr, 3, indices, 1, &no_mesh_));
  is_null("triangles", ist_mesh_create(corners, 3, nullptr, 1, &no_mesh_));
  is_null("mesh", ist_mesh_create(corners, 3, indices, 1, nullptr));
  is_null("vertices", ist_mesh_create_float(nullptr, 3, indices, 1, &no_mesh_));
  is_null("triangles", ist_mesh_create_float(floats_.data(), 3, nullptr, 1, &no_mesh_));
  is_null("mesh", ist_mesh_create_float(floats_.data(), 3, indices, 1, nullptr));
  is_null("path", ist_mesh_read(nullptr, nullptr, &no_mesh_));
  is_null("mesh", ist_mesh_read(file_.c_str(), nullptr, nullptr));
  is_null("mesh", ist_mesh_get_info(nullptr, nullptr, &mesh_info_));
  is_null("info", ist_mesh_get_info(mesh_, nullptr, nullptr));
  is_null("mesh", ist_mesh_get_size(nullptr, &count_, &count_));
  is_null("vertices", ist_mesh_get_size(mesh_, nullptr, &count_));
  is_null("triangles", ist_mesh_get_size(mesh_, &count_, nullptr));
  is_null("mesh", ist_mesh_copy(nullptr, nullptr, 0, nullptr, 0));
  is_null("vertices", ist_mesh_copy(mesh_, nullptr, 1, nullptr, 0));
  is_null("triangles", ist_mesh_copy(mesh_, nullptr, 0, nullptr, 1));

  is_null("mesh", ist_tree_build(nullptr, &build_, &no_tree_));
  is_null("options", ist_tree_build(mesh_, nullptr, &no_tree_));
  is_null("tree", ist_tree_build(mesh_, &build_, nullptr));
  is_null("path", ist_tree_load(nullptr, nullptr, &no_tree_));
  is_null("tree", ist_tree_load(file_.c_str(), nullptr, nullptr));
  is_null("tree", ist_tree_save(nullptr, file_.c_str(), nullptr));
  is_null("path", ist_tree_save(tree_, nullptr, nullptr));
  is_null("tree", ist_tree_get_info(nullptr, &tree_info_));
  is_null("info", ist_tree_get_info(tree_, nullptr));
  std::uint64_t bytes = 0;
  is_null("tree", ist_tree_to_memory(nullptr, nullptr, 0, nullptr, &bytes));
  is_null("memory", ist_tree_to_memory(tree_, nullptr, 1, nullptr, &bytes));
  is_null("bytes", ist_tree_to_memory(tree_, nullptr, 0, nullptr, nullptr));
  is_null("memory", ist_tree_from_memory(nullptr, 1, nullptr, &no_tree_));
  is_null("tree", ist_tree_from_memory(corners, 1, nullptr, nullptr));
  is_null("tree", ist_tree_get_mesh(nullptr, &no_mesh_));
  is_null("mesh", ist_tree_get_mesh(tree_, nullptr));
  is_null("mesh", ist_jaw_create(IST_JAW_LOWER, 1, nullptr));
  is_null("tree", ist_tree_copy_leaf_centres(nullptr, nullptr, 0));
  is_null("centres", ist_tree_copy_leaf_centres(tree_, nullptr, 1));

  is_null("fixed", ist_query_create(nullptr, tree_, nullptr, &no_query_));
  is_null("moving", ist_query_create(tree_, nullptr, nullptr, &no_query_));
  is_null("query", ist_query_create(tree_, tree_, nullptr, nullptr));
  is_null("query", ist_query_get_info(nullptr, &query_info_));
  is_null("info", ist_query_get_info(query_, nullptr));
  is_null("query", ist_query_leaf_pairs(nullptr, pose, &budget_, leaf_pairs_, 4, &result_));
  is_null("pose", ist_query_leaf_pairs(query_, nullptr, &budget_, leaf_pairs_, 4, &result_));
  is_null("pairs", ist_query_leaf_pairs(query_, pose, &budget_, nullptr, 4, &result_));
  is_null("result", ist_query_leaf_pairs(query_, pose, &budget_, leaf_pairs_, 4, nullptr));
  const auto contacts = [&](ist_query* query, const double* at, ist_contact* out,
                            ist_query_result* result) {
    return ist_query_contacts(query, at, &budget_, out, 4, &sums_, result);
  };
  is_null("query", contacts(nullptr, pose, contacts_, &result_));
  is_null("pose", contacts(query_, nullptr, contacts_, &result_));
  is_null("contacts", contacts(query_, pose, nullptr, &result_));
  is_null("result", contacts(query_, pose, contacts_, nullptr));
  is_null("sums", ist_contact_sums_wrench(nullptr, 1, force_, torque_));
  is_null("force", ist_contact_sums_wrench(&sums_, 1, nullptr, torque_));
  is_null("torque", ist_contact_sums_wrench(&sums_, 1, force_, nullptr));
  is_null("query", ist_query_distance(nullptr, pose, 0, nullptr, &distance_));
  is_null("pose", ist_query_distance(query_, nullptr, 0, nullptr, &distance_));
  is_null("result", ist_query_distance(query_, pose, 0, nullptr, nullptr));
  is_null("query", ist_query_forget(nullptr));
  is_null("pose", ist_rotation_error(nullptr, force_));
  is_null("error", ist_rotation_error(pose, nullptr));
  is_null("query", ist_query_intersects(nullptr, pose, nullptr, &answer_));
  is_null("pose", ist_query_intersects(query_, nullptr, nullptr, &answer_));
  is_null("answer", ist_query_intersects(query_, pose, nullptr, nullptr));
  const auto triangles = [&](ist_query* query, const double* at, ist_triangle_pair* out,
                             ist_triangle_pairs_result* result) {
    return ist_query_triangle_pairs(query, at, nullptr, out, 4, result);
  };
  is_null("query", triangles(nullptr, pose, triangle_pairs_, &triangle_result_));
  is_null("pose", triangles(query_, nullptr, triangle_pairs_, &triangle_result_));
  is_null("pairs", triangles(query_, pose, nullptr, &triangle_result_));
  is_null("result", triangles(query_, pose, triangle_pairs_, nullptr));

  is_null("path", ist_servo_open_scene(nullptr, &servo_options_, &no_servo_));
  is_null("options", ist_servo_open_scene(scene_.c_str(), nullptr, &no_servo_));
  is_null("servo", ist_servo_open_scene(scene_.c_str(), &servo_options_, nullptr));
  is_null("servo", ist_servo_get_info(nullptr, &servo_info_));
  is_null("info", ist_servo_get_info(servo_, nullptr));
  is_null("servo", ist_servo_on_tick(nullptr, pose, force_, torque_));
  is_null("pose", ist_servo_on_tick(servo_, nullptr, force_, torque_));
  is_null("force", ist_servo_on_tick(servo_, pose, nullptr, torque_));
  is_null("torque", ist_servo_on_tick(servo_, pose, force_, nullptr));
  for (const Case& c : cases) {
    EXPECT_EQ(name(c.status), "null-argument") << c.message;
    EXPECT_NE(c.message.find(std::string(": ") + c.argument + " is NULL"), std::string::npos)
        << c.argument << " in: " << c.message;
  }
  EXPECT_EQ(ist_servo_warning(nullptr, 0), nullptr);
  EXPECT_TRUE(!no_mesh_ && !no_tree_ && !no_query_ && !no_servo_);
}

// Every handle argument, with invalid values, a handle of each other kind and a freed handle.
TEST_F(CMisuse, OfAHandleIsTold) {
  enum Kind { kMesh, kTree, kQuery, kServo };
  struct Taker {
    Kind kind;
    std::function<ist_status(void*)> call;
  };
  const double* pose = pose_.data();
  std::uint64_t memory_bytes = 0;
  const std::vector<Taker> takers{
      {kMesh,
       [&](void* h) { return ist_mesh_get_info(static_cast<ist_mesh*>(h), nullptr, &mesh_info_); }},
      {kMesh,
       [&](void* h) { return ist_mesh_get_size(static_cast<ist_mesh*>(h), &count_, &count_); }},
      {kMesh,
       [&](void* h) { return ist_tree_build(static_cast<ist_mesh*>(h), &build_, &no_tree_); }},
      {kMesh,
       [&](void* h) { return ist_mesh_copy(static_cast<ist_mesh*>(h), nullptr, 0, nullptr, 0); }},
      {kMesh, [&](void* h) { return ist_mesh_free(static_cast<ist_mesh*>(h)); }},
      {kTree, [&](void* h) { return ist_tree_get_info(static_cast<ist_tree*>(h), &tree_info_); }},
      {kTree,
       [&](void* h) { return ist_tree_save(static_cast<ist_tree*>(h), file_.c_str(), nullptr); }},
      {kTree,
       [&](void* h) {
         return ist_query_create(static_cast<ist_tree*>(h), tree_, nullptr, &no_query_);
       }},
      {kTree,
       [&](void* h) {
         return ist_query_create(tree_, static_cast<ist_tree*>(h), nullptr, &no_query_);
       }},
      {kTree,
       [&](void* h) { return ist_tree_copy_leaf_centres(static_cast<ist_tree*>(h), nullptr, 0); }},
      {kTree,
       [&](void* h) {
         return ist_tree_to_memory(static_cast<ist_tree*>(h), nullptr, 0, nullptr, &memory_bytes);
       }},
      {kTree, [&](void* h) { return ist_tree_get_mesh(static_cast<ist_tree*>(h), &no_mesh_); }},
      {kTree, [&](void* h) { return ist_tree_free(static_cast<ist_tree*>(h)); }},
      {kQuery,
       [&](void* h) { return ist_query_get_info(static_cast<ist_query*>(h), &query_info_); }},
      {kQuery,
       [&](void* h) {
         return ist_query_leaf_pairs(static_cast<ist_query*>(h), pose, &budget_, leaf_pairs_, 4,
                                     &result_);
       }},
      {kQuery,
       [&](void* h) {
         return ist_query_contacts(static_cast<ist_query*>(h), pose, &budget_, contacts_, 4, &sums_,
                                   &result_);
       }},
      {kQuery,
       [&](void* h) {
         return ist_query_distance(static_cast<ist_query*>(h), pose, 0, nullptr, &distance_);
       }},
      {kQuery,
       [&](void* h) {
         return ist_query_intersects(static_cast<ist_query*>(h), pose, nullptr, &answer_);
       }},
      {kQuery,
       [&](void* h) {
         return ist_query_triangle_pairs(static_cast<ist_query*>(h), pose, nullptr, triangle_pairs_,
                                         4, &triangle_result_);
       }},
      {kQuery, [&](void* h) { return ist_query_forget(static_cast<ist_query*>(h)); }},
      {kQuery, [&](void* h) { return ist_query_free(static_cast<ist_query*>(h)); }},
      {kServo,
       [&](void* h) { return ist_servo_get_info(static_cast<ist_servo*>(h), &servo_info_); }},
      {kServo,
       [&](void* h) {
         return ist_servo_on_tick(static_cast<ist_servo*>(h), pose, force_, torque_);
       }},
      {kServo, [&](void* h) { return ist_servo_free(static_cast<ist_servo*>(h)); }},
  };
  const std::array<void*, 4> sound = {mesh_, tree_, query_, servo_};
  ist_tree* tree = c_tree(box({0, 0, 0}, {2, 2, 2}), 0.5);
  ist_servo* servo = nullptr;
  ASSERT_EQ(name(ist_servo_open_scene(scene_.c_str(), &servo_options_, &servo)), "ok");
  const std::array<void*, 4> freed = {c_mesh(box({0, 0, 0}, {1, 1, 1})), tree, c_query(tree),
                                      servo};
  EXPECT_EQ(name(ist_mesh_free(static_cast<ist_mesh*>(freed[kMesh]))), "ok");
  EXPECT_EQ(name(ist_query_free(static_cast<ist_query*>(freed[kQuery]))), "ok");
  EXPECT_EQ(name(ist_servo_free(servo)), "ok");
  for (std::size_t i = 0; i < takers.size(); ++i) {
    const Taker& taker = takers[i];
    EXPECT_EQ(name(taker.call(freed[taker.kind])), "handle-freed") << i;
    EXPECT_EQ(name(taker.call(&pose_)), "not-a-handle") << i;
    EXPECT_EQ(name(taker.call(reinterpret_cast<void*>(std::uintptr_t{8}))), "not-a-handle") << i;
    for (const Kind kind : {kMesh, kTree, kQuery, kServo}) {
      if (kind == taker.kind) continue;
      EXPECT_EQ(name(taker.call(sound[kind])), "handle-kind") << i << ", " << kind;
      EXPECT_EQ(name(taker.call(freed[kind])), "handle-kind") << i << ", " << kind;
    }
  }
  EXPECT_EQ(ist_servo_warning(static_cast<ist_servo*>(freed[kServo]), 0), nullptr);
  EXPECT_FALSE(no_tree_ || no_query_);
}

}  // namespace
}  // namespace ist::test
