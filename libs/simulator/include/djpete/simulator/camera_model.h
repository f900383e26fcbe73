/// What a camera makes of the light: exposure, vignetting, blur, noise, quantisation.
#pragma once

namespace djpete::simulator {

/// A camera like KITTI's PointGrey Flea2 (shutter set by the scene's brightness, at most 2 ms).
/// Light is linear; 1 is what the brightest pixel value stands for at exposure 1 and gain 1.
struct CameraModel {
    /// Shutter and gain follow the brightness of the last frames; both cameras of the rig share
    /// them, as they are triggered together. False: exposure 1 always.
    bool autoExposure = true;
    /// How strongly they follow: 0 not at all, 1 until the mean brightness is always the same.
    double adaptation = 0.6;
    /// Frames over which the brightness is averaged.
    int memory_frames = 12;
    /// Limits of the exposure (1 = nominal). What lies above `longestShutter` is reached by gain,
    /// which amplifies noise too.
    double leastExposure = 0.5, mostExposure = 2.0, longestShutter = 1.25;
    /// Above 0: the exposure of both cameras is driven up and down between 1 / (1 + this) and
    /// 1 + this of what it would be, within no limits, in turns of 12 frames, some of them quick.
    double exposureSwing = 0;
    /// Gain of the right camera relative to the left one; 1: the same.
    double rightGain = 1.0;
    /// Share of the light that is lost in the corners of the image.
    double vignetting = 0.06;
    /// Variance of shot noise per unit of signal (1 / full well), at gain 1. The signal is the
    /// pixel's value / 255, as a Flea2 without gamma gives it. Both as measured on KITTI's images:
    /// sigma 0.5 of 255 in the dark, 1.2 at 130.
    double shotNoise = 5.5e-5;
    /// Standard deviation of read noise, in the same units at gain 1.
    double readNoise = 6e-4;
    /// Noise of red, green and blue apart from each other, as a share of that of the luma.
    double chromaNoise = 0.5;
    /// Standard deviation of the lens's and the rectification's blur, pixels; 0: none.
    double blur_px = 0.45;
    /// Part of the period between frames for which the shutter is open at exposure 1, for motion
    /// blur; 0: none. KITTI's 2 ms of 100 ms are 0.02.
    double shutterShare = 0.0;
};

}  // namespace djpete::simulator
