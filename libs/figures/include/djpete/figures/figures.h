/// Pictures like those of the paper, from a result folder and its drive.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace djpete::figures {

struct FigureRequest {
    std::string resultFolder;              ///< of djpete-slam
    std::string outFolder;                 ///< made if it is missing
    std::optional<std::string> drive;      ///< rawlog; needed for what shows images or scans
    std::optional<std::string> truthFile;  ///< poses; else the drive's own truth, if it has one
    std::size_t maxObjects = 4;            ///< those with the most coloured points
};

struct FigureReport {
    std::vector<std::string> written;  ///< files
    std::vector<std::string> missing;  ///< one sentence per figure that could not be drawn, and why
};

/// Draws, where the paper's numbers are in the names:
/// - figure04_texture_NNNN.png: an object's points, as its first view coloured it, as all did;
/// - figure06_map.png: trajectory and sparse map, whole and in detail;
/// - figure07_perception.png: the image with the most objects, their boxes and ids;
/// - figure08_joint.png: map, background, objects and trajectory in one;
/// - figure10_trajectory.png: the trajectory over the truth;
/// - figure11_object_NNNN.png: an object's points, its image, its projection, its place in the
/// scan. Throws obs::InputError naming the file that is missing or broken in the result or the
/// drive.
FigureReport drawFigures(const FigureRequest& request);

}  // namespace djpete::figures
