/// Pictures of one frame of a drive, for documents.
#pragma once

#include "realism_drive.h"

namespace djpete_bench {

/// Writes stereo.png (left over right), scan.png (points over the image and from above, coloured
/// by reflectance) and masks.png (instances over the image), as far as the drive has them. Throws
/// std::runtime_error naming a file that cannot be written.
void writePictures(const RealismDrive& drive, std::size_t frame,
                   const std::filesystem::path& folder);

}  // namespace djpete_bench
