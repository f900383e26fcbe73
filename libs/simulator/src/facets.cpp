#include "facets.h"

namespace djpete::simulator {

std::vector<Facet> facetsOf(const Mesh& mesh) {
    const auto normalAt = [&](uint32_t vertex) {
        return vertex < mesh.normals.size() ? mesh.normals[vertex] : Vec3f(Vec3f::Zero());
    };
    std::vector<Facet> facets(mesh.triangles.size());
    for (std::size_t i = 0; i < facets.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const uint32_t a = t.vertex[0], b = t.vertex[1], c = t.vertex[2];
        Facet& f = facets[i];
        f.uv = mesh.uv[a];
        f.uvAlongB = mesh.uv[b] - mesh.uv[a];
        f.uvAlongC = mesh.uv[c] - mesh.uv[a];
        f.normal = (mesh.vertices[b] - mesh.vertices[a])
                       .cross(mesh.vertices[c] - mesh.vertices[a])
                       .normalized();
        f.tangentU = t.tangentU;
        f.tangentV = t.tangentV;
        f.normalA = normalAt(a);
        f.normalAlongB = normalAt(b) - f.normalA;
        f.normalAlongC = normalAt(c) - f.normalA;
        f.finish = mesh.finishes[t.finish];
        f.patch = t.patch;
    }
    return facets;
}

}  // namespace djpete::simulator
