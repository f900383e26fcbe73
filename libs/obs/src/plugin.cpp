/// MRPT's tools dlopen this module: it makes our observation classes known to them.
#include <mrpt/core/initializer.h>

#include "djpete/obs/CObservationDetectedObjects.h"

MRPT_INITIALIZER(registerDjpeteObservations) { djpete::obs::registerObservationClasses(); }
