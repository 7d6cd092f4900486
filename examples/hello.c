/* Do two jaws touch, and how far apart are they? hello.cpp and hello.py print the same lines. */
#include <ist/capi/ist_models.h>
#include <stdio.h>

/* Prints the error of a call that failed. Returns 1 if the call succeeded. */
static int succeeds(ist_status status) {
  if (status != IST_OK) fprintf(stderr, "%s\n", ist_last_error_message());
  return status == IST_OK;
}

/* Makes a built-in jaw ready for queries. Returns NULL after an error. */
static ist_tree* jaw_tree(int32_t jaw) {
  /* A member that is zero means its default. Lengths are in the unit of the mesh, here mm. */
  const ist_build_options options = {.struct_size = sizeof options};
  ist_mesh* mesh = NULL;
  ist_tree* tree = NULL;
  /* ist_mesh_read("scan.stl", NULL, &mesh) reads a mesh of your own. */
  if (succeeds(ist_jaw_create(jaw, 1, &mesh))) succeeds(ist_tree_build(mesh, &options, &tree));
  ist_mesh_free(mesh); /* The tree keeps all that it needs. */
  return tree;
}

int main(void) {
  ist_tree* upper = jaw_tree(IST_JAW_UPPER);
  ist_tree* lower = jaw_tree(IST_JAW_LOWER);
  /* A query belongs to one thread. Several queries may share a tree. */
  ist_query* query = NULL;
  int fine = upper && lower && succeeds(ist_query_create(upper, lower, NULL, &query));

  const double downs[2] = {1.0, 1.5};
  for (int i = 0; fine && i < 2; ++i) {
    /* The pose maps points of the lower jaw to the coordinates of the upper jaw. Its 16 numbers
     * stand column by column. */
    const double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -downs[i], 1};

    /* Touch is exact. The distance lies between two ends, which are at most 0.001 mm apart. */
    int32_t touch = IST_ANSWER_UNKNOWN;
    ist_distance_result gap = {.struct_size = sizeof gap};
    fine = succeeds(ist_query_intersects(query, pose, NULL, &touch)) &&
           succeeds(ist_query_distance(query, pose, 0.001, NULL, &gap));
    if (fine) {
      printf("lower jaw down by %.1f mm: touch %s, %.3f to %.3f mm apart\n", downs[i],
             touch == IST_ANSWER_YES  ? "yes"
             : touch == IST_ANSWER_NO ? "no"
                                      : "unknown",
             gap.lower, gap.upper);
    }
  }

  ist_query_free(query);
  ist_tree_free(upper);
  ist_tree_free(lower);
  return fine ? 0 : 1;
}
