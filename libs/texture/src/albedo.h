/// Takes the light out of colours: what the surfaces of objects are by themselves. Private.
#pragma once

#include <vector>

#include "daylight.h"
#include "djpete/texture/object_model.h"
#include "djpete/texture/options.h"

namespace djpete::texture {

/// A coloured model and where it stands.
struct LitObject {
    ObjectModel* model = nullptr;
    geometry::Mat3 R_world_obj = geometry::Mat3::Identity();
    std::vector<geometry::Vec3> cameras_obj;  ///< parallel to model->views
    GroundRing ring;                          ///< of the ground around it
    double clipped = 1;                       ///< light from which on some view may be clipped
};

/// Fills `albedo` of all models, and flag::kDarkPart. One lamp is assumed for the whole drive, sun
/// and sky, measured on the ground around the objects (groundLevels); the sun stands where most
/// points of all cars are explained by one paint per car. Then each point is paint, a dark part
/// (glass, tyres, grilles, whose light is mostly mirrored), or something else, whose albedo is its
/// light over the light that arrives. Without any ground around objects nothing happens. The same
/// for any number of threads.
void estimateAlbedos(std::vector<LitObject>& objects, double gamma, unsigned threads);

}  // namespace djpete::texture
