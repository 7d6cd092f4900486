// The files as assimp reads them. (Its binding for Python, in Debian 12, reads no scene at all.)

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "answers/formats/glb_writer.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/samples.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using answers::NamedPolyData;
using answers::PolyData;

Eigen::Vector3f as_eigen(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// The sRGB byte that a viewer shows for a linear share of light (IEC 61966-2-1).
double shown(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

enum class Colours : std::uint8_t { kSrgb, kLinear };

void expect_mesh(const aiMesh& mesh, const PolyData& data, Colours colours) {
  ASSERT_EQ(mesh.mNumVertices, data.points.size());
  ASSERT_EQ(mesh.HasNormals(), !data.normals.empty());
  ASSERT_EQ(mesh.HasVertexColors(0), !data.colours.empty());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    EXPECT_EQ(as_eigen(mesh.mVertices[i]), data.points[i].cast<float>());
    if (mesh.HasNormals()) {
      EXPECT_EQ(as_eigen(mesh.mNormals[i]), data.normals[i]);
    }
    if (!mesh.HasVertexColors(0)) continue;
    const aiColor4D& colour = mesh.mColors[0][i];
    for (unsigned k = 0; k < 3; ++k) {
      const double number = colour[k];
      EXPECT_NEAR(colours == Colours::kLinear ? shown(number) : 255 * number, data.colours[i][k],
                  0.05);
    }
    EXPECT_EQ(colour.a, 1);
  }
}

std::vector<std::uint32_t> corners_of(const aiMesh& mesh, unsigned each) {
  std::vector<std::uint32_t> corners;
  for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
    EXPECT_EQ(face.mNumIndices, each);
    corners.insert(corners.end(), face.mIndices, face.mIndices + face.mNumIndices);
  }
  return corners;
}

class ReadByAssimp : public ::testing::Test {
 protected:
  // Vertices as they are in the file, neither joined nor moved.
  const aiScene* read(const std::filesystem::path& file) {
    const aiScene* scene = importer_.ReadFile(file.string(), 0);
    EXPECT_NE(scene, nullptr) << importer_.GetErrorString();
    return scene;
  }

  const TempDir dir_;
  Assimp::Importer importer_;
};

TEST_F(ReadByAssimp, PlyOfTwoJawsAndOfQuads) {
  for (const PolyData& data : {answers::joined(sample_bodies()), sample_quads()}) {
    answers::write_ply(data, dir_.path() / "data.ply", "a sample");
    const aiScene* scene = read(dir_.path() / "data.ply");
    ASSERT_NE(scene, nullptr);
    ASSERT_EQ(scene->mNumMeshes, 1u);
    expect_mesh(*scene->mMeshes[0], data, Colours::kSrgb);
    EXPECT_EQ(corners_of(*scene->mMeshes[0], static_cast<unsigned>(data.corners)), data.polygons);
  }
}

TEST_F(ReadByAssimp, GlbOfTwoJawsAndOfPoints) {
  std::vector<NamedPolyData> bodies = sample_bodies();
  bodies.push_back({"points", sample_points()});
  answers::write_glb(bodies, 0.001, dir_.path() / "data.glb");
  const aiScene* scene = read(dir_.path() / "data.glb");
  ASSERT_NE(scene, nullptr);
  ASSERT_EQ(scene->mNumMeshes, 3u);
  const aiNode& root = *scene->mRootNode;
  ASSERT_EQ(root.mNumChildren, 3u);
  for (unsigned i = 0; i < 3; ++i) {
    const aiNode& node = *root.mChildren[i];
    EXPECT_EQ(std::string(node.mName.C_Str()), bodies[i].name);
    EXPECT_TRUE(node.mTransformation.IsIdentity());
    ASSERT_EQ(node.mNumMeshes, 1u);
    const aiMesh& mesh = *scene->mMeshes[node.mMeshes[0]];
    expect_mesh(mesh, bodies[i].data, Colours::kLinear);
    if (i < 2) {
      EXPECT_EQ(corners_of(mesh, 3), bodies[i].data.polygons);
    } else {
      EXPECT_EQ(mesh.mPrimitiveTypes, unsigned{aiPrimitiveType_POINT});
    }
  }
  const aiVector3D placed = root.mTransformation * aiVector3D(1, 20, 300);
  EXPECT_TRUE(as_eigen(placed).isApprox(Eigen::Vector3f(0.001f, 0.3f, -0.02f)));
}

}  // namespace
}  // namespace ist::test
