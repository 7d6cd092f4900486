/* The whole life of two bodies through the C interface, in plain C11, and errors of a caller.
 * Arrays have exactly their stated lengths, so that AddressSanitizer sees each access beyond.
 *
 *   ist_c11_test FOLDER SCENE.toml */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ist/capi/ist_measure.h"
#include "ist/capi/ist_servo.h"

#define CHECK(condition)                                                                           \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      fprintf(stderr, "%s:%d: %s does not hold; last error: %s\n", __FILE__, __LINE__, #condition, \
              ist_last_error_message());                                                           \
      exit(1);                                                                                     \
    }                                                                                              \
  } while (0)

#define IS(call, wanted)                                                                       \
  do {                                                                                         \
    const ist_status got = (call);                                                             \
    if (got != (wanted)) {                                                                     \
      fprintf(stderr, "%s:%d: %s gives %s and not %s; last error: %s\n", __FILE__, __LINE__,   \
              #call, ist_status_name(got), ist_status_name(wanted), ist_last_error_message()); \
      exit(1);                                                                                 \
    }                                                                                          \
  } while (0)

/* A cube of edge 10 whose corner is the origin. */
static const double kCorners[24] = {0, 0, 0,  10, 0, 0,  10, 10, 0,  0, 10, 0,
                                    0, 0, 10, 10, 0, 10, 10, 10, 10, 0, 10, 10};
static const uint32_t kTriangles[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                        1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};

typedef struct {
  double at[16];
} pose_at;

static pose_at shifted(double x, double y, double z) {
  const pose_at pose = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}};
  return pose;
}

static ist_mesh* make_mesh(void) {
  ist_mesh* mesh = NULL;
  IS(ist_mesh_create(kCorners, 8, kTriangles, 12, &mesh), IST_OK);
  ist_mesh_info info = {.struct_size = sizeof info};
  IS(ist_mesh_get_info(mesh, NULL, &info), IST_OK);
  CHECK(info.vertices == 8 && info.triangles == 12 && info.closed == 1 && info.consistent == 1);
  CHECK(info.signed_volume == 1000 && info.box_min[0] == 0 && info.box_max[2] == 10);
  return mesh;
}

/* Built, saved, and loaded again. */
static ist_tree* make_tree(const char* folder) {
  ist_mesh* mesh = make_mesh();
  const ist_build_options options = {.struct_size = sizeof options, .voxel_size = 1};
  ist_tree* built = NULL;
  IS(ist_tree_build(mesh, &options, &built), IST_OK);
  IS(ist_mesh_free(mesh), IST_OK);

  char path[4096];
  CHECK(snprintf(path, sizeof path, "%s/cube.ist", folder) < (int)sizeof path);
  IS(ist_tree_save(built, path, NULL), IST_OK);
  ist_tree* loaded = NULL;
  IS(ist_tree_load(path, NULL, &loaded), IST_OK);
  ist_tree_info was = {.struct_size = sizeof was}, is = {.struct_size = sizeof is};
  IS(ist_tree_get_info(built, &was), IST_OK);
  IS(ist_tree_get_info(loaded, &is), IST_OK);
  CHECK(memcmp(&was, &is, sizeof is) == 0);
  CHECK(is.voxel_size == 1 && is.leaves > 400 && is.triangles == 12 && is.outward == 1);
  CHECK(is.spheres == IST_SPHERES_SLAB && is.has_triangles == 1 && is.has_proximity == 0);
  IS(ist_tree_free(built), IST_OK);
  return loaded;
}

