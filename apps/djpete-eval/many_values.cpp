#include "many_values.h"

namespace djpete::apps {

std::vector<std::string> repeatOptions(int argc, const char** argv,
                                       const std::set<std::string>& many) {
    std::vector<std::string> words;
    std::string option;        // the one that takes further values
    bool needsOption = false;  // the next value has none before it
    for (int i = 0; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.size() > 1 && word[0] == '-') {
            option = many.count(word) > 0 ? word : "";
            needsOption = false;
        } else if (!option.empty()) {
            if (needsOption) words.push_back(option);
            needsOption = true;
        }
        words.push_back(word);
    }
    return words;
}

}  // namespace djpete::apps
