#include "eval_command_line.h"

#include <cctype>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_app/command_line.h"
#include "many_values.h"

namespace djpete::apps {

using namespace evaluation;
using obs::InputError;

namespace {

using StringArg = TCLAP::ValueArg<std::string>;
using StringsArg = TCLAP::MultiArg<std::string>;

std::optional<std::string> valueOf(StringArg& arg) {
    if (!arg.isSet()) return std::nullopt;
    return arg.getValue();
}

std::set<obs::ObjectClass> parseClasses(const std::string& text) {
    std::set<obs::ObjectClass> classes;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) {
        const auto c = obs::objectClassFromString(word);
        std::string lower = word;
        for (char& letter : lower) {
            letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
        }
        if (c == obs::ObjectClass::Other && lower != "misc") {
            throw InputError("classes '" + text + "': '" + word +
                             "' is not one of Car, Van, Truck, Pedestrian, Cyclist, Tram, Misc");
        }
        classes.insert(c);
    }
    if (classes.empty()) throw InputError("classes '" + text + "': expected e.g. Car,Van,Truck");
    return classes;
}

struct CommandLine {
    CommandLineOutput output;
    TCLAP::CmdLine cmd{
        "djpete-eval: how well a trajectory, map objects or tracked boxes agree with the truth",
        ' ', "0.1.0"};
    StringArg trajectory{"t",    "trajectory", "Estimated poses: KITTI 3x4 rows, or TUM", false, "",
                         "FILE", cmd};
    StringArg truth{"g",   "truth", "True poses of the same camera: KITTI 3x4 rows, or TUM",
                    false, "",      "POSES",
                    cmd};
    StringArg range{"r",
                    "range",
                    "Frames A..B-1 of the truth; the estimate has a row for each of these, or for "
                    "every frame from 0",
                    false,
                    "",
                    "A:B",
                    cmd};
    TCLAP::SwitchArg json{"j", "json", "Print one JSON object instead of a table", cmd, false};
    StringArg objects{"o",    "objects", "objects.csv of the same run as the trajectory", false, "",
                      "FILE", cmd};
    StringsArg labels{"l",
                      "labels",
                      "KITTI tracking labels (label_02); with --tracking several files or folders",
                      false,
                      "FILE",
                      cmd};
    StringsArg tracking{"",
                        "tracking",
                        "Tracked cars in rows like the labels' with a score: files or folders of "
                        "NNNN.txt, one per drive; --trajectory is not needed then",
                        false,
                        "FILE",
                        cmd};
    StringsArg ablation{"",
                        "ablation",
                        "Folders of off/, worker/ and joint/, results of djpete-slam with objects "
                        "in these modes, beside truth.txt and (if there are any) labels.txt",
                        false,
                        "FOLDER",
                        cmd};
    StringArg figures{
        "",    "figures", "Draw pictures like the paper's into this folder, from --result",
        false, "",        "DIR",
        cmd};
    StringArg result{"",    "result", "Result folder of djpete-slam, for --figures", false, "",
                     "DIR", cmd};
    TCLAP::SwitchArg bev{"", "bev", "Compare tracked boxes as seen from above, not volumes", cmd,
                         false};
    StringArg loops{
        "",    "loops", "loops.csv of the same run: were all revisits of --truth found?",
        false, "",      "FILE",
        cmd};
    StringArg textures{
        "",    "textures", "Result folder of djpete-slam: how good are the objects' textures?",
        false, "",         "FOLDER",
        cmd};
    StringArg silhouettes{"",
                          "silhouettes",
                          "Result folder of djpete-slam: do the silhouettes of its textured "
                          "vehicles fit the masks of --drive, in frames that made no texture?",
                          false,
                          "",
                          "FOLDER",
                          cmd};
    StringArg drive{
        "",
        "drive",
        "With --textures: the folder of simulate-drive --meshes. With --silhouettes: the "
        "rawlog of detections with masks or boxes. With --figures: the rawlog of "
        "--result, for figures that show images, scans or its truth",
        false,
        "",
        "PATH",
        cmd};
    StringArg rawlog{"",
                     "rawlog",
                     "Rawlog of the drive, if it is not FOLDER.rawlog of --drive (with "
                     "--silhouettes: NAME.rawlog "
                     "of NAME_masks.rawlog or NAME_objects.rawlog)",
                     false,
                     "",
                     "FILE",
                     cmd};
    TCLAP::SwitchArg rebuild{"", "rebuild",
                             "With --textures: make the textures again from the drive's rawlog, "
                             "also if the result has .object files",
                             cmd, false};
    StringArg strips{
        "",
        "strips",
        "With --textures or --silhouettes: write a picture of each object into this folder",
        false,
        "",
        "FOLDER",
        cmd};
    StringArg curve{"",
                    "curve",
                    "With --textures: build them again view by view and write the errors after "
                    "each view, and a plot as FILE.png",
                    false,
                    "",
                    "FILE.csv",
                    cmd};
    StringArg disturb{"",
                      "disturb",
                      "With --textures: shift and turn every pose of an object by so much before "
                      "its texture is made, e.g. 0.2,3. With --silhouettes: before it is drawn",
                      false,
                      "",
                      "M,DEG",
                      cmd};
    StringArg classes{"c",   "classes",       "Classes of labels that should be found",
                      false, "Car,Van,Truck", "LIST",
                      cmd};
    TCLAP::ValueArg<double> maxRange{
        "m", "max-range", "Only labels within so many metres of the camera", false, 0, "M", cmd};
    TCLAP::SwitchArg staticOnly{"", "static-only",
                                "Only labelled objects that stand still by --truth", cmd, false};
    TCLAP::SwitchArg movingOnly{"", "moving-only", "Only labelled objects that move by --truth",
                                cmd, false};
    TCLAP::ValueArg<double> staticBelow{
        "",
        "static-below",
        "A labelled object stands still if it never is so many metres from where it started",
        false,
        0.5,
        "M",
        cmd};
    TCLAP::ValueArg<int> revisitGap{"",
                                    "revisit-gap",
                                    "A standing object that is not labelled for so many frames is "
                                    "seen again after them",
                                    false,
                                    50,
                                    "FRAMES",
                                    cmd};
    TCLAP::SwitchArg worldFromTruth{
        "", "world-from-truth",
        "Place labels in the world with the true cameras, not the estimated ones", cmd, false};

