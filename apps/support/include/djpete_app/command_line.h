/// A wrong command line is bad input: one sentence, not a page.
#pragma once

#include <mrpt/3rdparty/tclap/CmdLine.h>

#include <cctype>
#include <string>

#include "djpete/obs/errors.h"

namespace djpete::apps {

/// Give it to TCLAP::CmdLine::setOutput(): failures become obs::InputError; --help and --version
/// print as ever.
class CommandLineOutput : public TCLAP::StdOutput {
  public:
    void failure(TCLAP::CmdLineInterface&, TCLAP::ArgException& e) override {
        std::string sentence = "command line: " + e.error();
        while (std::ispunct(static_cast<unsigned char>(sentence.back())) != 0) sentence.pop_back();
        if (e.argId() != " ") sentence += " (" + e.argId() + ")";
        throw obs::InputError(sentence + "; see --help");
    }
};

}  // namespace djpete::apps
