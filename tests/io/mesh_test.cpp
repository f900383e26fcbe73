#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "djpete/io/mesh_writer.h"
#include "djpete/obs/errors.h"

namespace {

using djpete::io::writeMesh;
using djpete::texture::ColouredMesh;
using djpete::texture::MeshOptions;
using djpete::texture::ObjectModel;
using testing::HasSubstr;
namespace fs = std::filesystem;

class MeshFile : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) /
                  (std::string("djpete_mesh_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    fs::path folder_;
};

/// A plate 1 m ahead, 0.4 m to the left, 0.2 m high; red to the left, blue to the right.
ColouredMesh plate(uint32_t block_px = 4) {
    ObjectModel model;
    for (int i = 0; i < 20; ++i) {
        for (int j = 0; j < 20; ++j) {
            model.addPoint({1, 0.04F * static_cast<float>(i), 0.2F + 0.04F * static_cast<float>(j)},
                           {1, 0, 0}, 0.04F);
            model.colours.back().add(
                i < 10 ? std::array<float, 3>{20, 30, 200} : std::array<float, 3>{200, 30, 20}, 1);
        }
    }
    MeshOptions options;
    options.block_px = block_px;
    return djpete::texture::makeMesh(model, options);
}

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Triangles, and the range of the first mesh's vertices with its nodes applied.
struct Loaded {
    unsigned triangles = 0;
    aiVector3D low{1e9F, 1e9F, 1e9F}, high{-1e9F, -1e9F, -1e9F};
};

Loaded rangeOf(const aiScene& scene) {
    Loaded out;
    out.triangles = scene.mMeshes[0]->mNumFaces;
    for (unsigned i = 0; i < scene.mMeshes[0]->mNumVertices; ++i) {
        const auto& v = scene.mMeshes[0]->mVertices[i];
        out.low = {std::min(out.low.x, v.x), std::min(out.low.y, v.y), std::min(out.low.z, v.z)};
        out.high = {std::max(out.high.x, v.x), std::max(out.high.y, v.y),
                    std::max(out.high.z, v.z)};
    }
    return out;
}

TEST_F(MeshFile, PlyLoadsBack) {
    const ColouredMesh mesh = plate();
    writeMesh(mesh, path("a.ply"));
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path("a.ply"), 0);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    const aiMesh& loaded = *scene->mMeshes[0];
    ASSERT_EQ(loaded.mNumFaces, mesh.triangles.size());
    ASSERT_EQ(loaded.mNumVertices, mesh.vertices.size());
    ASSERT_TRUE(loaded.HasVertexColors(0));
    ASSERT_TRUE(loaded.HasNormals());
    for (unsigned i = 0; i < loaded.mNumVertices; ++i) {
        EXPECT_FLOAT_EQ(loaded.mVertices[i].y, mesh.vertices[i].position[1]);
        EXPECT_FLOAT_EQ(loaded.mNormals[i].x, mesh.vertices[i].normal[0]);
        EXPECT_NEAR(loaded.mColors[0][i].r * 255, mesh.vertices[i].rgb[0], 0.51);
    }
}

/// Colour of the atlas where a vertex of the loaded mesh is.
cv::Vec3b texelAt(const cv::Mat& atlas, const aiVector3D& uv) {
    const int x = static_cast<int>(uv.x * static_cast<float>(atlas.cols));
    const int y = static_cast<int>((1 - uv.y) * static_cast<float>(atlas.rows));
    return atlas.at<cv::Vec3b>(std::clamp(y, 0, atlas.rows - 1), std::clamp(x, 0, atlas.cols - 1));
}

TEST_F(MeshFile, ObjLoadsBackWithItsPicture) {
    const ColouredMesh mesh = plate();
    writeMesh(mesh, path("car 1.obj"));
    ASSERT_TRUE(fs::exists(folder_ / "car 1.mtl"));
    ASSERT_TRUE(fs::exists(folder_ / "car 1.png"));
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path("car 1.obj"), aiProcess_JoinIdenticalVertices);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    const aiMesh& loaded = *scene->mMeshes[0];
    EXPECT_EQ(loaded.mNumFaces, mesh.triangles.size());
    aiString picture;
    ASSERT_EQ(
        scene->mMaterials[loaded.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &picture),
        aiReturn_SUCCESS);
    EXPECT_STREQ(picture.C_Str(), "car 1.png");
    const cv::Mat atlas = cv::imread(path("car 1.png"));
    ASSERT_TRUE(loaded.HasTextureCoords(0));
    std::size_t red = 0, blue = 0;
    for (unsigned i = 0; i < loaded.mNumVertices; ++i) {
        const cv::Vec3b bgr = texelAt(atlas, loaded.mTextureCoords[0][i]);
        if (loaded.mVertices[i].y > 0.5F) {
            ++red;
            EXPECT_EQ(bgr, cv::Vec3b(20, 30, 200));
        } else if (loaded.mVertices[i].y < 0.3F) {
            ++blue;
            EXPECT_EQ(bgr, cv::Vec3b(200, 30, 20));
        }
    }
    EXPECT_GT(red, 20U);
    EXPECT_GT(blue, 20U);
}

