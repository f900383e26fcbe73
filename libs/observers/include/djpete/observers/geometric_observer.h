/// Cars in a LiDAR scan by their shape alone; no network, no training.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include "djpete/observers/object_observer.h"

namespace djpete::observers {

/// How GeometricObserver works (INI section [geometric_observer]).
struct GeometricObserverOptions : public mrpt::config::CLoadableOptions {
    // Region
    double rangeMax_m = 45.0;  ///< farther returns are too few per car to fit a box
    double rangeMin_m = 1.5;   ///< nearer returns are the own vehicle
    // Ground
    double groundSlopeMax_deg = 12.0;  ///< steepest ground against the vehicle's x-y plane
    double groundClearance_m = 0.25;   ///< an obstacle point is at least this high: over kerb noise
    // Clustering
    double cell_m = 0.15;             ///< cell of the ground plan in which clusters are joined
    double toleranceNear_m = 0.25;    ///< gap that joins two cells, tightest level, at range 0
    double tolerancePerRange = 0.01;  ///< growth of that gap per metre of range (beam spacing)
    int toleranceLevels = 3;          ///< levels tried, each twice as tolerant; the best fit wins
    int minPoints = 25;               ///< fewer returns cannot fix a box
    // Car sizes
    double lengthMin_m = 3.2, lengthMax_m = 5.6, lengthPrior_m = 4.2;  ///< cars and vans
    double widthMin_m = 1.35, widthMax_m = 2.25, widthPrior_m = 1.75;  ///< without mirrors
    double heightMin_m = 1.2, heightMax_m = 2.2;  ///< seen over the local ground
    double vanHeight_m = 1.9;                     ///< higher than this is called Van
    // Outcome
    double scoreMin = 0.35;    ///< worse candidates are not reported
    double overlapMax = 0.02;  ///< ground-plan overlap (of the smaller box) of two reported boxes
    double maskDilation_m = 0.12;  ///< mask: reach of one return on the object, closes scan lines

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
    void dumpToTextStream(std::ostream& out) const override;
};

/// Ground removal (PCL's plane RANSAC, then the local ground height per polar cell), clustering in
/// the ground plan at several tolerances, search-based rectangle fitting with the closeness
/// criterion (Zhang, Xu, Dong, Dolan: "Efficient L-shape fitting for vehicle detection using laser
/// scanners", IV 2017), completion of the sides that the sensor does not see to a car's usual size,
/// and gates on size, height and fill that turn away walls, poles, hedges and people.
///
/// Detections: frame velo, sensorPose = T_vehicle_velo, source "geometric", score in 0..1 (a
/// plausibility, not a probability), class Van if higher than vanHeight_m else Car. A shape does
/// not tell front from rear: the x axis of a box is the one of its two lengthwise directions nearer
/// to the vehicle's forward axis (within 90 degrees; at exactly 90 degrees, to the left).
/// `information` is weak along axes whose far side was completed and not seen.
class GeometricObserver : public ObjectObserver {
  public:
    explicit GeometricObserver(GeometricObserverOptions options = {});

    std::string name() const override { return "geometric"; }
    /// nullptr if `scan` is null. Boxes and masks only if `camera` is given and the object is in
    /// its view.
    obs::CObservationDetectedObjects::Ptr observe(const obs::SensorFrame& frame,
                                                  const obs::LidarScan* scan,
                                                  const obs::RigCamera* camera) override;
    /// The same without a frame: most likely boxes first.
    std::vector<obs::ObjectDetection> detect(const obs::LidarScan& scan,
                                             const obs::RigCamera* camera) const;

    const GeometricObserverOptions& options() const { return options_; }

  private:
    GeometricObserverOptions options_;
};

}  // namespace djpete::observers
