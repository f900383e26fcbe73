#include "djpete/texture/object_file.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <cstdio>

#include "djpete/obs/checked_file.h"
#include "djpete/obs/errors.h"

namespace djpete::texture {

namespace {

using mrpt::serialization::CArchive;
using obs::InputError;

const obs::CheckedFileKind& kind() {
    static const obs::CheckedFileKind k{
        {'D', 'J', 'P', 'E', 'T', 'O', 'B', 'J'}, kObjectFileVersion, "object file", ".object"};
    return k;
}

/// What the archive says does not fit together.
class Damaged : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

template <class T>
void writeAll(CArchive& out, const std::vector<T>& values) {
    out << static_cast<uint64_t>(values.size());
    if (!values.empty()) out.WriteBuffer(values.data(), values.size() * sizeof(T));
}

/// `left`: bytes of the archive that have not been read yet; a longer vector is not there.
template <class T>
std::vector<T> readAll(CArchive& in, std::size_t left) {
    uint64_t size = 0;
    in >> size;
    if (size > left / sizeof(T)) throw Damaged("the content ends too early");
    std::vector<T> values(static_cast<std::size_t>(size));
    if (size > 0) in.ReadBuffer(values.data(), values.size() * sizeof(T));
    return values;
}

static_assert(sizeof(ColourSum) == 32 && std::is_trivially_copyable_v<ColourSum>);
static_assert(sizeof(obs::FrameId) == 8 && std::is_trivially_copyable_v<obs::FrameId>);

void write(CArchive& out, const ObjectModel& m) {
    out << m.id.value << static_cast<uint32_t>(m.objectClass);
    for (int i = 0; i < 3; ++i) out << m.size_m[i];
    out.WriteObject(m.cloud.get());
    writeAll(out, m.colours);
    writeAll(out, m.normals);
    writeAll(out, m.radius_m);
    writeAll(out, m.flags);
    writeAll(out, m.seenIn);
    writeAll(out, m.albedo);
    writeAll(out, m.views);
    for (const float low : m.freeSpace.low_m) out << low;
    for (const uint16_t cells : m.freeSpace.cells) out << cells;
    writeAll(out, m.freeSpace.passed);
    writeAll(out, m.freeSpace.hits);
}

void requireFinite(const ObjectModel& m) {
    for (std::size_t i = 0; i < m.size(); ++i) {
        for (const auto& v : {m.point(i), m.normals[i], m.colours[i].mean}) {
            for (const float c : v) {
                if (!std::isfinite(c)) {
                    throw Damaged("point " + std::to_string(i) + " has no numbers");
                }
            }
        }
        if (!(m.radius_m[i] > 0 && m.radius_m[i] < 100)) {
            throw Damaged("point " + std::to_string(i) + " has no radius");
        }
    }
}

void requireConsistent(const ObjectModel& m) {
    const std::size_t n = m.cloud->size();
    if (m.colours.size() != n || m.normals.size() != n || m.radius_m.size() != n ||
        m.flags.size() != n || m.seenIn.size() != n ||
        (!m.albedo.empty() && m.albedo.size() != n)) {
        throw Damaged("its lists are not as long as its cloud");
    }
    if (m.views.size() > ObjectModel::kMaxViews) throw Damaged("it has too many views");
    const auto& f = m.freeSpace;
    const std::size_t cells = std::size_t{f.cells[0]} * f.cells[1] * f.cells[2];
    if (f.passed.size() != f.hits.size() || (!f.empty() && f.passed.size() != cells)) {
        throw Damaged("its free space is not as large as it says");
    }
    if (!m.size_m.allFinite()) throw Damaged("its size has no numbers");
    requireFinite(m);
}

/// Layout 1 had no albedo.
ObjectModel readModel(CArchive& in, mrpt::io::CMemoryStream& stream, uint32_t version) {
    const auto left = [&] {
        return static_cast<std::size_t>(stream.getTotalBytesCount() - stream.getPosition());
    };
    ObjectModel m;
    uint32_t objectClass = 0;
    in >> m.id.value >> objectClass;
    m.objectClass = static_cast<obs::ObjectClass>(objectClass);
    for (int i = 0; i < 3; ++i) in >> m.size_m[i];
    m.cloud = in.ReadObject<mrpt::maps::CColouredPointsMap>();
    if (!m.cloud) throw Damaged("it has no cloud");
    m.colours = readAll<ColourSum>(in, left());
    m.normals = readAll<std::array<float, 3>>(in, left());
    m.radius_m = readAll<float>(in, left());
    m.flags = readAll<uint8_t>(in, left());
    m.seenIn = readAll<uint32_t>(in, left());
    if (version >= 2) m.albedo = readAll<std::array<uint8_t, 3>>(in, left());
    m.views = readAll<obs::FrameId>(in, left());
    for (float& low : m.freeSpace.low_m) in >> low;
    for (uint16_t& cells : m.freeSpace.cells) in >> cells;
    m.freeSpace.passed = readAll<uint8_t>(in, left());
    m.freeSpace.hits = readAll<uint8_t>(in, left());
    requireConsistent(m);
    return m;
}

std::vector<uint8_t> bytesOf(mrpt::io::CMemoryStream& stream) {
    const auto* begin = static_cast<const uint8_t*>(stream.getRawBufferData());
    return {begin, begin + stream.getTotalBytesCount()};
}

std::vector<uint8_t> pack(const ObjectModel& model, const std::vector<Edit>& edits) {
    mrpt::io::CMemoryStream stream;
    auto out = mrpt::serialization::archiveFrom(stream);
    if (model.cloud) {
        write(out, model);
    } else {
        ObjectModel empty = model;
        empty.cloud = mrpt::maps::CColouredPointsMap::Create();
        write(out, empty);
    }
    out << static_cast<uint64_t>(edits.size());
    for (const Edit& edit : edits) {
        out << edit.name << edit.parameters << edit.region;
        writeAll(out, edit.embeddedObject);
    }
    return bytesOf(stream);
}

SavedObject unpack(const std::vector<uint8_t>& content, const std::string& what, uint32_t version) {
    mrpt::rtti::registerClass(CLASS_ID(mrpt::maps::CColouredPointsMap));
    mrpt::io::CMemoryStream stream;
    stream.assignMemoryNotOwn(content.data(), content.size());
    auto in = mrpt::serialization::archiveFrom(stream);
    try {
        SavedObject object;
        object.original = readModel(in, stream, version);
        uint64_t edits = 0;
        in >> edits;
        for (uint64_t k = 0; k < edits; ++k) {
            Edit edit;
            in >> edit.name >> edit.parameters >> edit.region;
            edit.embeddedObject = readAll<uint8_t>(
                in, static_cast<std::size_t>(stream.getTotalBytesCount() - stream.getPosition()));
            if (version < kObjectFileVersion && !edit.embeddedObject.empty()) {
                edit.embeddedObject =
                    packObject(unpack(edit.embeddedObject, what, version).original);
            }
            object.edits.push_back(std::move(edit));
        }
        if (stream.getPosition() != stream.getTotalBytesCount()) {
            throw Damaged("there is more than an object in it");
        }
        return object;
    } catch (const Damaged& e) {
        throw InputError(what + " is damaged: " + e.what());
    } catch (const std::exception&) {  // of MRPT's archive, over many lines
        throw InputError(what + " is damaged: its content is no object");
    }
}

}  // namespace

void saveObject(const SavedObject& object, const std::filesystem::path& file) {
    obs::writeChecked(kind(), pack(object.original, object.edits), file);
}

SavedObject loadObject(const std::filesystem::path& file) {
    const auto content = obs::readChecked(kind(), file);
    return unpack(content.bytes, "the object file " + file.string(), content.version);
}

std::vector<uint8_t> packObject(const ObjectModel& model) { return pack(model, {}); }

ObjectModel unpackObject(const std::vector<uint8_t>& content, const std::string& what) {
    return unpack(content, what, kObjectFileVersion).original;
}

std::string objectFileName(map::ObjectId object) {
    char name[40];
    std::snprintf(name, sizeof(name), "%04llu.object",
                  static_cast<unsigned long long>(object.value));
    return name;
}

}  // namespace djpete::texture
