// The true mesh and colours of actors.
#include "djpete/simulator/object_truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>

#include "materials.h"
#include "some_actor.h"

namespace {

using namespace djpete::simulator;

Vec3f vec(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }

double areaOf(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3f& a = mesh.vertices[t.vertex[0]];
        sum += 0.5 *
               static_cast<double>(
                   (mesh.vertices[t.vertex[1]] - a).cross(mesh.vertices[t.vertex[2]] - a).norm());
    }
    return sum;
}

TEST(ObjectTruth, FillsTheActorsBoxWithTrianglesOfATexel) {
    for (const auto& actor : {actorOf(ActorType::Car, 0, 3), actorOf(ActorType::Truck, 0, 3),
                              actorOf(ActorType::Pedestrian, 0, 3)}) {
        SCOPED_TRACE(nameOf(actor.type));
        const double texel = 0.05;
        const ColouredMesh truth = objectTruth(actor, texel);
        const Mesh mesh = makeBody(actor, 0).mesh;
        double area = 0;
        for (const auto& t : truth.triangles) {
            const Vec3f a = vec(truth.vertices.at(t[0]).p_obj),
                        b = vec(truth.vertices.at(t[1]).p_obj),
                        c = vec(truth.vertices.at(t[2]).p_obj);
            ASSERT_LE((a - b).norm(), texel);
            ASSERT_LE((b - c).norm(), texel);
            ASSERT_LE((c - a).norm(), texel);
            area += 0.5 * static_cast<double>((b - a).cross(c - a).norm());
        }
        EXPECT_NEAR(area, areaOf(mesh), 1e-3 * area);
        // No smaller than they need be: a halved edge is longer than half a texel.
        EXPECT_LT(static_cast<double>(truth.triangles.size()),
                  static_cast<double>(mesh.triangles.size()) + 16 * area / (texel * texel));
        if (actor.type == ActorType::Pedestrian) continue;  // one shape does not fill the box
        Vec3f low = Vec3f::Constant(1e9F), high = -low;
        for (const auto& v : truth.vertices) {
            low = low.cwiseMin(vec(v.p_obj));
            high = high.cwiseMax(vec(v.p_obj));
        }
        EXPECT_LT(((high - low).cast<double>() - actor.size_m).norm(), 1e-5);
        EXPECT_LT((high + low).norm(), 1e-5F);
    }
}

TEST(ObjectTruth, EveryEdgeInsideASurfaceHasTwoTriangles) {
    // A wheel's rings are closed except for the hub's last disc and the inner rim.
    const ColouredMesh truth = objectTruth(actorOf(ActorType::Car, 1, 9), 0.04);
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    for (const auto& t : truth.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    std::size_t open = 0;
    for (const auto& [edge, n] : uses) {
        ASSERT_LE(n, 2);
        open += n == 1 ? 1U : 0U;
    }
    EXPECT_LT(static_cast<double>(open), 0.15 * static_cast<double>(uses.size()));
}

TEST(ObjectTruth, ColoursAreThoseTheRendererShadesWith) {
    const Actor actor = actorOf(ActorType::Car, 0, 5);
    const CarBody body = makeBody(actor, 0);
    const ColouredMesh truth = objectTruth(actor, 0.02);
    // The shell comes first, and its corners keep their uv, which is the place in side view.
    std::size_t checked = 0;
    for (std::size_t i = 0; i < body.mesh.triangles.size(); i += 7) {
        const Triangle& t = body.mesh.triangles[i];
        if (body.mesh.finishes[t.finish].material != Material::CarBody) continue;
        SurfacePoint s;
        s.finish = body.mesh.finishes[t.finish];
        s.p_obj = body.mesh.vertices[t.vertex[0]];
        s.n_obj = body.mesh.normals[t.vertex[0]];
        if (s.n_obj.norm() < 0.5F) continue;
        s.car = &body;
        s.footprint_m = 0.02F;
        const Vec3f albedo = shade(s).albedo;
        for (const auto& v : truth.vertices) {
            if (vec(v.p_obj) != s.p_obj || (vec(v.n_obj) - s.n_obj).norm() > 1e-3F) continue;
            EXPECT_LT((vec(v.albedo) - albedo).norm(), 1e-4F) << s.p_obj;
            ++checked;
            for (std::size_t k = 0; k < 3; ++k) {
                const double x = v.albedo[k];
                const double coded =
                    x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
                EXPECT_NEAR(v.srgb[k], 255 * coded, 0.51);
            }
            break;
        }
    }
    EXPECT_GT(checked, 300U);
}

TEST(ObjectTruth, PlyReadsBack) {
    const ColouredMesh truth = objectTruth(actorOf(ActorType::Pedestrian, 0, 2), 0.1, 3);
    const auto file = std::filesystem::path(testing::TempDir()) / "object_truth_test.ply";
    writePly(truth, file);
    std::ifstream in(file, std::ios::binary);
    std::size_t vertices = 0, faces = 0, properties = 0;
    for (std::string line; std::getline(in, line) && line != "end_header";) {
        if (line.rfind("element vertex ", 0) == 0) vertices = std::stoul(line.substr(15));
        if (line.rfind("element face ", 0) == 0) faces = std::stoul(line.substr(13));
        if (line.rfind("property ", 0) == 0) ++properties;
    }
    EXPECT_EQ(properties, 10U);
    ASSERT_EQ(vertices, truth.vertices.size());
    ASSERT_EQ(faces, truth.triangles.size());
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    ASSERT_EQ(bytes.size(), 27 * vertices + 13 * faces);
    for (std::size_t i = 0; i < vertices; ++i) {
        std::array<float, 6> numbers{};
        std::memcpy(numbers.data(), &bytes[27 * i], 24);
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(numbers[k], truth.vertices[i].p_obj[k]);
            ASSERT_EQ(numbers[3 + k], truth.vertices[i].n_obj[k]);
            ASSERT_EQ(static_cast<uint8_t>(bytes[27 * i + 24 + k]), truth.vertices[i].srgb[k]);
        }
    }
    for (std::size_t i = 0; i < faces; ++i) {
        const std::size_t at = 27 * vertices + 13 * i;
        ASSERT_EQ(bytes[at], 3);
        std::array<uint32_t, 3> corner{};
        std::memcpy(corner.data(), &bytes[at + 1], 12);
        ASSERT_EQ(corner, truth.triangles[i]);
    }
    std::filesystem::remove(file);
}

TEST(ObjectTruth, ErrorsNameWhatIsWrong) {
    const Actor actor = actorOf(ActorType::Car, 0, 1);
    EXPECT_THROW(objectTruth(actor, 0.0), std::runtime_error);
    try {
        writePly(ColouredMesh{}, "/no/such/folder/car.ply");
        FAIL() << "no error";
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("/no/such/folder/car.ply"), std::string::npos);
    }
}

}  // namespace
