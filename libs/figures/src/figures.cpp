#include "djpete/figures/figures.h"

#include <cstdio>
#include <filesystem>

#include "canvas.h"
#include "djpete/obs/errors.h"
#include "parts.h"

namespace djpete::figures {

namespace fs = std::filesystem;

namespace {

std::string numbered(const char* stem, int64_t id) {
    char name[64];
    std::snprintf(name, sizeof(name), "%s_%04lld.png", stem, static_cast<long long>(id));
    return name;
}

/// Row i of a file of poses is the frame with the run's first number + i, or i if the file goes on
/// to the run's last frame.
std::map<std::size_t, geometry::SE3> truthOf(const std::string& file, const RunResult& result) {
    const auto truth = evaluation::readTrajectory(file);
    const std::size_t first = result.cameras.firstFrame, count = result.cameras.T_world_cam.size();
    const std::size_t skip = truth.poses.size() >= first + count ? first : 0;
    if (truth.poses.size() < skip + count) {
        throw obs::InputError(file + ": " + std::to_string(truth.poses.size()) +
                              " poses; expected one for each of the run's " +
                              std::to_string(count) + " frames");
    }
    std::map<std::size_t, geometry::SE3> out;
    for (std::size_t i = 0; i < count; ++i) out[first + i] = truth.poses[skip + i];
    return out;
}

class Drawer {
  public:
    explicit Drawer(const FigureRequest& request) : request_(request) {
        result_ = readResult(request.resultFolder);
        std::error_code failed;
        fs::create_directories(request.outFolder, failed);
        if (!fs::is_directory(request.outFolder)) {
            throw obs::InputError(request.outFolder + ": the folder cannot be made");
        }
        objects_ = result_.best(request.maxObjects);
    }

    FigureReport draw() {
        loadFrames();
        const auto scene =
            io::loadScene((fs::path(request_.resultFolder) / "scene.3Dscene").string());
        for (const int64_t id : objects_) {
            const auto& model = result_.models.at(id);
            const auto* first = model.views.empty() ? nullptr : frame(model.views[0].value);
            keep(numbered("figure04_texture", id), textureFigure(model, result_, first));
        }
        if (objects_.empty()) lack("figure04, figure11", "the result has no textured objects");
        keep("figure06_map.png", mapFigure(*scene, result_.cameras));
        perception();
        keep("figure08_joint.png", jointFigure(*scene, result_.cameras));
        keep("figure10_trajectory.png", trajectoryFigure(result_.cameras, truth_));
        for (const int64_t id : objects_) {
            const auto best = bestFrameOf(id, result_);
            const auto* shown = best ? frame(*best) : nullptr;
            const auto name = numbered("figure11_object", id);
            if (shown) {
                keep(name, objectFigure(result_.models.at(id), result_, *shown));
            } else {
                lack(name, noFrame());
            }
        }
        return report_;
    }

  private:
    void loadFrames() {
        busiest_ = busiestFrame(result_);
        if (request_.drive) {
            std::vector<std::size_t> wanted;
            if (busiest_) wanted.push_back(*busiest_);
            for (const int64_t id : objects_) {
                if (const auto best = bestFrameOf(id, result_)) wanted.push_back(*best);
                const auto& views = result_.models.at(id).views;
                if (!views.empty()) wanted.push_back(views[0].value);
            }
            frames_ = readDrive(*request_.drive, result_.cameras, wanted);
        }
        truth_ = request_.truthFile ? truthOf(*request_.truthFile, result_) : frames_.trueCameras;
    }
    void perception() {
        const std::string name = "figure07_perception.png";
        if (!busiest_) {
            lack(name, "no object is well in view of any keyframe");
        } else if (const auto* shown = frame(*busiest_)) {
            keep(name, perceptionFigure(result_, *shown));
        } else {
            lack(name, noFrame());
        }
    }
    const ShownFrame* frame(std::size_t number) const {
        const auto it = frames_.shown.find(number);
        return it == frames_.shown.end() ? nullptr : &it->second;
    }
    std::string noFrame() const {
        return request_.drive ? "the drive has no image of that frame"
                              : "it needs the drive's images (--drive)";
    }
    void keep(const std::string& name, const Figure& figure) {
        if (figure.picture.empty()) {
            lack(name, figure.whyNot);
            return;
        }
        const auto file = (fs::path(request_.outFolder) / name).string();
        save(figure.picture, file);
        report_.written.push_back(file);
    }
    void lack(const std::string& name, const std::string& why) {
        report_.missing.push_back(name + " is not drawn: " + why);
    }

    FigureRequest request_;
    RunResult result_;
    std::vector<int64_t> objects_;
    std::optional<std::size_t> busiest_;
    DriveFrames frames_;
    std::map<std::size_t, geometry::SE3> truth_;
    FigureReport report_;
};

}  // namespace

FigureReport drawFigures(const FigureRequest& request) { return Drawer(request).draw(); }

}  // namespace djpete::figures
