#include <algorithm>
#include <limits>
#include <span>

#include "c/objects.h"
#include "ist/base/float_environment.h"
#include "ist/mesh/mesh.h"

namespace ist::capi {
namespace {

// A caller's arrays and their lengths.
template <typename Number>
struct MeshArrays {
  const Number* vertices;
  std::size_t vertex_count;
  const std::uint32_t* triangles;
  std::size_t triangle_count;
};

template <typename Number>
void check_counts(Call& call, const MeshArrays<Number>& arrays) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  for (const std::size_t count : {arrays.vertex_count, arrays.triangle_count}) {
    if (count > kMost) {
      return call.fail(IST_ARGUMENT_INVALID,
                       "{} vertices and {} triangles: pass at most {} of each", arrays.vertex_count,
                       arrays.triangle_count, kMost);
    }
  }
  call.need_array("vertices", arrays.vertices, arrays.vertex_count);
  call.need_array("triangles", arrays.triangles, arrays.triangle_count);
}

ist_mesh_info mesh_info_of(const Mesh& mesh) {
  const MeshReport report = check_mesh(mesh.mesh);
  ist_mesh_info info{};
  info.vertices = report.vertices;
  info.triangles = report.triangles;
  info.boundary_edges = report.boundary_edges;
  info.non_manifold_edges = report.non_manifold_edges;
  info.degenerate_triangles = report.degenerate_triangles;
  info.components = report.components;
  info.closed = report.closed;
  info.consistent = report.consistent;
  std::copy_n(report.box_min.data(), 3, info.box_min);
  std::copy_n(report.box_max.data(), 3, info.box_max);
  info.signed_volume = report.signed_volume;
  info.self_intersections = report.self_intersections;
  return info;
}

template <typename Number>
ist_status create(const char* function, const MeshArrays<Number>& arrays, ist_mesh** out) noexcept {
  return guarded(function, [&](Call& call) {
    call.clear("mesh", out);
    check_counts(call, arrays);
    if (call.status() != IST_OK) return;
    const ScopedFloatEnvironment environment;  // a denormal float is a normal double
    auto mesh = std::make_unique<Mesh>();
    mesh->mesh.vertices.resize(arrays.vertex_count);
    std::copy_n(arrays.vertices, 3 * arrays.vertex_count,
                reinterpret_cast<double*>(mesh->mesh.vertices.data()));
    mesh->mesh.triangles.resize(arrays.triangle_count);
    std::copy_n(arrays.triangles, 3 * arrays.triangle_count,
                reinterpret_cast<std::uint32_t*>(mesh->mesh.triangles.data()));
    ist::require_valid(mesh->mesh);
    give(call, std::move(mesh), out);
  });
}

}  // namespace
}  // namespace ist::capi

using namespace ist::capi;

ist_status ist_mesh_create(const double* vertices, size_t vertex_count, const uint32_t* triangles,
                           size_t triangle_count, ist_mesh** mesh) IST_NOEXCEPT {
  return create(__func__, MeshArrays<double>{vertices, vertex_count, triangles, triangle_count},
                mesh);
}

ist_status ist_mesh_create_float(const float* vertices, size_t vertex_count,
                                 const uint32_t* triangles, size_t triangle_count,
                                 ist_mesh** mesh) IST_NOEXCEPT {
  return create(__func__, MeshArrays<float>{vertices, vertex_count, triangles, triangle_count},
                mesh);
}

ist_status ist_mesh_read(const char* path, const ist_progress* progress,
                         ist_mesh** mesh) IST_NOEXCEPT {
  return read_object<Mesh>(__func__, path, progress, mesh,
                           [](const char* file) { return ist::read_mesh(file); });
}

ist_status ist_mesh_get_info(const ist_mesh* mesh, const ist_progress* progress,
                             ist_mesh_info* info) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    clear_sized(call, "info", info);
    const Follower follower = read_follower(call, progress);
    const Held<Mesh> held(call, "mesh", mesh);
    if (!held) return;
    ist_mesh_info found{};
    const bool whole =
        followed(follower, [&](const ist::Proceed&) { found = mesh_info_of(*held); });
    if (!whole) return cancelled(call);
    write_sized(found, *info);
  });
}

ist_status ist_mesh_get_size(const ist_mesh* mesh, uint64_t* vertices,
                             uint64_t* triangles) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.clear("vertices", vertices);
    call.clear("triangles", triangles);
    const Held<Mesh> held(call, "mesh", mesh);
    if (!held) return;
    *vertices = held->mesh.vertices.size();
    *triangles = held->mesh.triangles.size();
  });
}

ist_status ist_mesh_copy(const ist_mesh* mesh, double* vertices, size_t vertex_capacity,
                         uint32_t* triangles, size_t triangle_capacity) IST_NOEXCEPT {
  return guarded(__func__, [&](Call& call) {
    call.need_array("vertices", vertices, vertex_capacity);
    call.need_array("triangles", triangles, triangle_capacity);
    const Held<Mesh> held(call, "mesh", mesh);
    if (!held) return;
    const ist::TriangleMesh& made = held->mesh;
    for (const auto& vertex :
         std::span(made.vertices).first(std::min(vertex_capacity, made.vertices.size()))) {
      vertices = std::copy_n(vertex.data(), 3, vertices);
    }
    for (const auto& triangle :
         std::span(made.triangles).first(std::min(triangle_capacity, made.triangles.size()))) {
      triangles = std::copy_n(triangle.data(), 3, triangles);
    }
  });
}

ist_status ist_mesh_free(ist_mesh* mesh) IST_NOEXCEPT { return give_back<Mesh>(__func__, mesh); }