    CommandLine() {
        delete cmd.getOutput();  // setOutput() forgets the default one
        cmd.setOutput(&output);
    }
    EvalSettings settings();
};

EvalSettings CommandLine::settings() {
    EvalSettings s;
    s.trajectoryFile = trajectory.getValue();
    s.truthFile = valueOf(truth);
    s.objectsFile = valueOf(objects);
    s.labelsFiles = labels.getValue();
    s.trackingFiles = tracking.getValue();
    s.ablationFolders = ablation.getValue();
    if (bev.getValue()) s.trackingCriteria.overlap = OverlapKind::BirdsEye;
    s.loopsFile = valueOf(loops);
    s.textures.resultFolder = textures.getValue();
    if (textures.isSet()) s.textures.driveFolder = drive.getValue();
    s.textures.curveFile = curve.getValue();
    s.textures.rebuild = rebuild.getValue();
    s.silhouettes.resultFolder = silhouettes.getValue();
    Disturbance disturbance;
    if (disturb.isSet()) disturbance = parseDisturbance(disturb.getValue());
    if (silhouettes.isSet()) {
        s.silhouettes.detections = drive.getValue();
        s.silhouettes.rawlog = valueOf(rawlog);
        s.silhouettes.stripFolder = strips.getValue();
        s.silhouettes.disturbance = disturbance;
    } else {
        s.textures.rawlog = valueOf(rawlog);
        s.textures.stripFolder = strips.getValue();
        s.textures.disturbance = disturbance;
    }
    if (range.isSet()) s.range = parseFrameRange(range.getValue());
    s.json = json.getValue();
    // Textures and silhouettes have a drive of their own.
    const bool ownDrive = textures.isSet() || silhouettes.isSet();
    const auto figuresDrive = ownDrive ? std::nullopt : valueOf(drive);
    s.figures = figureRequest(valueOf(figures), valueOf(result), figuresDrive, s.truthFile);
    s.worldFromTruth = worldFromTruth.getValue();
    s.criteria.classes = parseClasses(classes.getValue());
    if (maxRange.isSet()) s.criteria.maxRange_m = maxRange.getValue();
    if (maxRange.isSet() && !(maxRange.getValue() > 0)) {
        throw InputError("command line: expected --max-range above 0");
    }
    s.criteria.staticBelow_m = staticBelow.getValue();
    if (!(s.criteria.staticBelow_m > 0)) {
        throw InputError("command line: expected --static-below above 0");
    }
    if (revisitGap.getValue() < 1) {
        throw InputError("command line: expected --revisit-gap above 0");
    }
    s.criteria.minGapFrames = static_cast<std::size_t>(revisitGap.getValue());
    if (staticOnly.getValue() && movingOnly.getValue()) {
        throw InputError("command line: --static-only and --moving-only exclude each other");
    }
    if (staticOnly.getValue()) s.criteria.motion = MotionSelection::StaticOnly;
    if (movingOnly.getValue()) s.criteria.motion = MotionSelection::MovingOnly;
    return s;
}

}  // namespace

std::optional<EvalSettings> parseCommandLine(int argc, const char** argv) {
    CommandLine line;
    const auto words = repeatOptions(argc, argv, {"--labels", "-l", "--tracking", "--ablation"});
    std::vector<const char*> pointers;
    for (const auto& word : words) pointers.push_back(word.c_str());
    if (!line.cmd.parse(static_cast<int>(pointers.size()), pointers.data())) return std::nullopt;
    return line.settings();
}

}  // namespace djpete::apps