/* The cubes overlap by 0.5 along x. */
static void leaf_pairs(ist_query* query) {
  const pose_at pose = shifted(9.5, 0.25, 0);
  ist_query_result counted = {.struct_size = sizeof counted};
  IS(ist_query_leaf_pairs(query, pose.at, NULL, NULL, 0, &counted), IST_OK);
  CHECK(counted.leaf_pairs > 100 && counted.truncated == 1 && counted.written == 0);
  CHECK(counted.complete == 1 && counted.resolution > 0 && counted.distance_known == 0);

  ist_leaf_pair* all = malloc(counted.leaf_pairs * sizeof *all);
  ist_query_result full = {.struct_size = sizeof full};
  IS(ist_query_leaf_pairs(query, pose.at, NULL, all, counted.leaf_pairs, &full), IST_OK);
  CHECK(full.written == full.leaf_pairs && full.truncated == 0);
  for (uint64_t i = 1; i < full.written; ++i) {
    CHECK(all[i - 1].fixed < all[i].fixed ||
          (all[i - 1].fixed == all[i].fixed && all[i - 1].moving < all[i].moving));
  }
  ist_leaf_pair* few = malloc(7 * sizeof *few);
  ist_query_result cut = {.struct_size = sizeof cut};
  IS(ist_query_leaf_pairs(query, pose.at, NULL, few, 7, &cut), IST_OK);
  CHECK(cut.leaf_pairs == full.leaf_pairs && cut.written == 7 && cut.truncated == 1);
  CHECK(memcmp(few, all, 7 * sizeof *few) == 0);

  const ist_budget little = {.struct_size = sizeof little, .tests = 20};
  IS(ist_query_leaf_pairs(query, pose.at, &little, few, 7, &cut), IST_OK);
  CHECK(cut.complete == 0 && cut.level > 0 && cut.distance_known == 1 && cut.sphere_tests <= 20);
  const ist_budget hour = {.struct_size = sizeof hour, .nanoseconds = 3600000000000};
  IS(ist_query_leaf_pairs(query, pose.at, &hour, few, 7, &cut), IST_OK);
  CHECK(cut.complete == 1 && cut.leaf_pairs == full.leaf_pairs);
  const ist_budget unlimited = {.struct_size = sizeof unlimited};
  IS(ist_query_leaf_pairs(query, pose.at, &unlimited, few, 7, &cut), IST_OK);
  CHECK(cut.complete == 1 && cut.leaf_pairs == full.leaf_pairs && cut.distance_known == 1);
  free(few);
  free(all);
}

static void reduce(ist_query* query) {
  const pose_at pose = shifted(9.5, 0.25, 0);
  ist_contact* contacts = malloc(32 * sizeof *contacts);
  ist_contact_sums sums = {.struct_size = sizeof sums};
  ist_query_result result = {.struct_size = sizeof result};
  IS(ist_query_contacts(query, pose.at, NULL, contacts, 32, &sums, &result), IST_OK);
  CHECK(result.contacts > 0 && result.written == result.contacts && result.truncated == 0);
  CHECK(sums.pairs > 0 && sums.spring_force[0] > 0);
  CHECK(fabs(sums.spring_force[2]) < 0.01 * sums.spring_force[0]);
  for (uint64_t i = 0; i < result.written; ++i) {
    CHECK(fabs(contacts[i].position[0] - 9.75) < 1);
    CHECK(fabs(contacts[i].normal[0]) <= 1 && contacts[i].weight > 0);
  }
  double force[3], torque[3];
  IS(ist_contact_sums_wrench(&sums, 0.5, force, torque), IST_OK);
  for (int i = 0; i < 3; ++i) {
    CHECK(force[i] == 0.5 * sums.spring_force[i] && torque[i] == 0.5 * sums.spring_torque[i]);
  }
  ist_contact* one = malloc(sizeof *one);
  IS(ist_query_contacts(query, pose.at, NULL, one, 1, NULL, &result), IST_OK);
  CHECK(result.written == 1 && result.truncated == 1 && memcmp(one, contacts, sizeof *one) == 0);
  const ist_budget little = {.struct_size = sizeof little, .tests = 20};
  IS(ist_query_contacts(query, pose.at, &little, NULL, 0, &sums, &result), IST_OK);
  CHECK(result.complete == 0 && result.written == 0 && result.distance_known == 1);
  free(one);
  free(contacts);
}

