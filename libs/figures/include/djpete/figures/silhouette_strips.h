/// Pictures of what djpete-eval --silhouettes compared.
#pragma once

#include <string>

#include "djpete/evaluation/drive_silhouettes.h"

namespace djpete::figures {

/// NNNN.png of each object in the frame with its middle IoU, like the paper's figure 11: the
/// coloured points | the image | the model drawn over it | mask (white) and silhouette (red; both:
/// yellow; other instances, ignored: blue grey), or the silhouette and the box of the truth | the
/// place: in the scan of the frame, or if there is none the model and the boxes of all objects in
/// the whole darkened image. Makes the folder. Throws obs::InputError if it or a picture cannot be
/// written, or the drive cannot be read.
void drawSilhouetteStrips(const evaluation::DriveSilhouettes& silhouettes,
                          const evaluation::ObjectModels& models,
                          const evaluation::EstimatedDrive& estimate, const std::string& rawlog,
                          const std::string& folder);

}  // namespace djpete::figures
