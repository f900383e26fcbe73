#include <exception>
#include <iostream>

#include "djpete_texture_app.h"

int main(int argc, const char** argv) {
    try {
        djpete::apps::DjpeteTextureApp app;
        if (app.initialize(argc, argv)) app.run(std::cout);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete-texture: " << e.what() << std::endl;
        return 1;
    }
}