static void certify(ist_query* query) {
  int32_t answer = -1;
  const pose_at in = shifted(9.5, 0.25, 0), out = shifted(12, 0, 0);
  IS(ist_query_intersects(query, in.at, NULL, &answer), IST_OK);
  CHECK(answer == IST_ANSWER_YES);
  double error = -1;
  IS(ist_rotation_error(in.at, &error), IST_OK);
  CHECK(error == 0);
  IS(ist_query_intersects(query, out.at, NULL, &answer), IST_OK);
  CHECK(answer == IST_ANSWER_NO);

  ist_distance_result distance = {.struct_size = sizeof distance};
  IS(ist_query_distance(query, out.at, 0.01, NULL, &distance), IST_OK);
  CHECK(distance.lower <= 2 && distance.upper >= 2 && distance.upper - distance.lower < 0.011);
  CHECK(distance.complete == 1 || distance.upper - distance.lower > 0.01);
  IS(ist_query_distance(query, out.at, 5, NULL, &distance), IST_OK);
  CHECK(distance.lower <= 2 && distance.upper >= 2 && distance.complete == 1);
  IS(ist_query_distance(query, in.at, 0, NULL, &distance), IST_OK);
  CHECK(distance.lower == 0 && distance.upper == 0 && distance.complete == 1);
  CHECK(distance.nearest_known == 1 && distance.direction[0] == 0);

  ist_near_pair* near = malloc(IST_MOST_NEAR_PARTS * sizeof *near);
  ist_near_pairs_result listed = {.struct_size = sizeof listed};
  IS(ist_query_near_pairs(query, out.at, 2.01, NULL, near, 1, &listed), IST_OK);
  CHECK(listed.pairs > 0 && listed.written == 1 && listed.complete == 1 && listed.pad < 0.01);
  CHECK(fabs(near->distance - 2) < 0.01 && fabs(near->direction[0] - 1) < 1e-6);
  const uint32_t fixed = near->fixed, moving = near->moving;
  IS(ist_query_near_parts(query, out.at, fixed, moving, 2.01, near, IST_MOST_NEAR_PARTS, &listed),
     IST_OK);
  CHECK(listed.written > 0 && listed.truncated == 0 && fabs(near->distance - 2) < 0.01);
  IS(ist_query_near_parts(query, out.at, UINT32_MAX, 0, 1, NULL, 0, &listed), IST_ARGUMENT_INVALID);
  free(near);

  ist_triangle_pair* pairs = malloc(200 * sizeof *pairs);
  ist_triangle_pairs_result result = {.struct_size = sizeof result};
  IS(ist_query_triangle_pairs(query, in.at, NULL, pairs, 200, &result), IST_OK);
  CHECK(result.pairs > 0 && result.written == result.pairs && result.truncated == 0);
  IS(ist_query_triangle_pairs(query, in.at, NULL, pairs, 1, &result), IST_OK);
  CHECK(result.written == 1 && result.truncated == 1);
  IS(ist_query_triangle_pairs(query, out.at, NULL, NULL, 0, &result), IST_OK);
  CHECK(result.pairs == 0 && result.truncated == 0);
  free(pairs);
}

static void compare(void) {
  const pose_at before = shifted(0, 0, 2), after = shifted(0, 0, 1.5);
  const double about[3] = {1, 2, 3};
  ist_pose_change change = {.struct_size = sizeof change};
  IS(ist_motion_between(before.at, after.at, about, &change), IST_OK);
  CHECK(change.translation[2] == -0.5 && change.along == 0.5 && change.turns == 0);
  const ist_placed_contact one = {.centre = {1, 0, 0}}, other = {.centre = {2, 0, 0}};
  int32_t match = 7;
  IS(ist_match_contacts(&one, 1, &other, 1, 1, &match), IST_OK);
  CHECK(match == 0);
  IS(ist_match_contacts(&one, 1, &other, 1, 0.5, &match), IST_OK);
  CHECK(match == -1);
}

