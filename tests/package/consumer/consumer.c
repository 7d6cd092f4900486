/* The same for C11: counts the leaf pairs of two boxes by hand. */
#include <ist/capi/ist_c.h>
#include <stdio.h>
#include <stdlib.h>

enum { CELLS = 6 };

static void require(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "consumer: %s: %s\n", what, ist_last_error_message());
  exit(1);
}

static int on_surface(const int cell[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] == 0 || cell[axis] == CELLS - 1) return 1;
  }
  return 0;
}

/* Pairs of surface voxels whose centres are no farther apart than the square root of 3. */
static uint64_t overlapping(int shift) {
  enum { COUNT = CELLS * CELLS * CELLS };
  uint64_t count = 0;
  for (int i = 0; i < COUNT * COUNT; ++i) {
    const int m = i / COUNT, n = i % COUNT;
    const int a[3] = {m % CELLS, m / CELLS % CELLS, m / (CELLS * CELLS)};
    const int b[3] = {n % CELLS, n / CELLS % CELLS, n / (CELLS * CELLS)};
    const int x = a[0] - b[0] - shift, y = a[1] - b[1], z = a[2] - b[2];
    if (on_surface(a) && on_surface(b) && x * x + y * y + z * z <= 3) ++count;
  }
  return count;
}

int main(void) {
  static const uint32_t triangles[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  double vertices[24];
  for (int i = 0; i < 24; ++i) vertices[i] = (i / 3 >> i % 3 & 1) * CELLS;

  ist_mesh* mesh;
  ist_tree* tree;
  ist_query* query;
  const ist_build_options build = {.struct_size = sizeof build, .voxel_size = 1};
  const ist_query_options ask = {.struct_size = sizeof ask, .spheres = IST_SPHERES_SIMPLE};
  require(ist_abi_version() == IST_ABI_VERSION, "another library than the header's");
  require(ist_mesh_create(vertices, 8, triangles, 12, &mesh) == IST_OK, "no mesh");
  require(ist_tree_build(mesh, &build, &tree) == IST_OK, "no tree");
  require(ist_query_create(tree, tree, &ask, &query) == IST_OK, "no query");
  for (int shift = 0; shift <= CELLS + 2; ++shift) {
    const double pose[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, shift, 0, 0, 1};
    ist_query_result result = {.struct_size = sizeof result};
    require(ist_query_leaf_pairs(query, pose, NULL, NULL, 0, &result) == IST_OK, "no answer");
    require(result.leaf_pairs == overlapping(shift), "another count of leaf pairs");
    printf("shift %d: %llu leaf pairs\n", shift, (unsigned long long)result.leaf_pairs);
  }
  require(ist_tree_load("no/such/file.ist", NULL, &tree) == IST_FILE_UNREADABLE, "another error");
  printf("error: %s\n", ist_last_error_message());
  return 0;
}
