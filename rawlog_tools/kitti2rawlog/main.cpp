#include <exception>
#include <iostream>

#include "kitti2rawlog_app.h"

int main(int argc, char** argv) {
    try {
        djpete::kitti2rawlog::Kitti2RawlogApp app;
        if (app.initialize(argc, argv)) app.run(std::cout);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << e.what() << "\n";
        return 1;
    }
}
