/* The calls of calls.py made in C: prints the median time of each, ns, and poses a second in rows.
 *
 *     calls FIXED.ist MOVING.ist CALLS POSES */

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "ist/capi/ist_measure.h"

static void need(ist_status status) {
  if (status != IST_OK) {
    fprintf(stderr, "%s\n", ist_last_error_message());
    exit(1);
  }
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static int ascending(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static ist_query* query;
static double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.1, 0.2, -1.5, 1};
static ist_leaf_pair pairs[4096];
static ist_contact contacts[32];

static void intersects(void) {
  int32_t answer;
  need(ist_query_intersects(query, pose, NULL, &answer));
}
static void leaf_pairs(void) {
  ist_query_result result = {.struct_size = sizeof result};
  need(ist_query_leaf_pairs(query, pose, NULL, pairs, 4096, &result));
}
static void contacts_of(void) {
  ist_query_result result = {.struct_size = sizeof result};
  ist_contact_sums sums = {.struct_size = sizeof sums};
  need(ist_query_contacts(query, pose, NULL, contacts, 32, &sums, &result));
}

static void time_of(const char* name, void (*call)(void), int calls, double height) {
  pose[14] = height;
  double* times = malloc((size_t)calls * sizeof *times);
  for (int i = -calls / 10; i < calls; ++i) {
    pose[12] = 0.1 + 1e-9 * i;
    const double begin = now();
    call();
    if (i >= 0) times[i] = now() - begin;
  }
  qsort(times, (size_t)calls, sizeof *times, ascending);
  printf("%s_at_%.1f %.1f\n", name, height, times[calls / 2]);
  free(times);
}

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  ist_tree *fixed, *moving;
  need(ist_tree_load(argv[1], &fixed));
  need(ist_tree_load(argv[2], &moving));
  need(ist_query_create(fixed, moving, NULL, &query));
  const int calls = atoi(argv[3]), count = atoi(argv[4]);
  const double heights[] = {-500, -1.5};
  for (int i = 0; i < 2; ++i) {
    time_of("intersects", intersects, calls, heights[i]);
    time_of("leaf_pairs", leaf_pairs, calls, heights[i]);
    time_of("contacts", contacts_of, calls, heights[i]);
  }
  double* poses = malloc((size_t)count * 16 * sizeof *poses);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 16; ++k) poses[16 * i + k] = pose[k];
    poses[16 * i + 14] = -2.5 * i / count;
  }
  ist_row* rows = malloc((size_t)count * sizeof *rows);
  const ist_rows_options options = {.struct_size = sizeof options,
                                    .questions = IST_ASK_INTERSECTS | IST_ASK_DISTANCE,
                                    .threads = 2,
                                    .tolerance = 0.01};
  const double begin = now();
  need(ist_query_rows(query, poses, (size_t)count, &options, rows));
  printf("rows %.1f\n", 1e9 * count / (now() - begin));
  return 0;
}
