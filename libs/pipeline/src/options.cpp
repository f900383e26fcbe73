#include "djpete/pipeline/options.h"

#include <mrpt/config/CConfigFileMemory.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete/obs/options.h"

namespace djpete::pipeline {

namespace {

void requireWord(const std::string& key, const std::string& value,
                 const std::vector<std::string>& allowed) {
    std::string words;
    for (const auto& w : allowed) {
        if (w == value) return;
        words += (words.empty() ? "" : ", ") + w;
    }
    throw obs::InputError("key '" + key + "' is '" + value + "'; expected one of: " + words);
}

std::string backgroundWord(const PipelineOptions& options) {
    return options.octomap ? "octomap" : options.background ? "cloud" : "off";
}

void readBackground(const std::string& word, PipelineOptions& options) {
    requireWord("background", word, {"off", "cloud", "octomap", "false", "true"});
    options.octomap = word == "octomap";
    options.background = word == "cloud" || word == "true";
}

}  // namespace

void PipelineOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                         const std::string& section) {
    observer = source.read_string(section, "observer", observer);
    mode = source.read_string(section, "mode", mode);
    const auto threadsRead = source.read_int(section, "threads", int(threads));
    texture = source.read_bool(section, "texture", texture);
    readBackground(source.read_string(section, "background", backgroundWord(*this)), *this);
    const auto lag = source.read_int(section, "texture_lag_keyframes", int(textureLagKeyframes));
    textureRange_m = source.read_double(section, "texture_range_m", textureRange_m);
    const auto margin = source.read_int(section, "exclusion_margin_px", int(exclusionMargin_px));
    selfCalibrate = source.read_bool(section, "self_calibrate", selfCalibrate);
    requireWord("observer", observer, {"auto", "recorded", "geometric", "none"});
    requireWord("mode", mode, {"threaded", "lockstep"});
    if (lag < 0 || lag > 100) {
        throw obs::InputError("key 'texture_lag_keyframes' is " + std::to_string(lag) +
                              "; expected 0 to 100");
    }
    if (margin < 0 || margin > 100) {
        throw obs::InputError("key 'exclusion_margin_px' is " + std::to_string(margin) +
                              "; expected 0 to 100");
    }
    if (threadsRead < 0 || threadsRead > 256) {
        throw obs::InputError("key 'threads' is " + std::to_string(threadsRead) +
                              "; expected 0 (all cores) to 256");
    }
    threads = unsigned(threadsRead);
    textureLagKeyframes = unsigned(lag);
    exclusionMargin_px = unsigned(margin);
}

void PipelineOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target,
                                       const std::string& section) const {
    target.write(section, "observer", observer, 0, 0,
                 "auto | recorded | geometric | none; auto: recorded if <drive>_objects.rawlog "
                 "exists, else geometric if there are scans");
    target.write(section, "mode", mode, 0, 0,
                 "threaded | lockstep; both give the same bytes, lockstep uses one thread");
    target.write(section, "threads", threads, 0, 0,
                 "for work on images, beside the workers' own; 0: all cores; no influence on "
                 "results");
    target.write(section, "texture", texture, 0, 0, "colour the objects");
    target.write(section, "background", backgroundWord(*this), 0, 0,
                 "off | cloud | octomap: what is no object, for the scene. cloud: coloured points; "
                 "octomap: a coloured octree, see [octomap], also as background.ot and .bt. false "
                 "and true mean off and cloud");
    target.write(section, "texture_lag_keyframes", textureLagKeyframes, 0, 0,
                 "a view is textured this many keyframes later, when its poses have settled");
    target.write(section, "texture_range_m", textureRange_m, 0, 0,
                 "static objects nearer than this are textured even in views without a detection");
    target.write(section, "exclusion_margin_px", exclusionMargin_px, 0, 0,
                 "features keep this far from the outlines of objects");
    target.write(section, "self_calibrate", selfCalibrate, 0, 0,
                 "djpete-slam first asks the drive itself for errors of its calibration (see "
                 "--check-calibration) and puts them right");
}

ObjectSlamOptions ObjectSlamOptions::fromFile(const std::string& iniFile) {
    std::ifstream in(iniFile);
    if (!std::filesystem::is_regular_file(iniFile) || !in) {
        throw obs::InputError(iniFile + ": no such configuration file");
    }
    std::stringstream text;
    text << in.rdbuf();
    return fromText(text.str(), iniFile);
}

ObjectSlamOptions ObjectSlamOptions::fromText(const std::string& text, const std::string& origin) {
    const mrpt::config::CConfigFileMemory config(text);
    obs::requireKnownSections(config,
                              {"pipeline", "frontend", "scans", "geometric_observer", "map_keeper",
                               "backbone", "loops", "places", "place_match", "association",
                               "objects", "joint", "texture", "background", "octomap", "scene"},
                              origin);
    ObjectSlamOptions out;
    try {
        obs::loadOptions(out.pipeline, config, "pipeline", origin);
        obs::loadOptions(out.frontend, config, "frontend", origin);
        out.frontend.check();
        obs::loadOptions(out.scans, config, "scans", origin);
        obs::loadOptions(out.geometric, config, "geometric_observer", origin);
        out.backend.load(config, origin);
        obs::loadOptions(out.texture, config, "texture", origin);
        obs::loadOptions(out.background, config, "background", origin);
        obs::loadOptions(out.octomap, config, "octomap", origin);
        obs::loadOptions(out.scene, config, "scene", origin);
    } catch (const obs::InputError& e) {
        const std::string what = e.what();
        if (what.rfind(origin, 0) == 0) throw;
        throw obs::InputError(origin + ": " + what);
    }
    return out;
}

void ObjectSlamOptions::overridePipeline(const std::string& iniText, const std::string& origin) {
    const mrpt::config::CConfigFileMemory config(iniText);
    try {
        obs::loadOptions(pipeline, config, "pipeline", origin);
    } catch (const obs::InputError& e) {
        throw obs::InputError(origin + ": " + e.what());
    }
}

std::string ObjectSlamOptions::toText() const {
    mrpt::config::CConfigFileMemory config;
    pipeline.saveToConfigFile(config, "pipeline");
    frontend.saveToConfigFile(config, "frontend");
    scans.saveToConfigFile(config, "scans");
    geometric.saveToConfigFile(config, "geometric_observer");
    backend.save(config);
    texture.saveToConfigFile(config, "texture");
    background.saveToConfigFile(config, "background");
    octomap.saveToConfigFile(config, "octomap");
    scene.saveToConfigFile(config, "scene");
    return config.getContent();
}

}  // namespace djpete::pipeline
