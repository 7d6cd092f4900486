/* Single calls made in C, which calls.py makes in Python in turns with them: each function makes
 * one and returns the time that it took, ns. */

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

static ist_leaf_pair pairs[4096];
static ist_contact contacts[32];

double time_of_nothing(ist_query* query, const double pose[16]) {
  (void)query, (void)pose;
  const double begin = now();
  return now() - begin;
}

double time_of_intersects(ist_query* query, const double pose[16]) {
  int32_t answer;
  const double begin = now();
  need(ist_query_intersects(query, pose, NULL, &answer));
  return now() - begin;
}

double time_of_leaf_pairs(ist_query* query, const double pose[16]) {
  ist_query_result result = {.struct_size = sizeof result};
  const double begin = now();
  need(ist_query_leaf_pairs(query, pose, NULL, pairs, 4096, &result));
  return now() - begin;
}

double time_of_contacts(ist_query* query, const double pose[16]) {
  ist_query_result result = {.struct_size = sizeof result};
  ist_contact_sums sums = {.struct_size = sizeof sums};
  const double begin = now();
  need(ist_query_contacts(query, pose, NULL, contacts, 32, &sums, &result));
  return now() - begin;
}

double time_of_rows(ist_query* query, const double* poses, size_t count) {
  ist_row* rows = malloc(count * sizeof *rows);
  const ist_rows_options options = {.struct_size = sizeof options,
                                    .questions = IST_ASK_INTERSECTS | IST_ASK_DISTANCE,
                                    .threads = 2,
                                    .tolerance = 0.01};
  const double begin = now();
  need(ist_query_rows(query, poses, count, &options, rows));
  const double took = now() - begin;
  free(rows);
  return took;
}
