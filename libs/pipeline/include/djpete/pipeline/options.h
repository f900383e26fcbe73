/// All options of a run, as one INI file holds them.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <string>

#include "djpete/backend/map_keeper.h"
#include "djpete/background/options.h"
#include "djpete/frontend/options.h"
#include "djpete/io/scene_writer.h"
#include "djpete/observers/geometric_observer.h"
#include "djpete/scans/options.h"
#include "djpete/texture/options.h"

namespace djpete::pipeline {

/// Which stages run and how they are joined; section [pipeline].
struct PipelineOptions : public mrpt::config::CLoadableOptions {
    /// auto: recorded if the companion rawlog exists, else geometric if the drive has scans.
    std::string observer = "auto";
    std::string mode = "threaded";  ///< threaded | lockstep; equal results
    /// For work on images, beside the workers' own; 0: all cores. No influence on results.
    unsigned threads = 0;
    bool texture = true;
    /// Key `background`: off | cloud | octomap; cloud and octree are never both on.
    bool background = true;  ///< the coloured cloud
    bool octomap = false;    ///< the coloured octree
    /// A view is textured this many keyframes later, when its poses have settled.
    unsigned textureLagKeyframes = 5;
    /// Static objects nearer than this are textured in a view even if not detected in it.
    double textureRange_m = 30;
    /// Features keep this far from objects' outlines.
    unsigned exclusionMargin_px = 6;
    /// The program checks the drive's calibration first and runs with what it finds.
    bool selfCalibrate = false;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

struct ObjectSlamOptions {
    PipelineOptions pipeline;                       ///< [pipeline]
    frontend::FrontendOptions frontend;             ///< [frontend]
    scans::ScanOptions scans;                       ///< [scans]
    observers::GeometricObserverOptions geometric;  ///< [geometric_observer]
    /// [map_keeper] [backbone] [loops] [places] [place_match] [association] [objects]
    backend::BackendOptions backend;
    texture::TextureOptions texture;             ///< [texture]
    texture::BackgroundCloudOptions background;  ///< [background]
    djpete::background::OctoOptions octomap;     ///< [octomap]
    io::SceneOptions scene;                      ///< [scene]

    /// From an INI file. Throws obs::InputError naming the file if it cannot be read or has an
    /// unknown section or key, or a value out of its range.
    static ObjectSlamOptions fromFile(const std::string& iniFile);
    /// From INI text; `origin` is named in errors.
    static ObjectSlamOptions fromText(const std::string& text, const std::string& origin);
    /// Replaces keys of section [pipeline] by those in `iniText`. Throws as fromText.
    void overridePipeline(const std::string& iniText, const std::string& origin);
    /// INI text with every key, its value and what it means.
    std::string toText() const;
};

}  // namespace djpete::pipeline
