/// Editing saved object models: a list of steps over an original that is never lost.
#pragma once

#include "djpete/texture/object_file.h"

namespace djpete::texture {

/// Edits by name; parameters as text, `region` as in region.h:
///
///     recolour    R,G,B     the colour's hue; light and shade stay
///     brush       R,G,B     just this colour
///     symmetrise            what was not seen from the other side (completion.h)
///     fill                  smooth colours where there is none (completion.h)
///     smooth      METRES    colours over neighbours so near, edges stay
///     crop                  removes the region
///     keep                  removes all but the region
///     denoise               stray points go, stray colours take their neighbours'
///     replace               colours of the object in Edit::embeddedObject, box on box
///
/// Changed points are flagged kEdited. Throws obs::InputError saying what was expected on an edit
/// that is not one of these or whose text makes no sense.
ObjectModel applied(const ObjectModel& model, const Edit& edit);

/// The original after all of its edits.
ObjectModel replayed(const SavedObject& object);

}  // namespace djpete::texture
