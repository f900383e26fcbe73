#include <exception>
#include <iostream>

#include "simulate_drive_app.h"

int main(int argc, char** argv) {
    try {
        djpete::apps::SimulateDriveApp app;
        if (app.initialize(argc, argv)) app.run(std::cout);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "simulate-drive: " << e.what() << std::endl;
        return 1;
    }
}
