#include "window.h"

namespace lidar_obstacles::apps {

void showWindow(const Options&, const DetectorParams&) {
    throw UsageError(
        "--gui: this obstacle-replay was built without MRPT's gui library (libmrpt-gui-dev); "
        "--record DIR or --record FILE.mp4 needs none");
}

}  // namespace lidar_obstacles::apps
