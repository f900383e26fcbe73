#include "number_rows.h"

#include <cstdio>

namespace djpete::simulator {

std::string numberRow(const std::vector<double>& numbers, const char* format) {
    std::string row;
    char text[48];
    for (double x : numbers) {
        std::snprintf(text, sizeof text, format, x);
        row += text;
    }
    return row;
}

std::string poseRow(const geometry::SE3& T) {
    std::vector<double> numbers;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            numbers.push_back(c < 3 ? T.rotation()(r, c) : T.translation()[r]);
    }
    return numberRow(numbers, " %.12e").substr(1);
}

}  // namespace djpete::simulator
