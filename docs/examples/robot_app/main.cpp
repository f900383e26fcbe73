/// How a robot links object-level SLAM: hand over observations, receive frames and objects.
/// Here a rawlog plays the robot's sensors (MRPT's reader ends at the first damaged entry); a real
/// one would call processObservation() from its drivers.
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>

#include <exception>
#include <filesystem>
#include <iostream>

#include "djpete/obs/errors.h"
#include "djpete/observers/geometric_observer.h"
#include "djpete/pipeline/live_object_slam.h"

namespace {

using namespace djpete;

void deliver(const std::filesystem::path& rawlog, pipeline::LiveObjectSlam& slam) {
    if (!std::filesystem::is_regular_file(rawlog)) {
        throw obs::InputError(rawlog.string() + ": no such rawlog");
    }
    const auto images = std::filesystem::absolute(rawlog).replace_extension().string() + "_Images";
    mrpt::io::setLazyLoadPathBase(images);
    mrpt::io::CFileGZInputStream file(rawlog.string());
    auto archive = mrpt::serialization::archiveFrom(file);
    mrpt::obs::CActionCollection::Ptr action;
    mrpt::obs::CSensoryFrame::Ptr together;
    mrpt::obs::CObservation::Ptr single;
    std::size_t entry = 0;
    while (mrpt::obs::CRawlog::getActionObservationPairOrObservation(archive, action, together,
                                                                     single, entry)) {
        if (single) slam.processObservation(single);
        if (!together) continue;
        for (const auto& observation : *together) slam.processObservation(observation);
    }
}

void print(const map::SlamMap& map) {
    for (const auto& [id, object] : map.objects()) {
        const geometry::Vec3 p_world =
            map.T_world_obj(object.states.rbegin()->second).translation();
        std::cout << "object " << id.value << ": " << obs::toString(object.objectClass)
                  << (object.moving ? ", moving" : "") << ", size " << object.size_m.transpose()
                  << " m, at " << p_world.transpose() << " m\n";
    }
}

int run(const std::string& ini, const std::filesystem::path& rawlog) {
    obs::registerObservationClasses();
    const auto options = pipeline::ObjectSlamOptions::fromFile(ini);
    pipeline::LiveOptions live;
    live.block = true;  // a rawlog can wait; on a robot leave it false
    pipeline::LiveObjectSlam slam(
        options, std::make_unique<observers::GeometricObserver>(options.geometric), live);
    slam.onFrame([](const pipeline::FrameOutcome& outcome, const map::MapSnapshot& map) {
        std::cout << "frame " << outcome.frame.value << (outcome.tracked ? "" : " LOST") << ": "
                  << map->objects().size() << " objects\n";
    });
    deliver(rawlog, slam);
    slam.shutdown();
    print(*slam.snapshot());
    if (!slam.error()) return 0;
    std::cerr << "robot_app: " << *slam.error() << std::endl;
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 3) return run(argv[1], argv[2]);
        std::cerr << "usage: robot_app CONFIG.ini DRIVE.rawlog" << std::endl;
    } catch (const std::exception& e) {
        std::cerr << "robot_app: " << e.what() << std::endl;
    }
    return 1;
}
