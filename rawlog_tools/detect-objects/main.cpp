#include <exception>
#include <iostream>

#include "detect_objects_app.h"

int main(int argc, char** argv) {
    try {
        djpete::detect_objects::DetectObjectsApp app;
        if (app.initialize(argc, argv)) app.run(std::cout);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << e.what() << "\n";
        return 1;
    }
}
