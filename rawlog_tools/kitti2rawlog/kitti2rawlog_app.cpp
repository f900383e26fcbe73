#include "kitti2rawlog_app.h"

#include <ostream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_app/command_line.h"
#include "djpete_app/progress_bar.h"

namespace djpete::kitti2rawlog {

using obs::InputError;

namespace {

constexpr const char* kHelp =
    "Converts a KITTI drive to an MRPT rawlog, and its labels or detections to a companion "
    "<out>_objects.rawlog. Layouts: odometry (--input sequences/00; poses are found in "
    "../../poses), raw (--input 2011_09_26/2011_09_26_drive_0005_sync; calibration one level up), "
    "tracking (--input training --sequence 0006, or --input training/image_02/0006), object "
    "(--input training), and what simulate-drive writes. Images and scans stay where they are "
    "unless --copy is given";

/// What an option names: nothing for "none", what was found if it is not given.
std::optional<std::filesystem::path> chosen(TCLAP::ValueArg<std::string>& option,
                                            const std::optional<std::filesystem::path>& found) {
    if (!option.isSet()) return found;
    const std::string text = option.getValue();
    if (text == "none") return std::nullopt;
    if (!std::filesystem::exists(text))
        throw InputError(text + ": no such file; expected what --" + option.getName() + " names");
    return text;
}

BoxSigma sigma(const std::string& option, double position_m, double rotation_deg) {
    if (!(position_m > 0) || !(rotation_deg > 0))
        throw InputError("--" + option + "-sigma-m, --" + option +
                         "-sigma-deg: expected positive numbers");
    return {position_m, rotation_deg};
}

std::string summary(const ConversionReport& r) {
    std::ostringstream o;
    o << r.info.name << ": " << r.frames << " frames from " << r.info.firstFrame << " on";
    if (!r.info.missing.empty()) o << " (" << r.info.missing.size() << " missing in between)";
    const auto item = [&o](uint64_t n, const char* what) {
        if (n > 0) o << ", " << n << " " << what;
    };
    item(r.stereoPairs, "stereo pairs");
    item(r.singleImages, "single images");
    item(r.rightOnly, "right images without a left one (left out)");
    item(r.scans, "scans");
    item(r.oxtsPackets, "OXTS packets");
    item(r.truthPoses, "true poses");
    if (r.hasLabels) o << ", " << r.labels << " labels";
    if (r.hasDetections) o << ", " << r.detections << " detections";
    o << " ->";
    for (const auto& f : r.files) o << " " << f.string();
    return o.str();
}

}  // namespace

bool Kitti2RawlogApp::initialize(int argc, const char* const* argv) {
    using Text = TCLAP::ValueArg<std::string>;
    TCLAP::CmdLine cmd(kHelp, ' ', "0.1.0");
    Text input("i", "input", "Folder of the drive", true, "", "folder", cmd);
    Text out("o", "out", "Rawlog to write", true, "", "drive.rawlog", cmd);
    Text sequence("s", "sequence", "Sequence of a tracking folder", false, "", "0006", cmd);
    Text poses("p", "poses",
               "Poses in KITTI's format, row i for frame i; none: leave out those found", false, "",
               "file", cmd);
    Text labels("l", "labels",
                "KITTI labels: a file of a drive, or a folder of one file per frame; none: leave "
                "out those found",
                false, "", "path", cmd);
    Text detections("d", "detections",
                    "Detections in KITTI's columns or PointRCNN's; none: leave out those found",
                    false, "", "path", cmd);
    Text range("r", "range", "Frames A to B-1", false, "", "A:B", cmd);
    Text calib("c", "calib",
               "Calibration if it is not beside the drive: file, or folder of a raw day", false, "",
               "path", cmd);
    Text name("n", "name", "Name of the drive in the rawlog's head", false, "", "words", cmd);
    TCLAP::SwitchArg copy("", "copy", "Copy images and scans to <out>_Images", cmd);
    using Number = TCLAP::ValueArg<double>;
    Number detM("", "detection-sigma-m", "Sigma of detected positions, m (0.3)", false, 0.3, "m",
                cmd);
    Number detDeg("", "detection-sigma-deg", "Sigma of detected rotations, degrees (5)", false, 5.0,
                  "deg", cmd);
    Number labM("", "label-sigma-m", "Sigma of labelled positions, m (0.1)", false, 0.1, "m", cmd);
    Number labDeg("", "label-sigma-deg", "Sigma of labelled rotations, degrees (2)", false, 2.0,
                  "deg", cmd);
    apps::CommandLineOutput output;
    cmd.setOutput(&output);
    // False after --help and --version; failures leave through `output`.
    if (!cmd.parse(argc, const_cast<const char**>(argv))) return false;
    job = ConversionJob();
    job.drive = findDrive(input.getValue(), sequence.getValue());
    job.out = out.getValue();
    job.range = apps::parseFrameRange(range.getValue());
    job.copyFiles = copy.getValue();
    job.drive.poses = chosen(poses, job.drive.poses);
    job.drive.detections = chosen(detections, job.drive.detections);
    job.drive.labels = chosen(labels, job.drive.labels);
    if (labels.isSet()) job.drive.frameLabels.clear();
    if (calib.isSet()) job.drive.calibration = chosen(calib, {}).value_or("none");
    if (name.isSet()) job.drive.name = name.getValue();
    job.detectionSigma = sigma("detection", detM.getValue(), detDeg.getValue());
    job.labelSigma = sigma("label", labM.getValue(), labDeg.getValue());
    return true;
}

void Kitti2RawlogApp::run(std::ostream& out) {
    apps::ProgressBar bar;
    try {
        report = convert(job, [&bar](uint64_t done, uint64_t all) { bar.show(done, all); });
    } catch (...) {
        bar.finish();
        throw;
    }
    bar.finish();
    out << summary(report) << "\n";
}

}  // namespace djpete::kitti2rawlog
