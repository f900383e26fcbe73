#include <exception>
#include <iostream>

#include "djpete_slam_app.h"

int main(int argc, char** argv) {
    try {
        djpete::apps::DjpeteSlamApp app;
        return app.initialize(argc, argv) ? app.run() : 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete-slam: " << e.what() << std::endl;
        return 1;
    }
}
