#include "mesh_scene.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

namespace djpete::io {

namespace {

using texture::ColouredMesh;
using texture::MeshAtlas;

constexpr int kLinearFilter = 9729;  ///< of glTF; smaller copies of an atlas would mix its squares

/// Vertices as the file has them: one per vertex of the mesh, or per place in the atlas.
struct Corners {
    std::vector<uint32_t> vertex;
    std::vector<std::array<float, 2>> uv;
    std::vector<std::array<uint32_t, 3>> triangles;
};

Corners cornersOf(const ColouredMesh& mesh) {
    Corners out;
    if (mesh.atlas.empty()) {
        for (uint32_t i = 0; i < mesh.vertices.size(); ++i) out.vertex.push_back(i);
        out.triangles = mesh.triangles;
        return out;
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<uint32_t, 3> triangle{};
        for (unsigned k = 0; k < 3; ++k) {
            const uint32_t vertex = mesh.triangles[t][k];
            const auto& uv = mesh.atlas.corners[t][k];
            std::size_t at = out.vertex.size();
            // The facet's other triangle has come just before.
            for (std::size_t back = 1; back <= 6 && back <= out.vertex.size(); ++back) {
                const std::size_t i = out.vertex.size() - back;
                if (out.vertex[i] == vertex && out.uv[i] == uv) at = i;
            }
            if (at == out.vertex.size()) {
                out.vertex.push_back(vertex);
                out.uv.push_back(uv);
            }
            triangle[k] = static_cast<uint32_t>(at);
        }
        out.triangles.push_back(triangle);
    }
    return out;
}

float channel(uint8_t value, bool linear) {
    const float share = static_cast<float>(value) / 255;
    return linear ? std::pow(share, 2.2F) : share;
}

aiMesh* meshOf(const ColouredMesh& mesh, bool linearColours) {
    const Corners corners = cornersOf(mesh);
    auto* out = new aiMesh;
    out->mName = "object";
    out->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    out->mNumVertices = static_cast<unsigned>(corners.vertex.size());
    out->mVertices = new aiVector3D[out->mNumVertices];
    out->mNormals = new aiVector3D[out->mNumVertices];
    if (corners.uv.empty()) {
        out->mColors[0] = new aiColor4D[out->mNumVertices];
    } else {
        out->mTextureCoords[0] = new aiVector3D[out->mNumVertices];
        out->mNumUVComponents[0] = 2;
    }
    for (unsigned i = 0; i < out->mNumVertices; ++i) {
        const auto& v = mesh.vertices[corners.vertex[i]];
        out->mVertices[i] = {v.position[0], v.position[1], v.position[2]};
        out->mNormals[i] = {v.normal[0], v.normal[1], v.normal[2]};
        if (corners.uv.empty()) {
            out->mColors[0][i] = {channel(v.rgb[0], linearColours),
                                  channel(v.rgb[1], linearColours),
                                  channel(v.rgb[2], linearColours), 1};
        } else {  // from the lower left corner
            out->mTextureCoords[0][i] = {corners.uv[i][0], 1 - corners.uv[i][1], 0};
        }
    }
    out->mNumFaces = static_cast<unsigned>(corners.triangles.size());
    out->mFaces = new aiFace[out->mNumFaces];
    for (unsigned t = 0; t < out->mNumFaces; ++t) {
        out->mFaces[t].mNumIndices = 3;
        out->mFaces[t].mIndices = new unsigned[3];
        for (unsigned k = 0; k < 3; ++k) out->mFaces[t].mIndices[k] = corners.triangles[t][k];
    }
    return out;
}

aiMaterial* materialOf(const std::string& texture) {
    auto* out = new aiMaterial;
    const auto set = [&](auto value, const char* key, unsigned type, unsigned index) {
        out->AddProperty(&value, 1, key, type, index);
    };
    const aiString name("paint");
    out->AddProperty(&name, AI_MATKEY_NAME);
    set(aiColor3D(1, 1, 1), AI_MATKEY_COLOR_DIFFUSE);
    set(aiColor4D(1, 1, 1, 1), AI_MATKEY_BASE_COLOR);
    set(0.0F, AI_MATKEY_METALLIC_FACTOR);
    set(1.0F, AI_MATKEY_ROUGHNESS_FACTOR);
    set(1, AI_MATKEY_TWOSIDED);
    set(aiShadingMode_Unlit, AI_MATKEY_SHADING_MODEL);
    set(true, "$mat.gltf.unlit", 0, 0);  // the key of some versions of the glTF exporter
    if (!texture.empty()) {
        const aiString path(texture);
        out->AddProperty(&path, AI_MATKEY_TEXTURE_DIFFUSE(0));
        set(static_cast<int>(aiTextureMapMode_Clamp), AI_MATKEY_MAPPINGMODE_U_DIFFUSE(0));
        set(static_cast<int>(aiTextureMapMode_Clamp), AI_MATKEY_MAPPINGMODE_V_DIFFUSE(0));
        set(kLinearFilter, AI_MATKEY_GLTF_MAPPINGFILTER_MIN(aiTextureType_DIFFUSE, 0));
        set(kLinearFilter, AI_MATKEY_GLTF_MAPPINGFILTER_MAG(aiTextureType_DIFFUSE, 0));
    }
    return out;
}

aiTexture* textureOf(const std::vector<uint8_t>& png) {
    auto* out = new aiTexture;
    out->mFilename = "atlas";
    out->mWidth = static_cast<unsigned>(png.size());  // mHeight 0: bytes of a file
    out->mHeight = 0;
    std::strcpy(out->achFormatHint, "png");
    out->pcData = new aiTexel[png.size() / sizeof(aiTexel) + 1];
    std::memcpy(static_cast<void*>(out->pcData), png.data(), png.size());
    return out;
}

}  // namespace

std::unique_ptr<aiScene> sceneOf(const ColouredMesh& mesh, const SceneStyle& style) {
    auto scene = std::make_unique<aiScene>();
    scene->mRootNode = new aiNode("object");
    scene->mRootNode->mNumMeshes = 1;
    scene->mRootNode->mMeshes = new unsigned[1]{0};
    if (style.yUp) {
        scene->mRootNode->mTransformation =
            aiMatrix4x4(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1);
    }
    scene->mNumMaterials = 1;
    scene->mMaterials = new aiMaterial* [1] { materialOf(style.texture) };
    scene->mNumMeshes = 1;
    scene->mMeshes = new aiMesh* [1] { meshOf(mesh, style.linearColours) };
    if (!style.png.empty()) {
        scene->mNumTextures = 1;
        scene->mTextures = new aiTexture* [1] { textureOf(style.png) };
    }
    return scene;
}

std::vector<uint8_t> pngOf(const MeshAtlas& atlas) {
    cv::Mat bgr(static_cast<int>(atlas.height_px), static_cast<int>(atlas.width_px), CV_8UC3);
    for (int y = 0; y < bgr.rows; ++y) {
        for (int x = 0; x < bgr.cols; ++x) {
            const auto& rgb = atlas.rgb[static_cast<std::size_t>(y) * atlas.width_px +
                                        static_cast<std::size_t>(x)];
            bgr.at<cv::Vec3b>(y, x) = {rgb[2], rgb[1], rgb[0]};
        }
    }
    std::vector<uint8_t> out;
    cv::imencode(".png", bgr, out);
    return out;
}

}  // namespace djpete::io
