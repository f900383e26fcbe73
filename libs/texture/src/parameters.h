/// Numbers from the text of an edit.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace djpete::texture {

/// Without blanks at both ends.
std::string trimmed(const std::string& text);
/// The pieces between `separator`s, trimmed; at least one.
std::vector<std::string> pieces(const std::string& text, char separator);
/// Throws obs::InputError "what: expected `expected`, got 'text'" if it is not one finite number.
double numberOf(const std::string& text, const std::string& what, const std::string& expected);
/// Exactly `count` numbers with commas between.
std::vector<double> numbersOf(const std::string& text, std::size_t count, const std::string& what,
                              const std::string& expected);
/// R,G,B of 0..255.
std::array<float, 3> colourOf(const std::string& text, const std::string& what);

[[noreturn]] void throwExpected(const std::string& what, const std::string& expected,
                                const std::string& text);

}  // namespace djpete::texture
