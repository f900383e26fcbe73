#include "djpete/texture/editing.h"

#include <algorithm>
#include <functional>
#include <map>

#include "djpete/obs/errors.h"
#include "djpete/texture/completion.h"
#include "djpete/texture/region.h"
#include "edit_colours.h"
#include "edit_points.h"

namespace djpete::texture {

namespace {

using obs::InputError;
using Action = std::function<void(ObjectModel&, const Edit&, const Region&)>;

void requireNoParameters(const Edit& edit) {
    if (edit.parameters.empty()) return;
    throw InputError("edit '" + edit.name + "' takes no parameters, got '" + edit.parameters + "'");
}

void requireNoRegion(const Edit& edit, const Region& region) {
    if (region.everywhere()) return;
    throw InputError("edit '" + edit.name + "' is for the whole object, got the region '" +
                     edit.region + "'");
}

ObjectModel kept(const ObjectModel& model, const Region& region, bool inside) {
    std::vector<bool> keep(model.size());
    for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = region.contains(model, i) == inside;
    return model.subset(keep);
}

void crop(ObjectModel& model, const Edit& edit, const Region& region) {
    requireNoParameters(edit);
    if (region.everywhere()) {
        throw InputError("edit '" + edit.name + "' needs a region, else nothing would be left");
    }
    model = kept(model, region, edit.name == "keep");
}

const std::map<std::string, Action>& actions() {
    static const std::map<std::string, Action> all{
        {"recolour", [](ObjectModel& m, const Edit& e,
                        const Region& r) { recolour(m, parseColour(e.parameters), r); }},
        {"brush", [](ObjectModel& m, const Edit& e,
                     const Region& r) { brush(m, parseColour(e.parameters), r); }},
        {"smooth",
         [](ObjectModel& m, const Edit& e, const Region& r) {
             const double reach =
                 parseNumbers(e.parameters, 1, "metres above 0 and up to 1, e.g. 0.1").front();
             if (!(reach > 0 && reach <= 1)) {
                 throw InputError("'" + e.parameters + "': expected metres above 0 and up to 1");
             }
             smoothColours(m, reach, r);
         }},
        {"crop", crop},
        {"keep", crop},
        {"denoise",
         [](ObjectModel& m, const Edit& e, const Region& r) {
             requireNoParameters(e);
             denoise(m, r);
         }},
        {"symmetrise",
         [](ObjectModel& m, const Edit& e, const Region& r) {
             requireNoParameters(e);
             requireNoRegion(e, r);
             symmetrise(m);
         }},
        {"fill",
         [](ObjectModel& m, const Edit& e, const Region& r) {
             requireNoParameters(e);
             requireNoRegion(e, r);
             fillColours(m);
         }},
        {"replace", [](ObjectModel& m, const Edit& e, const Region& r) {
             requireNoParameters(e);
             replaceColours(m, unpackObject(e.embeddedObject, "the object to replace from"), r);
         }}};
    return all;
}

}  // namespace

ObjectModel applied(const ObjectModel& model, const Edit& edit) {
    const auto action = actions().find(edit.name);
    if (action == actions().end()) {
        std::string names;
        for (const auto& [name, does] : actions()) names += (names.empty() ? "" : ", ") + name;
        throw InputError("no edit '" + edit.name + "'; expected one of " + names);
    }
    const Region region = Region::parse(edit.region);
    ObjectModel out = model.clone();
    if (!out.cloud) out.cloud = mrpt::maps::CColouredPointsMap::Create();
    action->second(out, edit, region);
    return out;
}

ObjectModel replayed(const SavedObject& object) {
    ObjectModel model = object.original.clone();
    for (const Edit& edit : object.edits) model = applied(model, edit);
    return model;
}

}  // namespace djpete::texture
