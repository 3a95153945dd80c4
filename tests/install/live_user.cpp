// SPDX-License-Identifier: BSD-3-Clause
// What a user of the installed live component writes: a loop over scans, here of a sensor that is not there.
#include <lidar_obstacles/live/live_detector.h>
#include <lidar_obstacles/live/live_scanner.h>
#include <lidar_obstacles/live/udp_source.h>

#include <cstdio>

int main() {
    using namespace lidar_obstacles;
    const DetectorParams params;
    live::LiveScanner scanner(std::make_unique<live::UdpSource>(live::Endpoint{0x7f000001U, 0}), {});
    live::LiveDetector detector(params);
    detector.addPose({});  // from whoever knows them, on any thread
    scanner.stop();
    while (!scanner.ended()) {
        if (const auto scan = scanner.next(0.1)) detector.process(*scan);
    }
    std::printf("%zu packets\n", scanner.counts().stream.packets);
    return scanner.counts().stream.packets == 0 ? 0 : 1;
}
