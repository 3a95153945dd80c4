// SPDX-License-Identifier: BSD-3-Clause
// Model files of the recognizer: one that is taken gives probabilities for any features.
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/recognizer.h"

namespace {

using namespace lidar_obstacles;

void ask(const Recognizer& recognizer, float value) {
    FeatureVector features{};
    features.fill(value);
    for (const auto forest : {Recognizer::Forest::Grouping, Recognizer::Forest::Verdict}) {
        if (forest == Recognizer::Forest::Verdict && !recognizer.judgesSurroundings()) continue;
        float sum = 0.0F;
        for (const float p : recognizer(features, forest)) sum += p;
        if (!(std::abs(sum - 1.0F) < 1e-3F)) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const Recognizer recognizer = Recognizer::parse({reinterpret_cast<const char*>(data), size}, "fuzz");
        for (const float value : {-1e6F, 0.0F, 1.0F, 3.0F, 1e6F}) ask(recognizer, value);
    } catch (const std::runtime_error&) {
        // refused
    }
    return 0;
}