static void misuse(ist_tree* tree, ist_query* query) {
  pose_at pose = shifted(9.5, 0, 0);
  ist_query_result result = {.struct_size = sizeof result};
  IS(ist_query_leaf_pairs(NULL, pose.at, NULL, NULL, 0, &result), IST_NULL_ARGUMENT);
  IS(ist_query_leaf_pairs(query, NULL, NULL, NULL, 0, &result), IST_NULL_ARGUMENT);
  IS(ist_query_leaf_pairs(query, pose.at, NULL, NULL, 1, &result), IST_NULL_ARGUMENT);
  IS(ist_query_leaf_pairs(query, pose.at, NULL, NULL, 0, NULL), IST_NULL_ARGUMENT);
  IS(ist_query_leaf_pairs((ist_query*)tree, pose.at, NULL, NULL, 0, &result), IST_HANDLE_KIND);
  IS(ist_query_leaf_pairs((ist_query*)&pose, pose.at, NULL, NULL, 0, &result), IST_NOT_A_HANDLE);
  result.struct_size = 0;
  IS(ist_query_leaf_pairs(query, pose.at, NULL, NULL, 0, &result), IST_STRUCT_SIZE);
  result.struct_size = sizeof result;

  pose.at[12] = NAN;
  result.leaf_pairs = 77;
  IS(ist_query_leaf_pairs(query, pose.at, NULL, NULL, 0, &result), IST_POSE_INVALID);
  CHECK(result.leaf_pairs == 0 && result.complete == 0);
  CHECK(strstr(ist_last_error_message(), "ist_query_leaf_pairs: pose") != NULL);

  ist_query* gone = NULL;
  IS(ist_query_create(tree, tree, NULL, &gone), IST_OK);
  IS(ist_query_free(gone), IST_OK);
  IS(ist_query_free(gone), IST_HANDLE_FREED);
  int32_t answer = -1;
  pose.at[12] = 9.5;
  IS(ist_query_intersects(gone, pose.at, NULL, &answer), IST_HANDLE_FREED);
  CHECK(answer == IST_ANSWER_UNKNOWN);
  IS(ist_query_free(NULL), IST_OK);
}

/* A ball is pressed on a box, in millimetres. */
static void press(const char* scene) {
  const ist_servo_options options = {
      .struct_size = sizeof options, .unit = IST_UNIT_MM, .sphere_tests = 1000000};
  ist_servo* servo = NULL;
  IS(ist_servo_open_scene(scene, &options, &servo), IST_OK);
  CHECK(ist_servo_warning(servo, 0) == NULL);
  ist_servo_info info = {.struct_size = sizeof info};
  IS(ist_servo_get_info(servo, &info), IST_OK);
  CHECK(fabs(info.tick_seconds - 1e-3) < 1e-9 && info.ticks == 0);
  CHECK(info.tool[0] == 1 && info.tool[15] == 1 && info.tool[14] > 0);

  double pose[16], force[3], torque[3], most = 0;
  memcpy(pose, info.tool, sizeof pose);
  for (int tick = 0; tick < 600; ++tick) {
    pose[14] -= 0.006; /* 3.6 mm in all, and it meets the box after 2 */
    IS(ist_servo_on_tick(servo, pose, force, torque), IST_OK);
    if (force[2] > most) most = force[2];
  }
  CHECK(most > 0.5 && most < 10);
  IS(ist_servo_get_info(servo, &info), IST_OK);
  CHECK(info.ticks == 600 && info.faults == 0 && info.held == 0);
  CHECK(info.tool[14] > pose[14] + 0.1); /* it stays outside */
  ist_servo_state state = {.struct_size = sizeof state};
  IS(ist_servo_get_state(servo, &state), IST_OK);
  CHECK(state.known == 1 && state.tick == 599 && state.fault == 0);
  CHECK(state.tool[14] == info.tool[14] && state.force[2] == force[2]);
  CHECK(state.contact_count <= IST_MOST_SERVO_CONTACTS);

  pose[0] = NAN;
  IS(ist_servo_on_tick(servo, pose, force, torque), IST_POSE_INVALID);
  CHECK(force[0] == 0 && force[1] == 0 && force[2] == 0 && torque[0] == 0);
  IS(ist_servo_free(servo), IST_OK);
  force[0] = force[1] = force[2] = torque[0] = torque[1] = torque[2] = 5;
  IS(ist_servo_on_tick(servo, pose, force, torque), IST_HANDLE_FREED);
  CHECK(force[2] == 0 && torque[2] == 0);
}

int main(int argc, char** argv) {
  CHECK(argc == 3);
  CHECK(ist_abi_version() == IST_ABI_VERSION && strlen(ist_version_string()) > 0);
  CHECK(strcmp(ist_last_error_message(), "") == 0);
  ist_tree* tree = make_tree(argv[1]);
  ist_query* query = NULL;
  IS(ist_query_create(tree, tree, NULL, &query), IST_OK);
  misuse(tree, query);
  IS(ist_tree_free(tree), IST_OK); /* the query keeps it */
  leaf_pairs(query);
  reduce(query);
  certify(query);
  compare();
  IS(ist_query_free(query), IST_OK);
  press(argv[2]);
  puts("the whole life: fine");
  return 0;
}
