#include "kitti2rawlog_app.h"

#include <mrpt/3rdparty/tclap/CmdLine.h>
#include <unistd.h>

#include <iostream>
#include <sstream>

#include "djpete/obs/errors.h"
#include "text_table.h"

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

/// Whole numbers of at most 18 digits, or nothing.
std::optional<uint64_t> wholeNumber(const std::string& s) {
    if (s.empty() || s.size() > 18) return std::nullopt;
    for (char c : s)
        if (c < '0' || c > '9') return std::nullopt;
    return std::stoull(s);
}

std::optional<std::filesystem::path> existing(const std::string& option, const std::string& text) {
    if (!std::filesystem::exists(text))
        throw InputError(text + ": no such file; expected what --" + option + " names");
    return text;
}

BoxSigma sigma(const std::string& option, double position_m, double rotation_deg) {
    if (!(position_m > 0) || !(rotation_deg > 0))
        throw InputError("--" + option + "-sigma-m, --" + option +
                         "-sigma-deg: expected positive numbers");
    return {position_m, rotation_deg};
}

/// Turns what TCLAP would print over many lines into one InputError.
class OneSentenceFailure : public TCLAP::StdOutput {
  public:
    [[noreturn]] void failure(TCLAP::CmdLineInterface&, TCLAP::ArgException& e) override {
        throw InputError("kitti2rawlog: " + e.error() +
                         (e.argId() == " " ? "" : " (" + e.argId() + ")") +
                         "; see kitti2rawlog --help");
    }
};

/// A bar that redraws itself on a terminal, a line every tenth part elsewhere.
class ProgressBar {
  public:
    void operator()(uint64_t done, uint64_t all) {
        const uint64_t tenth = all == 0 ? 10 : done * 10 / all;
        if (terminal_) {
            const uint64_t ticks = all == 0 ? 40 : done * 40 / all;
            if (ticks == last_ && done != all) return;
            last_ = ticks;
            std::cerr << "\r[" << std::string(static_cast<std::size_t>(ticks), '#')
                      << std::string(static_cast<std::size_t>(40 - ticks), '.') << "] " << done
                      << "/" << all << " frames" << (done == all ? "\n" : "") << std::flush;
        } else if (tenth != last_) {
            last_ = tenth;
            std::cerr << done << "/" << all << " frames\n";
        }
    }

  private:
    bool terminal_ = isatty(STDERR_FILENO) == 1;
    uint64_t last_ = UINT64_MAX;
};

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
    item(r.labels, "labels");
    item(r.detections, "detections");
    o << " ->";
    for (const auto& f : r.files) o << " " << f.string();
    return o.str();
}

}  // namespace

FrameRange parseRange(const std::string& text) {
    const auto colon = text.find(':');
    const std::string a = text.substr(0, colon);
    const std::string b = colon == std::string::npos ? "" : text.substr(colon + 1);
    const auto first = a.empty() ? std::optional<uint64_t>(0) : wholeNumber(a);
    const auto end = b.empty() ? std::optional<uint64_t>(UINT64_MAX) : wholeNumber(b);
    if (colon == std::string::npos || !first || !end || *first >= *end) {
        throw InputError("--range " + text +
                         ": expected A:B with A < B for the frames A to B-1, e.g. 0:100");
    }
    return {*first, *end};
}

bool Kitti2RawlogApp::initialize(int argc, const char* const* argv) {
    using Text = TCLAP::ValueArg<std::string>;
    TCLAP::CmdLine cmd(kHelp, ' ', "0.1.0");
    Text input("i", "input", "Folder of the drive", true, "", "folder", cmd);
    Text out("o", "out", "Rawlog to write", true, "", "drive.rawlog", cmd);
    Text sequence("s", "sequence", "Sequence of a tracking folder", false, "", "0006", cmd);
    Text poses("p", "poses", "Poses in KITTI's format, row i for frame i", false, "", "file", cmd);
    Text labels("l", "labels", "KITTI labels: a file of a drive, or a folder of one file per frame",
                false, "", "path", cmd);
    Text detections("d", "detections", "Detections in KITTI's columns or PointRCNN's", false, "",
                    "path", cmd);
    Text range("r", "range", "Frames A to B-1", false, ":", "A:B", cmd);
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
    OneSentenceFailure output;
    cmd.setOutput(&output);
    // False after --help and --version; failures leave through `output`.
    if (!cmd.parse(argc, const_cast<const char**>(argv))) return false;
    job = ConversionJob();
    job.drive = findDrive(input.getValue(), sequence.getValue());
    job.out = out.getValue();
    job.range = parseRange(range.getValue());
    job.copyFiles = copy.getValue();
    if (poses.isSet()) job.drive.poses = existing("poses", poses.getValue());
    if (labels.isSet()) job.drive.labels = existing("labels", labels.getValue());
    if (detections.isSet()) job.drive.detections = existing("detections", detections.getValue());
    if (calib.isSet()) job.drive.calibration = *existing("calib", calib.getValue());
    if (name.isSet()) job.drive.name = name.getValue();
    job.detectionSigma = sigma("detection", detM.getValue(), detDeg.getValue());
    job.labelSigma = sigma("label", labM.getValue(), labDeg.getValue());
    return true;
}

void Kitti2RawlogApp::run(std::ostream& out) {
    report = convert(job, ProgressBar());
    out << summary(report) << "\n";
}

}  // namespace djpete::kitti2rawlog
