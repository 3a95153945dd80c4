// SPDX-License-Identifier: BSD-3-Clause
// From which distance low things and drops are found, on built scenes: low_distances [SENSOR_HEIGHT ...]. Prints a
// table in Markdown.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "support/low_scenes.h"

int main(int argc, char** argv) {
    using namespace lidar_obstacles::test;
    std::vector<double> heights;
    for (int k = 1; k < argc; ++k) heights.push_back(std::atof(argv[k]));
    if (heights.empty()) heights = {0.5, 0.75};
    std::string head = "| |", line = "|---|";
    for (const double h : heights) {
        char text[64];
        std::snprintf(text, sizeof text, " sensor at %.2f m |", h);
        head += text;
        line += "---|";
    }
    std::printf("%s\n%s\n", head.c_str(), line.c_str());
    for (const LowScene& scene : lowScenes()) {
        std::printf("| %s |", scene.name);
        for (const double h : heights) std::printf(" %s |", toText(foundFrom(scene, h)).c_str());
        std::printf("\n");
    }
    return 0;
}
