#include <exception>
#include <iostream>

#include "djpete_eval_app.h"

int main(int argc, const char** argv) {
    try {
        djpete::apps::DjpeteEvalApp app;
        if (app.initialize(argc, argv)) app.run(std::cout);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete-eval: " << e.what() << std::endl;
        return 1;
    }
}
