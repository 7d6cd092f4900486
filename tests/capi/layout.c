/* Sizes, offsets and numbers of the C interface in compiled programs. They must never change. */

#include "ist/capi/ist_measure.h"
#include "ist/capi/ist_servo.h"
#include "ist/capi/ist_sweep.h"
#include "ist/capi/ist_world.h"

#define SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), #type " has another size")
#define AT(type, member, place) \
  _Static_assert(offsetof(type, member) == (place), #type "." #member " is elsewhere")
#define IS(name, number) _Static_assert((name) == (number), #name " has another number")

SIZE(ist_status, 4);
SIZE(ist_mesh*, 8);

SIZE(ist_mesh_info, 128);
AT(ist_mesh_info, struct_size, 0);
AT(ist_mesh_info, vertices, 8);
AT(ist_mesh_info, triangles, 16);
AT(ist_mesh_info, boundary_edges, 24);
AT(ist_mesh_info, non_manifold_edges, 32);
AT(ist_mesh_info, degenerate_triangles, 40);
AT(ist_mesh_info, components, 48);
AT(ist_mesh_info, closed, 56);
AT(ist_mesh_info, consistent, 60);
AT(ist_mesh_info, box_min, 64);
AT(ist_mesh_info, box_max, 88);
AT(ist_mesh_info, signed_volume, 112);
AT(ist_mesh_info, self_intersections, 120);

SIZE(ist_build_options, 56);
AT(ist_build_options, struct_size, 0);
AT(ist_build_options, voxel_size, 8);
AT(ist_build_options, spheres, 16);
AT(ist_build_options, drop_triangles, 20);
AT(ist_build_options, proximity, 24);
AT(ist_build_options, no_weld, 28);
AT(ist_build_options, max_memory, 32);
AT(ist_build_options, progress, 40);
AT(ist_build_options, frame, 48);
AT(ist_build_options, reserved, 52);

SIZE(ist_tree_info, 112);
AT(ist_tree_info, struct_size, 0);
AT(ist_tree_info, voxel_size, 8);
AT(ist_tree_info, leaves, 16);
AT(ist_tree_info, triangles, 24);
AT(ist_tree_info, bytes, 32);
AT(ist_tree_info, depth, 40);
AT(ist_tree_info, spheres, 44);
AT(ist_tree_info, has_triangles, 48);
AT(ist_tree_info, has_proximity, 52);
AT(ist_tree_info, outward, 56);
AT(ist_tree_info, unit, 60);
AT(ist_tree_info, origin, 64);
AT(ist_tree_info, bounding_radius, 88);
AT(ist_tree_info, largest_leaf_radius, 96);
AT(ist_tree_info, frame, 104);
AT(ist_tree_info, reserved, 108);

SIZE(ist_query_options, 72);
AT(ist_query_options, struct_size, 0);
AT(ist_query_options, spheres, 8);
AT(ist_query_options, workers, 12);
AT(ist_query_options, period_ns, 16);
AT(ist_query_options, frontier_pairs, 24);
AT(ist_query_options, reserved, 32);
AT(ist_query_options, contacts, 40);
AT(ist_query_options, target, 48);
AT(ist_query_options, margin, 56);
AT(ist_query_options, front_pairs, 64);

SIZE(ist_query_info, 56);
AT(ist_query_info, struct_size, 0);
AT(ist_query_info, bytes, 8);
AT(ist_query_info, contacts, 16);
AT(ist_query_info, spheres, 24);
AT(ist_query_info, workers, 28);
AT(ist_query_info, has_triangles, 32);
AT(ist_query_info, reserved, 36);
AT(ist_query_info, target, 40);

SIZE(ist_leaf_pair, 8);
AT(ist_leaf_pair, fixed, 0);
AT(ist_leaf_pair, moving, 4);

SIZE(ist_query_result, 96);
AT(ist_query_result, struct_size, 0);
AT(ist_query_result, leaf_pairs, 8);
AT(ist_query_result, contacts, 16);
AT(ist_query_result, written, 24);
AT(ist_query_result, sphere_tests, 32);
AT(ist_query_result, complete, 40);
AT(ist_query_result, truncated, 44);
AT(ist_query_result, level, 48);
AT(ist_query_result, distance_known, 52);
AT(ist_query_result, distance_lower, 56);
AT(ist_query_result, distance_upper, 64);
AT(ist_query_result, resolution, 72);
AT(ist_query_result, found, 80);
AT(ist_query_result, reserved, 84);
AT(ist_query_result, rotation_error, 88);

SIZE(ist_budget, 24);
AT(ist_budget, struct_size, 0);
AT(ist_budget, tests, 8);
AT(ist_budget, nanoseconds, 16);

SIZE(ist_contact, 64);
AT(ist_contact, position, 0);
AT(ist_contact, normal, 24);
AT(ist_contact, depth, 48);
AT(ist_contact, weight, 56);

SIZE(ist_contact_sums, 144);
AT(ist_contact_sums, struct_size, 0);
AT(ist_contact_sums, pairs, 8);
AT(ist_contact_sums, weight, 16);
AT(ist_contact_sums, pressure_force, 24);
AT(ist_contact_sums, pressure_torque, 48);
AT(ist_contact_sums, spring_force, 72);
AT(ist_contact_sums, spring_torque, 96);
AT(ist_contact_sums, about, 120);

SIZE(ist_distance_result, 56);
AT(ist_distance_result, struct_size, 0);
AT(ist_distance_result, lower, 8);
AT(ist_distance_result, upper, 16);
AT(ist_distance_result, sphere_tests, 24);
AT(ist_distance_result, complete, 32);
AT(ist_distance_result, reserved, 36);
AT(ist_distance_result, narrowest, 40);
AT(ist_distance_result, rotation_error, 48);

SIZE(ist_triangle_pair, 8);
AT(ist_triangle_pair, fixed, 0);
AT(ist_triangle_pair, moving, 4);

SIZE(ist_triangle_pairs_result, 48);
AT(ist_triangle_pairs_result, struct_size, 0);
AT(ist_triangle_pairs_result, pairs, 8);
AT(ist_triangle_pairs_result, written, 16);
AT(ist_triangle_pairs_result, sphere_tests, 24);
AT(ist_triangle_pairs_result, truncated, 32);
AT(ist_triangle_pairs_result, complete, 36);
AT(ist_triangle_pairs_result, rotation_error, 40);

SIZE(ist_servo_options, 48);
AT(ist_servo_options, struct_size, 0);
AT(ist_servo_options, unit, 8);
AT(ist_servo_options, reserved, 12);
AT(ist_servo_options, query_time_fraction, 16);
AT(ist_servo_options, sphere_tests, 24);
AT(ist_servo_options, max_memory, 32);
AT(ist_servo_options, progress, 40);

SIZE(ist_servo_info, 184);
AT(ist_servo_info, struct_size, 0);
AT(ist_servo_info, tick_seconds, 8);
AT(ist_servo_info, tool, 16);
AT(ist_servo_info, ticks, 144);
AT(ist_servo_info, held, 152);
AT(ist_servo_info, faults, 160);
AT(ist_servo_info, late, 168);
AT(ist_servo_info, bodies, 176);

SIZE(ist_servo_body, 152);
AT(ist_servo_body, struct_size, 0);
AT(ist_servo_body, name, 8);
AT(ist_servo_body, held, 16);
AT(ist_servo_body, reserved, 20);
AT(ist_servo_body, pose, 24);

SIZE(ist_progress, 24);
AT(ist_progress, struct_size, 0);
AT(ist_progress, report, 8);
AT(ist_progress, user, 16);

SIZE(ist_surface_distance, 40);
AT(ist_surface_distance, distance, 0);
AT(ist_surface_distance, closest, 8);
AT(ist_surface_distance, triangle, 32);
AT(ist_surface_distance, is_signed, 36);
AT(ist_surface_distance, self_intersecting, 38);

SIZE(ist_penetration, 120);
AT(ist_penetration, lower, 8);
AT(ist_penetration, upper, 16);
AT(ist_penetration, point, 24);
AT(ist_penetration, direction, 48);
AT(ist_penetration, of_moving, 72);
AT(ist_penetration, triangle, 76);
AT(ist_penetration, complete, 80);
AT(ist_penetration, not_closed, 84);
AT(ist_penetration, narrowest, 88);
AT(ist_penetration, points, 96);
AT(ist_penetration, self_intersecting, 104);
AT(ist_penetration, capped, 108);
AT(ist_penetration, rotation_error, 112);

SIZE(ist_motion, 88);
AT(ist_motion, from, 8);
AT(ist_motion, to, 16);
AT(ist_motion, point, 24);
AT(ist_motion, direction, 48);
AT(ist_motion, angle, 72);
AT(ist_motion, along, 80);

SIZE(ist_first_contact, 88);
AT(ist_first_contact, lower, 8);
AT(ist_first_contact, upper, 16);
AT(ist_first_contact, distance_lower, 24);
AT(ist_first_contact, distance_upper, 32);
AT(ist_first_contact, outcome, 40);
AT(ist_first_contact, grazed, 44);
AT(ist_first_contact, triangles_known, 48);
AT(ist_first_contact, fixed, 52);
AT(ist_first_contact, moving, 56);
AT(ist_first_contact, self_intersecting, 60);
AT(ist_first_contact, narrowest, 64);
AT(ist_first_contact, distances, 72);
AT(ist_first_contact, rotation_error, 80);

SIZE(ist_occlusion_options, 72);
AT(ist_occlusion_options, reach, 8);
AT(ist_occlusion_options, contact, 16);
AT(ist_occlusion_options, least_area, 24);
AT(ist_occlusion_options, longest_edge, 32);
AT(ist_occlusion_options, foundation, 40);
AT(ist_occlusion_options, change, 48);
AT(ist_occlusion_options, limits, 56);
AT(ist_occlusion_options, limit_count, 64);

SIZE(ist_contact_region, 112);
AT(ist_contact_region, area, 0);
AT(ist_contact_region, centre, 8);
AT(ist_contact_region, least_distance, 32);
AT(ist_contact_region, closest, 40);
AT(ist_contact_region, penetrating_area, 64);
AT(ist_contact_region, depth_integral, 72);
AT(ist_contact_region, share, 80);
AT(ist_contact_region, share_thinner, 88);
AT(ist_contact_region, share_thicker, 96);
AT(ist_contact_region, triangle, 104);
AT(ist_contact_region, partner, 108);

SIZE(ist_occlusion_arrays, 48);
AT(ist_occlusion_arrays, distances, 8);
AT(ist_occlusion_arrays, distance_capacity, 16);
AT(ist_occlusion_arrays, regions, 24);
AT(ist_occlusion_arrays, region_capacity, 32);
AT(ist_occlusion_arrays, areas, 40);

SIZE(ist_occlusion, 64);
AT(ist_occlusion, vertices, 8);
AT(ist_occlusion, regions, 16);
AT(ist_occlusion, total_area, 24);
AT(ist_occlusion, penetrating_area, 32);
AT(ist_occlusion, depth_integral, 40);
AT(ist_occlusion, depth_at_vertices, 48);
AT(ist_occlusion, rotation_error, 56);

SIZE(ist_rows_options, 48);
AT(ist_rows_options, questions, 8);
AT(ist_rows_options, threads, 12);
AT(ist_rows_options, tolerance, 16);
AT(ist_rows_options, stiffness, 24);
AT(ist_rows_options, tests, 32);
AT(ist_rows_options, progress, 40);

SIZE(ist_row, 136);
AT(ist_row, status, 0);
AT(ist_row, intersects, 4);
AT(ist_row, complete, 8);
AT(ist_row, not_closed, 12);
AT(ist_row, leaf_pairs, 16);
AT(ist_row, sphere_tests, 24);
AT(ist_row, distance_lower, 32);
AT(ist_row, distance_upper, 40);
AT(ist_row, depth_lower, 48);
AT(ist_row, depth_upper, 56);
AT(ist_row, area, 64);
AT(ist_row, force, 72);
AT(ist_row, torque, 96);
AT(ist_row, rotation_error, 120);
AT(ist_row, self_intersecting, 128);
AT(ist_row, capped, 132);

SIZE(ist_world_options, 40);
AT(ist_world_options, struct_size, 0);
AT(ist_world_options, query, 8);
AT(ist_world_options, reach, 16);
AT(ist_world_options, most_near, 24);
AT(ist_world_options, max_memory, 32);

SIZE(ist_body_pair, 8);
AT(ist_body_pair, a, 0);
AT(ist_body_pair, b, 4);

SIZE(ist_world_info, 24);
AT(ist_world_info, struct_size, 0);
AT(ist_world_info, bytes, 8);
AT(ist_world_info, bodies, 16);

SIZE(ist_world_pair, 104);
AT(ist_world_pair, a, 0);
AT(ist_world_pair, b, 4);
AT(ist_world_pair, status, 8);
AT(ist_world_pair, answer, 12);
AT(ist_world_pair, complete, 16);
AT(ist_world_pair, truncated, 20);
AT(ist_world_pair, distance_lower, 24);
AT(ist_world_pair, distance_upper, 32);
AT(ist_world_pair, found, 40);
AT(ist_world_pair, first, 48);
AT(ist_world_pair, written, 56);
AT(ist_world_pair, contacts, 64);
AT(ist_world_pair, resolution, 72);
AT(ist_world_pair, narrowest, 80);
AT(ist_world_pair, sphere_tests, 88);
AT(ist_world_pair, rotation_error, 96);

SIZE(ist_world_result, 40);
AT(ist_world_result, struct_size, 0);
AT(ist_world_result, near_pairs, 8);
AT(ist_world_result, written, 16);
AT(ist_world_result, sphere_tests, 24);
AT(ist_world_result, complete, 32);
AT(ist_world_result, truncated, 36);

SIZE(ist_world_question, 56);
AT(ist_world_question, struct_size, 0);
AT(ist_world_question, ask, 8);
AT(ist_world_question, reserved, 12);
AT(ist_world_question, tolerance, 16);
AT(ist_world_question, leaf_pairs, 24);
AT(ist_world_question, leaf_capacity, 32);
AT(ist_world_question, triangles, 40);
AT(ist_world_question, triangle_capacity, 48);

SIZE(ist_least_distance, 56);
AT(ist_least_distance, struct_size, 0);
AT(ist_least_distance, lower, 8);
AT(ist_least_distance, upper, 16);
AT(ist_least_distance, sphere_tests, 24);
AT(ist_least_distance, complete, 32);
AT(ist_least_distance, pose_missing, 36);
AT(ist_least_distance, nearest_known, 40);
AT(ist_least_distance, a, 44);
AT(ist_least_distance, b, 48);
AT(ist_least_distance, reserved, 52);

IS(IST_ASK_NEAR, 0);
IS(IST_ASK_INTERSECTS, 1);
IS(IST_ASK_LEAF_PAIRS, 2);
IS(IST_ASK_DISTANCE, 4);
IS(IST_ASK_CONTACTS, 8);
IS(IST_ASK_PENETRATION, 16);
IS(IST_ASK_TRIANGLE_PAIRS, 32);
IS(IST_JAW_LOWER, 0);
IS(IST_JAW_UPPER, 1);

IS(IST_ABI_VERSION, 1);
IS(IST_OK, 0);
IS(IST_NULL_ARGUMENT, 1);
IS(IST_STRUCT_SIZE, 2);
IS(IST_ARGUMENT_INVALID, 3);
IS(IST_NOT_A_HANDLE, 4);
IS(IST_HANDLE_KIND, 5);
IS(IST_HANDLE_FREED, 6);
IS(IST_HANDLE_BUSY, 7);
IS(IST_TOO_MANY_HANDLES, 8);
IS(IST_OUT_OF_MEMORY, 9);
IS(IST_SYSTEM_ERROR, 10);
IS(IST_INTERNAL_ERROR, 11);
IS(IST_NOT_PREPARED, 12);
IS(IST_SERVO_FAULT, 13);
IS(IST_CANCELLED, 14);
IS(IST_CHANGE_REFUSED, 15);
IS(IST_FILE_UNREADABLE, 101);
IS(IST_FILE_UNWRITABLE, 102);
IS(IST_NOT_A_MESH, 103);
IS(IST_MESH_EMPTY, 104);
IS(IST_MESH_POINTS_ONLY, 105);
IS(IST_MESH_TRUNCATED, 106);
IS(IST_MESH_BAD_INDEX, 107);
IS(IST_MESH_NOT_FINITE, 108);
IS(IST_MESH_EXTENT, 109);
IS(IST_VOXEL_SIZE_INVALID, 110);
IS(IST_VOXEL_SIZE_TOO_SMALL, 111);
IS(IST_MEMORY_LIMIT, 112);
IS(IST_NOT_A_TREE, 113);
IS(IST_TREE_VERSION, 114);
IS(IST_TREE_TRUNCATED, 115);
IS(IST_TREE_CORRUPT, 116);
IS(IST_POLICY_MISSING, 117);
IS(IST_TRIANGLES_MISSING, 118);
IS(IST_TARGET_MISSING, 119);
IS(IST_POSE_INVALID, 120);
IS(IST_INPUT_INVALID, 121);
IS(IST_FIXED_POINT_RANGE, 122);
IS(IST_MESH_TOO_LARGE, 123);
IS(IST_PART_BUSY, 124);
IS(IST_SPHERES_DEFAULT, 0);
IS(IST_SPHERES_SIMPLE, 1);
IS(IST_SPHERES_TABLE, 2);
IS(IST_SPHERES_TIGHT, 3);
IS(IST_SPHERES_SLAB, 4);
IS(IST_ANSWER_UNKNOWN, 0);
IS(IST_ANSWER_NO, 1);
IS(IST_ANSWER_NEAR, 2);
IS(IST_ANSWER_YES, 3);
IS(IST_FRAME_UNKNOWN, 0);
IS(IST_FRAME_RAS, 1);
IS(IST_FRAME_LPS, 2);
IS(IST_UNIT_M, 1);
IS(IST_UNIT_MM, 2);
IS(IST_MOST_BODIES, 4096);
IS(IST_CLOSED, 0);
IS(IST_FIXED_NOT_CLOSED, 1);
IS(IST_MOVING_NOT_CLOSED, 2);
IS(IST_FIRST_UNKNOWN, 0);
IS(IST_FIRST_CONTACT, 1);
IS(IST_FIRST_NONE, 2);
IS(IST_FIRST_GRAZING, 3);
IS(IST_FIRST_TOUCHES_AT_START, 4);
IS(IST_FIRST_INSIDE_AT_START, 5);
IS(IST_FIRST_STOPPED, 6);

SIZE(ist_sweep_info, 88);
AT(ist_sweep_info, struct_size, 0);
AT(ist_sweep_info, rows, 8);
AT(ist_sweep_info, rows_per_part, 16);
AT(ist_sweep_info, parts, 24);
AT(ist_sweep_info, row_bytes, 32);
AT(ist_sweep_info, columns, 40);
AT(ist_sweep_info, hash, 48);

SIZE(ist_sweep_column, 48);
AT(ist_sweep_column, struct_size, 0);
AT(ist_sweep_column, name, 8);
AT(ist_sweep_column, type, 32);
AT(ist_sweep_column, reserved, 36);
AT(ist_sweep_column, offset, 40);

SIZE(ist_sweep_part, 40);
AT(ist_sweep_part, struct_size, 0);
AT(ist_sweep_part, state, 8);
AT(ist_sweep_part, starts, 12);
AT(ist_sweep_part, rows, 16);
AT(ist_sweep_part, seconds, 24);
AT(ist_sweep_part, made, 32);
AT(ist_sweep_part, reserved, 36);

SIZE(ist_sweep_merge_result, 40);
AT(ist_sweep_merge_result, struct_size, 0);
AT(ist_sweep_merge_result, rows, 8);
AT(ist_sweep_merge_result, missing, 16);
AT(ist_sweep_merge_result, given_up, 24);
AT(ist_sweep_merge_result, reserved, 32);

IS(IST_COLUMN_UINT64, 1);
IS(IST_COLUMN_INT32, 2);
IS(IST_COLUMN_FLOAT64, 3);
IS(IST_PART_MISSING, 1);
IS(IST_PART_DONE, 2);
IS(IST_PART_GIVEN_UP, 3);
IS(IST_PART_DAMAGED, 4);
