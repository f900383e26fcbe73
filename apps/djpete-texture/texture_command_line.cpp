#include "texture_command_line.h"

#include <mrpt/3rdparty/tclap/MultiSwitchArg.h>

#include <functional>

#include "djpete/obs/errors.h"
#include "djpete/texture/region.h"
#include "djpete_app/command_line.h"

namespace djpete::apps {

namespace {

using obs::InputError;
using StringsArg = TCLAP::MultiArg<std::string>;
using FlagArg = TCLAP::MultiSwitchArg<>;

/// Remembers in which order the options came.
class Order : public TCLAP::Visitor {
  public:
    Order(std::vector<std::string>& order, std::string name)
        : order_(order), name_(std::move(name)) {}
    void visit() override { order_.push_back(name_); }

  private:
    std::vector<std::string>& order_;
    std::string name_;
};

constexpr const char* kRegion =
    "Where the edit before it works: terms joined by '&', each 'box x0:x1,y0:y1,z0:z1', 'sphere "
    "x,y,z,r', 'normal dx,dy,dz,max_deg' or 'colour r0:r1,g0:g1,b0:b1', 'not' before it turns it "
    "round; metres in the object's frame (x ahead, y left, z up, origin in the middle)";

struct CommandLine {
    CommandLineOutput output;
    TCLAP::CmdLine cmd{
        "Completes, edits and exports textured objects. Edits are kept in the .object file beside "
        "the original, which stays; they are done in the order given here",
        ' ', "0.1.0"};
    std::vector<std::string> order;
    Order recolourCame{order, "recolour"}, brushCame{order, "brush"},
        symmetriseCame{order, "symmetrise"}, fillCame{order, "fill"}, smoothCame{order, "smooth"},
        cropCame{order, "crop"}, keepCame{order, "keep"}, denoiseCame{order, "denoise"},
        replaceCame{order, "replace-from"}, regionCame{order, "region"};

    TCLAP::UnlabeledMultiArg<std::string> files{
        "input", "An .object file, or a result folder of djpete-slam for all of its objects", true,
        "FILE.object|FOLDER", cmd};
    StringsArg recolour{"",
                        "recolour",
                        "Paint in another colour; light and shade stay, panes and tyres too where "
                        "djpete-slam told them apart (0..255)",
                        false,
                        "R,G,B",
                        cmd,
                        &recolourCame};
    StringsArg brush{"",  "brush",   "One flat colour, best with --region (0..255)", false, "R,G,B",
                     cmd, &brushCame};
    FlagArg symmetrise{
        "", "symmetrise",   "Give unseen parts the points and colours of the other side", cmd,
        0,  &symmetriseCame};
    FlagArg fill{"",  "fill", "Give points without a colour that of their neighbours",
                 cmd, 0,      &fillCame};
    FlagArg smooth{"",  "smooth", "Smooth colours along the surface; edges of colour stay",
                   cmd, 0,        &smoothCame};
    FlagArg crop{"", "crop", "Remove the points in --region", cmd, 0, &cropCame};
    FlagArg keep{"", "keep", "Remove the points outside of --region", cmd, 0, &keepCame};
    FlagArg denoise{
        "",  "denoise", "Remove points far from all others, correct odd colours of few samples",
        cmd, 0,         &denoiseCame};
    StringsArg replace{
        "",          "replace-from", "Take another object's colours at the same places of its box",
        false,       "FILE.object",  cmd,
        &replaceCame};
    StringsArg region{"", "region", kRegion, false, "REGION", cmd, &regionCame};
    FlagArg undo{"", "undo",
                 "Take back the last edit in the file, before new ones; repeat for more", cmd};
    TCLAP::ValueArg<std::string> out{
        "",    "out", "Write here instead (of a folder: a folder for its .object files)",
        false, "",    "FILE.object|FOLDER",
        cmd};
    TCLAP::SwitchArg list{"", "list", "Print the edits in the file", cmd, false};
    TCLAP::SwitchArg albedo{
        "", "albedo",
        "Exports and pictures show the albedo: what the surface is without sun and shade", cmd,
        false};
    TCLAP::SwitchArg closed{
        "", "closed",
        "Surfaces of --export are closed: parts that nothing saw are made up, smoothly", cmd,
        false};
    StringsArg meshes{"",
                      "export",
                      "Write the surface: .ply (colours per vertex), .obj (with .mtl, .png) or "
                      ".glb; of several objects as NAME_NNNN",
                      false,
                      "FILE",
                      cmd};
    StringsArg points{"",    "export-points", "Write the points with normals and colours",
                      false, "FILE.ply",      cmd};
    TCLAP::ValueArg<std::string> pictures{
        "",    "pictures", "Write a picture of each edit in the file, before and after", false, "",
        "DIR", cmd};

    CommandLine() {
        delete cmd.getOutput();  // setOutput() forgets the default one
        cmd.setOutput(&output);
    }

    std::vector<DjpeteTextureApp::WantedEdit> edits();
    DjpeteTextureApp::Settings settings();
};

std::vector<DjpeteTextureApp::WantedEdit> CommandLine::edits() {
    std::vector<DjpeteTextureApp::WantedEdit> wanted;
    std::size_t recolours = 0, brushes = 0, replaced = 0, regions = 0;
    for (const auto& name : order) {
        if (name == "region") {
            const std::string& text = region.getValue()[regions++];
            if (wanted.empty()) {
                throw InputError("command line: --region '" + text +
                                 "' belongs to the edit before it; expected an edit first");
            }
            static_cast<void>(texture::Region(text));  // told now if it is wrong
            wanted.back().region += (wanted.back().region.empty() ? "" : " & ") + text;
            continue;
        }
        wanted.push_back({name, "", ""});
        if (name == "recolour") wanted.back().parameters = recolour.getValue()[recolours++];
        if (name == "brush") wanted.back().parameters = brush.getValue()[brushes++];
        if (name == "replace-from") wanted.back().parameters = replace.getValue()[replaced++];
        if (name == "keep") wanted.back() = {"crop", "keep", ""};
        if (name == "crop") wanted.back().parameters = "remove";
    }
    return wanted;
}

DjpeteTextureApp::Settings CommandLine::settings() {
    const auto& words = files.getValue();
    for (const auto& word : words) {
        if (word.rfind("-", 0) == 0) {
            throw InputError("command line: unknown option " + word + "; see --help");
        }
    }
    if (words.size() != 1) {
        throw InputError("command line: expected one .object file or result folder, got " +
                         std::to_string(words.size()) + " ('" + words[0] + "', '" + words[1] +
                         "' ...); see --help");
    }
    DjpeteTextureApp::Settings s;
    s.input = words.front();
    s.out = out.getValue();
    if (out.isSet() && s.out.empty()) {
        throw InputError("command line: --out expected a file or folder, got ''");
    }
    s.edits = edits();
    s.undo = static_cast<std::size_t>(undo.getValue());
    s.list = list.getValue();
    s.albedo = albedo.getValue();
    s.closed = closed.getValue();
    s.meshes = meshes.getValue();
    s.points = points.getValue();
    s.pictures = pictures.getValue();
    return s;
}

}  // namespace

std::optional<DjpeteTextureApp::Settings> parseTextureCommandLine(int argc,
                                                                  const char* const* argv) {
    CommandLine line;
    if (!line.cmd.parse(argc, const_cast<const char**>(argv))) return std::nullopt;
    return line.settings();
}

}  // namespace djpete::apps
