#include "djpete/texture/editing.h"

#include <cmath>
#include <map>

#include "djpete/obs/errors.h"
#include "edits.h"
#include "parameters.h"

namespace djpete::texture {

namespace {

using obs::InputError;

struct Step {
    ObjectModel& model;
    const Edit& edit;
    const Region& region;
    const Mask& in;
    EditReport& report;
};

void noParameters(const Step& s) {
    if (!trimmed(s.edit.parameters).empty()) {
        throwExpected(s.edit.name, "no parameters", s.edit.parameters);
    }
}

void runSmooth(const Step& s) {
    unsigned passes = 2;
    if (!trimmed(s.edit.parameters).empty()) {
        const std::string expected = "a number of passes, 1 to 50";
        const double value = numberOf(s.edit.parameters, s.edit.name, expected);
        if (value < 1 || value > 50 || value != std::floor(value)) {
            throwExpected(s.edit.name, expected, s.edit.parameters);
        }
        passes = static_cast<unsigned>(value);
    }
    smoothColours(s.model, s.in, passes, s.report);
}

void runCrop(const Step& s) {
    const std::string how = trimmed(s.edit.parameters);
    if (!how.empty() && how != "remove" && how != "keep") {
        throwExpected(s.edit.name, "'remove' or 'keep'", s.edit.parameters);
    }
    if (s.region.everything()) {
        throw InputError("crop: expected a region that says what is removed or kept");
    }
    crop(s.model, s.in, how == "keep", s.report);
}

void runDenoise(const Step& s) {
    double sigmas = 2.5;
    if (!trimmed(s.edit.parameters).empty()) {
        const std::string expected = "a number of standard deviations, 0.5 to 20";
        sigmas = numberOf(s.edit.parameters, s.edit.name, expected);
        if (sigmas < 0.5 || sigmas > 20) throwExpected(s.edit.name, expected, s.edit.parameters);
    }
    denoise(s.model, s.in, sigmas, s.report);
}

void runReplace(const Step& s) {
    if (s.edit.embeddedObject.empty()) {
        throw InputError("replace-from: expected an edit that holds the other object");
    }
    const ObjectModel other =
        unpackObject(s.edit.embeddedObject, "the object kept in replace-from");
    if (!(other.size_m.minCoeff() > 0 && s.model.size_m.minCoeff() > 0)) {
        throw InputError("replace-from: expected two objects with sizes above 0");
    }
    replaceColours(s.model, s.in, other, s.report);
}

struct Kind {
    const char* name;
    void (*run)(const Step&);
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all{
        {"recolour",
         [](const Step& s) {
             recolour(s.model, s.in, colourOf(s.edit.parameters, s.edit.name), s.report);
         }},
        {"brush",
         [](const Step& s) {
             brush(s.model, s.in, colourOf(s.edit.parameters, s.edit.name), s.report);
         }},
        {"symmetrise",
         [](const Step& s) {
             noParameters(s);
             symmetriseWithin(s.model, s.in, s.region, s.report);
         }},
        {"fill",
         [](const Step& s) {
             noParameters(s);
             fillWithin(s.model, s.in, s.report);
         }},
        {"smooth", runSmooth},
        {"crop", runCrop},
        {"denoise", runDenoise},
        {"replace-from", runReplace},
    };
    return all;
}

std::string counted(std::size_t points, const char* what) {
    return std::to_string(points) + (points == 1 ? " point " : " points ") + what;
}

std::string sentenceOf(const EditReport& report) {
    std::string out;
    const auto add = [&](const std::string& part) { out += (out.empty() ? "" : ", ") + part; };
    if (report.added > 0) add(counted(report.added, "added"));
    if (report.removed > 0) add(counted(report.removed, "removed"));
    if (report.changed > 0) add(counted(report.changed, "changed"));
    if (out.empty()) out = "nothing to change";
    return report.text.empty() ? out : out + "; " + report.text;
}

}  // namespace

ObjectModel apply(const ObjectModel& model, const Edit& edit, EditReport* report) {
    for (const Kind& kind : kinds()) {
        if (edit.name != kind.name) continue;
        const Region region(edit.region);
        Mask in(model.size());
        for (std::size_t i = 0; i < model.size(); ++i) in[i] = region.contains(model, i);
        ObjectModel out = model.clone();
        EditReport done;
        kind.run({out, edit, region, in, done});
        done.text = sentenceOf(done);
        if (report != nullptr) *report = done;
        return out;
    }
    std::string names;
    for (const auto& name : editNames()) names += (names.empty() ? "" : ", ") + name;
    throwExpected("edit", "one of " + names, edit.name);
}

ObjectModel replay(const SavedObject& object) {
    ObjectModel model = object.original.clone();
    for (std::size_t k = 0; k < object.edits.size(); ++k) {
        try {
            model = apply(model, object.edits[k]);
        } catch (const InputError& e) {
            throw InputError("edit " + std::to_string(k + 1) + " of object " +
                             std::to_string(object.original.id.value) + ": " + e.what());
        }
    }
    return model;
}

Edit replaceFrom(const ObjectModel& other, const std::string& name, const std::string& region) {
    Mask coloured;
    for (const ColourSum& sum : other.colours) coloured.push_back(sum.count > 0);
    ObjectModel needed = other.subset(coloured);
    if (needed.size() == 0) {
        throw InputError("replace-from " + name + ": expected an object with coloured points");
    }
    needed.freeSpace = {};
    return {"replace-from", name, region, packObject(needed)};
}

std::vector<std::string> editNames() {
    std::vector<std::string> out;
    for (const Kind& kind : kinds()) out.emplace_back(kind.name);
    return out;
}

}  // namespace djpete::texture
