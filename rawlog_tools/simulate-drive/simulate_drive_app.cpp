#include "simulate_drive_app.h"

#include <chrono>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <thread>

#include "djpete/evaluation/trajectory_reader.h"
#include "djpete_app/command_line.h"
#include "djpete_app/frame_range.h"
#include "djpete_app/progress_bar.h"
#include "fault_option.h"

namespace djpete::apps {

namespace {

constexpr const char* kHelp =
    "Ray-traces a drive through streets with parked and moving cars and people and writes it in "
    "KITTI's odometry layout, with labels, instance masks, poses, OXTS rows and noisy detections; "
    "the same bytes "
    "for the same seed";

/// "WxH"
void parseSize(const std::string& text, simulator::DriveOptions& options) {
    int w = 0, h = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &rest) != 2 || w < 64 || h < 32 || w > 4096 ||
        h > 4096) {
        throw obs::InputError("--size " + text + ": expected WxH, from 64x32 to 4096x4096");
    }
    options.width_px = w;
    options.height_px = h;
}

double within(const std::string& name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        std::ostringstream o;
        o << "--" << name << " " << value << ": expected " << low << " to " << high;
        throw obs::InputError(o.str());
    }
    return value;
}

}  // namespace

bool SimulateDriveApp::initialize(int argc, const char* const* argv) {
    TCLAP::CmdLine cmd(kHelp, ' ', "0.1.0");
    TCLAP::ValueArg<std::string> out("o", "out", "Folder to write", true, "", "DIR", cmd);
    TCLAP::ValueArg<std::string> frames(
        "f", "frames", "Frames A to B-1 (default 0:100, or all of --poses)", false, "", "A:B", cmd);
    TCLAP::ValueArg<std::string> route("", "route",
                                       "street: a bending street (default); blocks: round city "
                                       "blocks, back to the same places again and again",
                                       false, "street", "street|blocks", cmd);
    TCLAP::ValueArg<std::string> poses("", "poses",
                                       "Build the streets along these camera poses (KITTI "
                                       "odometry or TUM rows) and drive along them",
                                       false, "", "FILE", cmd);
    TCLAP::ValueArg<int> seed("s", "seed", "Which street, cars and noise (default 1)", false, 1,
                              "N", cmd);
    TCLAP::ValueArg<int> trafficSeed(
        "", "traffic-seed",
        "Another drive through the streets of --seed: other moving vehicles, people and sensor "
        "noise, about half of the parked cars others (default 0: the seed's own)",
        false, 0, "N", cmd);
    TCLAP::ValueArg<double> laneOffset("", "lane-offset",
                                       "The own vehicle keeps M metres to the left (+) of its way, "
                                       "-0.5 to 0.8; poses.txt stays in the world of the drive "
                                       "without it (default 0)",
                                       false, 0.0, "M", cmd);
    TCLAP::ValueArg<double> convoy(
        "", "convoy",
        "Vehicles drive with the own one, at its speed, and cover about this share of the left "
        "image, 0 to 0.5 (default 0: none)",
        false, 0.0, "SHARE", cmd);
    TCLAP::ValueArg<double> sun("", "sun-deg",
                                "The sun stands DEG to the left of its usual place (default 0)",
                                false, 0.0, "DEG", cmd);
    TCLAP::ValueArg<double> fog(
        "", "fog",
        "Fog in which one sees M metres far, 10 to 10000: contrast falls to "
        "5 % over it (default: clear air)",
        false, 0.0, "M", cmd);
    TCLAP::SwitchArg plain(
        "", "plain", "Streets, houses and plants in one grey without texture: few features", cmd);
    TCLAP::ValueArg<std::string> size("", "size", "Image size (default 1241x376)", false,
                                      "1241x376", "WxH", cmd);
    TCLAP::ValueArg<double> step("", "step", "Metres per frame (default 0.8)", false, 0.8, "M",
                                 cmd);
    TCLAP::ValueArg<int> threads("", "threads",
                                 "Threads; no influence on the result (default: all cores)", false,
                                 0, "N", cmd);
    TCLAP::SwitchArg resume(
        "", "resume", "Keep the frames that a broken run with the same options completed", cmd);
    TCLAP::SwitchArg noScans("", "no-scans", "No velodyne folder", cmd);
    TCLAP::SwitchArg rawScan("", "raw-scan",
                             "Scans distorted by the motion during their 0.1 s, as the scanner "
                             "gives them (default: all points at the frame's instant)",
                             cmd);
    TCLAP::SwitchArg noColor("", "no-color", "No image_2 and image_3", cmd);
    TCLAP::ValueArg<double> sigmaM("", "detection-sigma-m",
                                   "Sigma of detections.txt per axis, m (default 0.3)", false, 0.3,
                                   "M", cmd);
    TCLAP::ValueArg<double> sigmaDeg("", "detection-sigma-deg",
                                     "Sigma of their heading, degrees (default 5)", false, 5.0,
                                     "DEG", cmd);
    TCLAP::ValueArg<double> miss("", "detection-miss", "Share of objects they miss (default 0)",
                                 false, 0.0, "0..1", cmd);
    TCLAP::ValueArg<double> falseShare(
        "", "detection-false",
        "Share of the rows of detections.txt that are false, 0 to 0.9: boxes of cars where none "
        "is; some stay for two or three frames (default 0)",
        false, 0.0, "SHARE", cmd);
    TCLAP::ValueArg<double> oxtsM("", "oxts-sigma-m",
                                  "Sigma of OXTS positions per axis, m (default 0.03)", false, 0.03,
                                  "M", cmd);
    TCLAP::ValueArg<double> oxtsDeg("", "oxts-sigma-deg",
                                    "Sigma of OXTS roll, pitch and yaw, degrees (default 0.03)",
                                    false, 0.03, "DEG", cmd);
    TCLAP::SwitchArg map("", "map", "Write map.png, the streets from above", cmd);
    TCLAP::ValueArg<double> meshes("", "meshes",
                                   "Write the true shape and albedo of every labelled object, "
                                   "with edges of at most M metres, e.g. 0.02",
                                   false, 0.0, "M", cmd);
    TCLAP::ValueArg<std::string> depth("", "depth",
                                       "Depth pictures of these frames, e.g. 0:10,90:100", false,
                                       "", "A:B[,A:B]", cmd);
    TCLAP::MultiArg<std::string> faults("", "fault", faultHelp(), false, "NAME[=F][@A:B]", cmd);
    CommandLineOutput output;
    cmd.setOutput(&output);
    if (!cmd.parse(argc, const_cast<const char**>(argv))) return false;

    folder = out.getValue();
    if (route.getValue() != "street" && route.getValue() != "blocks")
        throw obs::InputError("--route " + route.getValue() + ": expected street or blocks");
    if (route.isSet() && poses.isSet())
        throw obs::InputError("--route and --poses: expected one of them at most");
    if (route.getValue() == "blocks") options.world.route = simulator::RouteKind::Blocks;
    if (poses.isSet()) {
        options.world.T_first_cam =
            evaluation::startingAtIdentity(evaluation::readTrajectory(poses.getValue()).poses);
    }
    const std::size_t given = options.world.T_first_cam.size();
    const std::string all = "0:" + std::to_string(poses.isSet() ? given : 100);
    const auto range = parseFrameRange(frames.isSet() ? frames.getValue() : all);
    if (poses.isSet() && range.end > given)
        throw obs::InputError("--frames " + frames.getValue() + ": expected an end of at most " +
                              std::to_string(given) + ", the number of poses in " +
                              poses.getValue());
    if (range.end > 1000000)
        throw obs::InputError("--frames " + frames.getValue() +
                              ": expected an end of at most 1000000");
    options.begin = range.begin;
    options.end = range.end;
    options.world.seed = static_cast<uint32_t>(seed.getValue());
    options.world.trafficSeed =
        static_cast<uint32_t>(within("traffic-seed", trafficSeed.getValue(), 0, 1e9));
    options.world.laneOffset_m = within("lane-offset", laneOffset.getValue(), -0.5, 0.8);
    options.world.convoyShare = within("convoy", convoy.getValue(), 0, 0.5);
    options.world.sunTurn_rad = within("sun-deg", sun.getValue(), -360, 360) * M_PI / 180;
    if (fog.isSet()) options.world.visibility_m = within("fog", fog.getValue(), 10, 10000);
    options.world.plain = plain.getValue();
    options.world.frames = range.end;
    options.world.step_m = within("step", step.getValue(), 0.05, 5);
    parseSize(size.getValue(), options);
    options.scans = !noScans.getValue();
    options.colour = !noColor.getValue();
    options.lidar.raw = rawScan.getValue();
    if (options.lidar.raw && !options.scans)
        throw obs::InputError("--raw-scan and --no-scans: expected one of them at most");
    options.map = map.getValue();
    options.resume = resume.getValue();
    const auto n = static_cast<unsigned>(within("threads", threads.getValue(), 0, 256));
    options.threads = n == 0 ? std::max(1U, std::thread::hardware_concurrency()) : n;
    options.detector.sigma_m = within("detection-sigma-m", sigmaM.getValue(), 0, 10);
    options.detector.sigma_rad =
        within("detection-sigma-deg", sigmaDeg.getValue(), 0, 180) * M_PI / 180;
    options.detector.missRate = within("detection-miss", miss.getValue(), 0, 1);
    options.detector.falseShare = within("detection-false", falseShare.getValue(), 0, 0.9);
    options.oxts.position_m = within("oxts-sigma-m", oxtsM.getValue(), 0, 10);
    options.oxts.angle_rad = within("oxts-sigma-deg", oxtsDeg.getValue(), 0, 180) * M_PI / 180;
    if (meshes.isSet()) options.meshTexel_m = within("meshes", meshes.getValue(), 0.002, 1);
    options.depth = parseFrames(depth.getValue());
    options.faults = parseFaults(faults.getValue(), options);
    return true;
}

void SimulateDriveApp::run(std::ostream& out) {
    const auto start = std::chrono::steady_clock::now();
    ProgressBar bar;
    const auto report = simulator::writeDrive(
        options, folder, [&](uint64_t done, uint64_t all) { bar.show(done, all); });
    bar.finish();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    const auto frames = static_cast<double>(options.end - options.begin);
    out << std::fixed << std::setprecision(1) << folder.string() << ": "
        << options.end - options.begin << " frames in " << wall.count() << " s ("
        << std::setprecision(2) << frames / wall.count() << " frames/s)\n"
        << "moving vehicles cover " << std::setprecision(1) << 100 * report.movingShare
        << " % of the left image";
    if (options.world.convoyShare > 0)
        out << " (--convoy asked for " << 100 * options.world.convoyShare << " %)";
    out << "\n";
}

}  // namespace djpete::apps
