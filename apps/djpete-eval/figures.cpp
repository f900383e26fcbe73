#include "figures.h"

#include <ostream>

#include "djpete/obs/errors.h"

namespace djpete::apps {

std::optional<figures::FigureRequest> figureRequest(const std::optional<std::string>& figures,
                                                    const std::optional<std::string>& result,
                                                    const std::optional<std::string>& drive,
                                                    const std::optional<std::string>& truth) {
    if (!figures) {
        if (result) throw obs::InputError("command line: --result needs --figures");
        return std::nullopt;
    }
    if (!result) throw obs::InputError("command line: --figures needs --result");
    figures::FigureRequest request;
    request.outFolder = *figures;
    request.resultFolder = *result;
    request.drive = drive;
    request.truthFile = truth;
    return request;
}

void runFigures(const figures::FigureRequest& request, std::ostream& out) {
    const auto report = figures::drawFigures(request);
    for (const auto& file : report.written) out << file << "\n";
    for (const auto& sentence : report.missing) out << sentence << "\n";
}

}  // namespace djpete::apps
