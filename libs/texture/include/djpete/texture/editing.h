/// Changes of object models by hand. The original stays in the file; edits are replayed.
#pragma once

#include <string>
#include <vector>

#include "djpete/texture/object_file.h"

namespace djpete::texture {

/// What an edit did, in a sentence for people.
struct EditReport {
    std::size_t changed = 0, added = 0, removed = 0;  ///< points
    std::string text;                                 ///< "1204 points changed; ..."
};

/// The model after one edit; the given one stays as it is. Points that an edit changed or added are
/// flagged kEdited (flags of symmetrise and fill are those of completion.h). By name; [] may be
/// left out of the parameters:
///   recolour R,G,B          paint in another colour, light and shade stay
///   brush R,G,B             one flat colour
///   symmetrise              see completion.h
///   fill                    see completion.h
///   smooth [PASSES]         colours go over into alike neighbours, edges stay; 2 passes
///   crop [remove|keep]      removes the region's points, or all others
///   denoise [SIGMAS]        removes points far from others (2.5), corrects colours of few samples
///   replace-from [NAME]     colours of the embedded object at the same place, scaled by the sizes
/// Only points of the edit's region (see region.h) change, or are removed or added.
/// Throws obs::InputError with one sentence that says what was expected.
ObjectModel apply(const ObjectModel& model, const Edit& edit, EditReport* report = nullptr);

/// The original with all edits, in order. Errors name the number of the edit.
ObjectModel replay(const SavedObject& object);

/// A replace-from edit that holds what it needs of the other model.
Edit replaceFrom(const ObjectModel& other, const std::string& name, const std::string& region = "");

/// All names, in the order above.
std::vector<std::string> editNames();

}  // namespace djpete::texture