TEST_F(MeshFile, GlbLoadsBackUprightWithItsPictureInside) {
    const ColouredMesh mesh = plate();
    writeMesh(mesh, path("a.glb"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path("a.glb"), aiProcess_PreTransformVertices);
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    const Loaded range = rangeOf(*scene);
    EXPECT_EQ(range.triangles, mesh.triangles.size());
    EXPECT_NEAR(range.low.z, 1, 0.03);  // ahead
    EXPECT_NEAR(range.high.z, 1, 0.03);
    EXPECT_NEAR(range.low.y, 0.2, 0.06);  // up
    EXPECT_NEAR(range.high.y, 0.96, 0.06);
    EXPECT_NEAR(range.low.x, 0, 0.06);  // left
    EXPECT_NEAR(range.high.x, 0.76, 0.06);
    ASSERT_EQ(scene->mNumTextures, 1U);
    const aiTexture& inside = *scene->mTextures[0];
    ASSERT_EQ(inside.mHeight, 0U);
    const cv::Mat atlas = cv::imdecode(
        cv::Mat(1, static_cast<int>(inside.mWidth), CV_8U, inside.pcData), cv::IMREAD_COLOR);
    EXPECT_EQ(atlas.cols, static_cast<int>(mesh.atlas.width_px));
    EXPECT_EQ(atlas.rows, static_cast<int>(mesh.atlas.height_px));
    const aiMesh& loaded = *scene->mMeshes[0];
    for (unsigned i = 0; i < loaded.mNumVertices; ++i) {
        const cv::Vec3b bgr = texelAt(atlas, loaded.mTextureCoords[0][i]);
        if (loaded.mVertices[i].x > 0.5F) {
            EXPECT_EQ(bgr, cv::Vec3b(20, 30, 200));
        }
    }
    // Shown as it was seen, without a viewer's lamps, and from both sides.
    EXPECT_NE(bytesOf(path("a.glb")).find("\"KHR_materials_unlit\":{}"), std::string::npos);
    EXPECT_NE(bytesOf(path("a.glb")).find("\"doubleSided\":true"), std::string::npos);
}

TEST_F(MeshFile, WithoutAnAtlasVerticesCarryTheColours) {
    for (const char* name : {"a.obj", "a.glb"}) {
        writeMesh(plate(0), path(name));
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(path(name), 0);
        ASSERT_NE(scene, nullptr) << importer.GetErrorString();
        EXPECT_TRUE(scene->mMeshes[0]->HasVertexColors(0)) << name;
        EXPECT_EQ(scene->mNumTextures, 0U);
    }
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(MeshFile, TheSameMeshGivesTheSameBytes) {
    for (const char* ending : {"ply", "obj", "glb"}) {
        const fs::path one = folder_ / "one", two = folder_ / "two";
        fs::create_directories(one);
        fs::create_directories(two);
        const std::string name = std::string("a.") + ending;
        writeMesh(plate(), (one / name).string());
        writeMesh(plate(), (two / name).string());
        EXPECT_TRUE(bytesOf(one / name) == bytesOf(two / name)) << ending;
    }
    EXPECT_EQ(bytesOf(folder_ / "one" / "a.mtl"), bytesOf(folder_ / "two" / "a.mtl"));
}

std::string sentenceOf(const ColouredMesh& mesh, const std::string& file) {
    try {
        writeMesh(mesh, file);
    } catch (const djpete::obs::InputError& e) {
        return e.what();
    }
    return "";
}

TEST_F(MeshFile, WhatCannotBeWrittenIsTold) {
    EXPECT_THAT(sentenceOf(plate(), path("a.stl")), HasSubstr("a.stl: expected a mesh file"));
    EXPECT_THAT(sentenceOf(ColouredMesh(), path("a.ply")), HasSubstr("a.ply: there is no surface"));
    for (const char* ending : {"ply", "obj", "glb"}) {
        EXPECT_THAT(sentenceOf(plate(), path(std::string("no/such/a.") + ending)),
                    HasSubstr("no/such/a."));
    }
}

}  // namespace
