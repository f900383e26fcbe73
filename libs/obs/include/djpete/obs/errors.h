/// Bad input, told in one sentence.
#pragma once

#include <stdexcept>
#include <string>

namespace djpete::obs {

/// Input that cannot be used. The message is one sentence that names the file, line or frame and
/// says what was expected. Only mains catch it; they print it and exit with 1.
class InputError : public std::runtime_error {
  public:
    explicit InputError(const std::string& sentence) : std::runtime_error(sentence) {}
};

}  // namespace djpete::obs
