#include "run_app.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>
#include <string>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "message_of.h"

namespace lidar_obstacles::apps {

bool parse(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
        return true;
    } catch (const CLI::Success& e) {  // --help, --version
        app.exit(e);
        return false;
    } catch (const CLI::ParseError& e) {
        throw UsageError(std::string(e.what()) + " (see " + app.get_name() + " --help)");
    }
}

int runApp(const char* tool, const std::function<int()>& run) {
    const auto report = [tool](int code, const std::string& message) {
        std::fprintf(stderr, "%s: error: %s\n", tool, message.c_str());
        return code;
    };
    try {
        return run();
    } catch (const UsageError& e) {
        return report(2, e.what());
    } catch (const ConfigError& e) {
        return report(2, e.what());
    } catch (const std::invalid_argument& e) {  // parameters that do not go together or do not fit the input
        return report(2, e.what());
    } catch (const std::bad_alloc&) {
        return report(1, "out of memory");
    } catch (const std::exception& e) {
        return report(1, messageOf(e));
    }
}

}  // namespace lidar_obstacles::apps
