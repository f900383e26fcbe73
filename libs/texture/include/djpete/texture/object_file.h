/// Object models on disk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "djpete/texture/object_model.h"

namespace djpete::texture {

/// One step of editing, as text that a person can read; see editing.h.
struct Edit {
    std::string name;        ///< "recolour"
    std::string parameters;  ///< "200,30,30"
    std::string region;      ///< empty: all of the object
    std::vector<uint8_t>
        embeddedObject;  ///< content of another object's file, if the step needs it
};

/// A model as the drive left it, and what was done to it since. The original is never lost.
struct SavedObject {
    ObjectModel original;
    std::vector<Edit> edits;
};

constexpr uint32_t kObjectFileVersion = 2;

/// Writes a `.object` file: a head and a checksum (obs::writeChecked) around an MRPT archive with
/// the cloud (CColouredPointsMap) and all other fields. The same object gives the same bytes, also
/// after loading. Throws obs::InputError naming the file that cannot be written.
void saveObject(const SavedObject& object, const std::filesystem::path& file);

/// Throws obs::InputError naming the file if it is missing, no object file, damaged or too new.
SavedObject loadObject(const std::filesystem::path& file);

/// The content of an object's file without edits, to be kept in an Edit, and back. `what` names it
/// in the sentence of an obs::InputError.
std::vector<uint8_t> packObject(const ObjectModel& model);
ObjectModel unpackObject(const std::vector<uint8_t>& content, const std::string& what);

/// NNNN.object for an object's id.
std::string objectFileName(map::ObjectId object);

}  // namespace djpete::texture
